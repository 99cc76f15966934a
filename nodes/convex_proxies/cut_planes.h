// Where a concave part may be cut.
#pragma once

#include <span>
#include <vector>

#include "base/exec.h"
#include "convex_proxies/clipped.h"
#include "geometry/convex_hull.h"

namespace sherd {

/// An edge at which the surface is concave.
struct ConcaveEdge {
  Vec3 a, b;
  Vec3 normals[2];  ///< unit, of the triangles beside it, outward
  Vec3 middle() const { return 0.5 * (a + b); }
};

/// All of them, but those that bend by less than rounding can tell. Cost O(triangles).
std::vector<ConcaveEdge> concaveEdges(std::span<const Vec3> positions, std::span<const Triangle> triangles);

/// Planes to try on a part with this hull, best guesses first: along and across the concave edges that lie
/// deepest in the hull and within all of `bounds`, then across the hull's principal axes.
std::vector<CutPlane> candidatePlanes(std::span<const ConcaveEdge> edges, const HullMesh& hull,
                                      std::span<const CutPlane> bounds, const Exec& exec);

}  // namespace sherd
