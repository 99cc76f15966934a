// The edges of a tetrahedral mesh, and its nodes' neighbours along them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "types/tet_mesh.h"

namespace sherd {

/// A pair of nodes, the lower index first.
using Edge = std::array<Index, 2>;

/// Every edge once, ascending. Cost O(tets log tets).
std::vector<Edge> tetEdges(std::span<const Tetra> tets);

/// Neighbours of every node along edges, ascending, in one array.
class NodeGraph {
 public:
  NodeGraph(std::size_t nodes, std::span<const Edge> edges);
  std::span<const Index> neighbours(Index node) const {
    return {list_.data() + begin_[at(node)], list_.data() + begin_[at(node) + 1]};
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<Index> list_;
};

}  // namespace sherd
