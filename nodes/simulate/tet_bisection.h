// Divides tetrahedra where shorter edges are wanted, by cutting edges in half (Rivara 1984, longest edges
// first): every tetrahedron at an edge is cut with it, so that there are no hanging nodes, and each piece
// lies in the tetrahedron that it was cut from.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geometry/tet_edges.h"
#include "types/vec.h"

namespace sherd {

struct DividedTets {
  std::vector<Vec3> nodes;    ///< those given under their numbers, then the middles of edges
  std::vector<Edge> halved;   ///< per middle, the edge's ends
  std::vector<Tetra> tets;    ///< in the order of their parents, oriented as these
  std::vector<Index> parent;  ///< per tetrahedron, the one given that it is (a part of)
};

/// The longest edge that is wanted about `place` in (a part of) tetrahedron `parent`.
using WantedEdge = std::function<double(const Vec3& place, Index parent)>;

/// Halves every edge that is longer than wanted at its middle in any tetrahedron around it, and first those
/// of its tetrahedra that are longer still, until there is none. Cost O(n log n) in what it returns.
DividedTets divideTets(std::span<const Vec3> nodes, std::span<const Tetra> tets, const WantedEdge& wanted);

}  // namespace sherd
