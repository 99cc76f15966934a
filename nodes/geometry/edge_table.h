// The undirected edges of a triangle list and who uses them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

struct EdgeTable {
  std::vector<std::array<Index, 2>> ends;        ///< per edge, ends[0] < ends[1], ascending
  std::vector<std::array<Index, 3>> ofTriangle;  ///< per triangle: edge of corners (0,1), (1,2), (2,0)
  std::vector<Index> useBegin,
      use;  ///< triangles of edge e: use[useBegin[e]] … use[useBegin[e + 1] − 1], ascending

  std::span<const Index> trianglesOf(Index edge) const {
    return std::span(use).subspan(at(useBegin[at(edge)]), at(useBegin[at(edge) + 1] - useBegin[at(edge)]));
  }
  /// Does triangle t run from ends[0] to ends[1] along its edge number `slot`?
  bool forward(std::span<const Triangle> triangles, Index t, int slot) const {
    const Index from = triangles[at(t)][static_cast<std::size_t>(slot)];
    return ends[at(ofTriangle[at(t)][static_cast<std::size_t>(slot)])][0] == from;
  }
};

/// Cost O(vertices + triangles) for bounded vertex degree.
EdgeTable buildEdgeTable(std::span<const Triangle> triangles, std::size_t vertexCount);

}  // namespace sherd
