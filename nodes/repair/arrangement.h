// A surface cut along all lines in which it meets itself, in exact arithmetic.
#pragma once

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <span>
#include <vector>

#include "base/exec.h"
#include "types/vec.h"

namespace sherd {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

struct CutSurface {
  struct Face {
    Triangle corners;   ///< in points; as its source runs
    Index source = -1;  ///< the triangle of the surface that it is a part of
  };
  std::vector<Exact::Point_3> points;  ///< the surface's vertices, then new ones; none twice among those used
  /// Uncut triangles as they are, cut ones in parts. Two faces share no more than a corner, an edge or all
  /// three corners.
  std::vector<Face> faces;
};

/// `pairs`: all pairs of triangles that meet elsewhere than in shared corners and edges. Triangles that lie
/// on each other get the same parts there. No zero-area triangles. When cancelled, the result means nothing.
/// Cost: exact constructions for each pair and a constrained Delaunay triangulation (CGAL) for each cut
/// triangle or group of such that overlap in a plane.
CutSurface arrange(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                   std::span<const std::array<Index, 2>> pairs, const Exec& exec);

}  // namespace sherd
