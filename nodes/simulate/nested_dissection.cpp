#include "simulate/nested_dissection.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr std::size_t kSmallest = 24;  // nodes: their rows form one dense block, which BLAS likes

class Dissection {
 public:
  Dissection(std::span<const Vec3> positions, const BlockMatrix& graph)
      : positions_(positions), around_(graph.size()), side_(graph.size(), 0) {
    for (std::size_t column = 0; column < graph.size(); ++column)
      for (std::size_t e = at(graph.begin[column]) + 1; e < at(graph.begin[column + 1]); ++e) {
        around_[column].push_back(graph.row[e]);
        around_[at(graph.row[e])].push_back(static_cast<Index>(column));
      }
  }

  void order(std::vector<Index> nodes, std::vector<Index>& result) {
    if (nodes.size() <= kSmallest) {
      result.insert(result.end(), nodes.begin(), nodes.end());
      return;
    }
    const auto middle = nodes.begin() + static_cast<std::ptrdiff_t>(nodes.size() / 2);
    sortAlongLongestAxis(nodes);
    std::vector<Index> low(nodes.begin(), middle), high(middle, nodes.end()), lowBorder, highBorder;
    mark(low, high);
    for (const Index n : low)
      if (touches(n, 2)) lowBorder.push_back(n);
    for (const Index n : high)
      if (touches(n, 1)) highBorder.push_back(n);
    unmark(nodes);
    const bool cutLow = lowBorder.size() < highBorder.size();
    const std::vector<Index>& separator = cutLow ? lowBorder : highBorder;
    std::vector<Index>& thinned = cutLow ? low : high;
    for (const Index n : separator) side_[at(n)] = 3;
    std::erase_if(thinned, [this](Index n) { return side_[at(n)] == 3; });
    unmark(separator);
    order(std::move(low), result);
    order(std::move(high), result);
    result.insert(result.end(), separator.begin(), separator.end());
  }

 private:
  void sortAlongLongestAxis(std::vector<Index>& nodes) const {
    Box box;
    for (const Index n : nodes) box.add(positions_[at(n)]);
    Eigen::Index axis = 0;
    (box.high - box.low).maxCoeff(&axis);
    std::sort(nodes.begin(), nodes.end(), [&](Index a, Index b) {
      const double xa = positions_[at(a)][axis], xb = positions_[at(b)][axis];
      return xa != xb ? xa < xb : a < b;
    });
  }
  void mark(const std::vector<Index>& low, const std::vector<Index>& high) {
    for (const Index n : low) side_[at(n)] = 1;
    for (const Index n : high) side_[at(n)] = 2;
  }
  void unmark(const std::vector<Index>& nodes) {
    for (const Index n : nodes) side_[at(n)] = 0;
  }
  bool touches(Index node, int side) const {
    return std::any_of(around_[at(node)].begin(), around_[at(node)].end(),
                       [&](Index n) { return side_[at(n)] == side; });
  }

  std::span<const Vec3> positions_;
  std::vector<std::vector<Index>> around_;
  std::vector<int> side_;  ///< per node: 1 low, 2 high, 3 separator; 0 not of the current set
};

}  // namespace

std::vector<Index> nestedDissection(std::span<const Vec3> positions, const BlockMatrix& graph) {
  std::vector<Index> all(graph.size()), result;
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = static_cast<Index>(n);
  result.reserve(all.size());
  Dissection(positions, graph).order(std::move(all), result);
  return result;
}

}  // namespace sherd
