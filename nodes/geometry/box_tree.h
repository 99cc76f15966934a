// Which of many boxes overlap a given one.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// A balanced tree over boxes, split at the median of their centres along the longest side. Building costs
/// O(n log n), a query O(log n + hits) on the boxes of a usual surface. The order of visits depends on the
/// boxes alone. Keeps a reference to them.
class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes) : boxes_(boxes), order_(boxes.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<Index>(i);
    if (!order_.empty()) build(0, order_.size());
  }

  /// Calls visit(i) for every box i that overlaps `query`, its border counted in.
  template <class Visit>
  void visitOverlaps(const Box& query, Visit&& visit) const {
    std::size_t n = 0;
    while (n < nodes_.size()) {  // depth first; a node that is missed is skipped with all below it
      const Node& node = nodes_[n];
      if (!node.box.overlaps(query)) {
        n = node.next;
        continue;
      }
      if (node.next == n + 1)
        for (std::size_t i = node.begin; i < node.end; ++i)
          if (boxes_[at(order_[i])].overlaps(query)) visit(order_[i]);
      ++n;
    }
  }

 private:
  static constexpr std::size_t kLeaf = 4;
  struct Node {
    Box box;
    std::size_t begin, end;  ///< in order_
    std::size_t next;        ///< the node after all below this one; the very next for a leaf
  };

  void build(std::size_t begin, std::size_t end) {
    const std::size_t self = nodes_.size();
    Node node{{}, begin, end, 0};
    Box centres;
    for (std::size_t i = begin; i < end; ++i) {
      const Box& box = boxes_[at(order_[i])];
      node.box.add(box.low);
      node.box.add(box.high);
      centres.add(box.centre());
    }
    nodes_.push_back(node);
    if (end - begin > kLeaf) {
      Eigen::Index axis = 0;
      (centres.high - centres.low).maxCoeff(&axis);
      const std::size_t middle = begin + (end - begin) / 2;
      const auto first = order_.begin();
      std::nth_element(first + offset(begin), first + offset(middle), first + offset(end),
                       [&](Index a, Index b) {
                         const double ca = boxes_[at(a)].low[axis] + boxes_[at(a)].high[axis];
                         const double cb = boxes_[at(b)].low[axis] + boxes_[at(b)].high[axis];
                         return ca != cb ? ca < cb : a < b;
                       });
      build(begin, middle);
      build(middle, end);
    }
    nodes_[self].next = nodes_.size();
  }
  static std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  std::span<const Box> boxes_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace sherd
