// Convex hulls with exact predicates (CGAL's quickhull).
#pragma once

#include <span>
#include <vector>

#include "base/result.h"
#include "types/vec.h"

namespace sherd {

struct HullMesh {
  std::vector<Vec3> positions;      ///< corners of the hull, ascending by x, then y, then z
  std::vector<Triangle> triangles;  ///< closed, counter-clockwise seen from outside
  double volume = 0;                ///< m³
  bool flat = false;                ///< all points lie in one plane, exactly
};

/// No point lies outside of the hull, exactly in the given doubles. The result depends on the hull alone, not
/// on the order of the points: facets of more than three corners are fans from their least corner, and no
/// corner lies within an edge or a facet. Points of one plane give their polygon from both sides; points of
/// one line, or fewer than three, give no triangle. Cost O(n log n) on usual points. Errors: points that are
/// not finite.
Result<HullMesh> convexHull(std::span<const Vec3> points);

}  // namespace sherd
