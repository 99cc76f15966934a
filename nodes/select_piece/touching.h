// Makes a closed surface that touches itself in vertices or along edges a manifold again.
#pragma once

#include <vector>

#include "base/result.h"
#include "types/vec.h"

namespace sherd {

/// A surface's vertices and triangles, and what had to be done about parts of it that touch.
struct ManifoldSurface {
  std::vector<Vec3> positions;      ///< those given, in their order, then the doubled ones
  std::vector<Triangle> triangles;  ///< those given, in their order
  std::size_t touchingEdges = 0;    ///< edges that more than two triangles shared
  std::size_t doubledVertices = 0;  ///< vertices added
};

/// Where several fans of triangles meet in a vertex, each gets a vertex of its own, at the same position; no
/// triangle moves. Along an edge of four triangles and more, those are neighbours that bound one and the same
/// wedge of empty space, so that the solid hangs together there; only where that would not leave two
/// triangles per edge, those that bound one wedge of the solid.
///
/// Around an edge the order of triangles is exact on the given doubles, and consistent where two of them lie
/// in one plane. Errors: an edge that is not used equally often in both directions, with its place; parts
/// that touch in a way that doubling vertices does not resolve. Cost O(n log n).
Result<ManifoldSurface> separateTouching(std::vector<Vec3> positions, std::vector<Triangle> triangles);

}  // namespace sherd
