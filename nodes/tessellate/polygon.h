// Triangulation of a planar polygon with holes whose corners were rounded from exactly known places.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// A corner in the plane. Corners that share a bit of `lines` lie on one straight line by construction,
/// whatever their rounded coordinates say; at most 32 lines.
struct PlanarCorner {
  Vec2 point;
  std::uint32_t lines = 0;
};

struct PolygonTriangulation {
  std::vector<Triangle> triangles;  ///< corners by number, counter-clockwise
  int forced = 0;  ///< triangles that overlap or are flat because rounding left no better ones
};

/// Triangulates the region with the given loops to the left of their edges: outer loops counter-clockwise,
/// holes clockwise, each a cycle of at least three corner numbers, neighbours different. Corners have
/// different points. Uses no corner that is not in a loop and adds none, and every loop edge is an edge of
/// exactly one triangle, in the loop's direction, whatever the coordinates are. Ears are cut by exact
/// predicates on the rounded points, best first, then edges are flipped to enlarge the least angle (a
/// constrained Delaunay triangulation where rounding allows, but for the bridges to holes). Cost O(n²) for n
/// corners. Keeps its memory from polygon to polygon.
class PolygonTriangulator {
 public:
  PolygonTriangulator();
  ~PolygonTriangulator();
  PolygonTriangulator(PolygonTriangulator&&) noexcept;
  PolygonTriangulator& operator=(PolygonTriangulator&&) noexcept;
  /// Good until the next call.
  const PolygonTriangulation& triangulate(std::span<const PlanarCorner> corners,
                                          std::span<const std::vector<Index>> loops);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// Twice the signed area of a loop.
double loopArea2(std::span<const PlanarCorner> corners, const std::vector<Index>& loop);

}  // namespace sherd
