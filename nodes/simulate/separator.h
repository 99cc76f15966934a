// Fewer nodes between two parts of a graph, by moving them one by one.
#pragma once

#include <array>
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// Neighbours of every node, in one array.
struct Adjacency {
  std::vector<std::size_t> begin;  ///< per node, its first entry in `node`; one more at the end
  std::vector<Index> node;
  std::span<const Index> of(Index n) const {
    return {node.data() + begin[at(n)], node.data() + begin[at(n) + 1]};
  }
};

enum class Side : std::int8_t { Low = 0, High = 1, Between = 2, Elsewhere = 3 };

/// Improves a separator (Fiduccia and Mattheyses 1982, with nodes in place of edges: Ashcraft and Liu 1997):
/// a node of it goes to one side, and its neighbours of the other side take its place. The move that saves
/// most is made next, even at a loss, and what comes after the smallest separator is taken back.
class SeparatorRefinement {
 public:
  explicit SeparatorRefinement(const Adjacency& graph)
      : graph_(graph), side_(graph.begin.size() - 1, Side::Elsewhere), locked_(side_.size(), 0) {}

  Side& side(Index n) { return side_[at(n)]; }
  /// `between`: the separator, replaced by a smaller one (sides tell where the rest went); `sizes`: nodes of
  /// both sides, of which neither may get smaller than `least`.
  void refine(std::vector<Index>& between, std::array<std::size_t, 2>& sizes, std::size_t least);

 private:
  struct Move {
    Index gain, node;
    Side to;
    bool operator<(const Move& o) const {
      return gain != o.gain ? gain < o.gain : node != o.node ? node > o.node : to < o.to;
    }
  };
  static Side other(Side s) { return s == Side::Low ? Side::High : Side::Low; }
  Index gain(Index n, Side to) const;
  void offer(Index n);
  void take(const Move& move);
  bool pass(std::size_t count, std::array<std::size_t, 2>& sizes, std::size_t least);

  const Adjacency& graph_;
  std::vector<Side> side_;
  std::vector<char> locked_;
  std::priority_queue<Move> queue_;
  std::vector<std::pair<Index, Side>> done_;  ///< nodes that changed, with the side that they had
};

}  // namespace sherd
