// The same cut as one would write it in an afternoon: the surface intersected with each cell's polyhedron by
// CGAL's corefinement.
#pragma once

#include <cstddef>
#include <vector>

#include "types/tri_mesh.h"

namespace sherd::bench {

struct PeerCut {
  double milliseconds = 0;  ///< of the intersections alone; making the cells' polyhedra is not counted
  double processorMilliseconds = 0;
  std::size_t pieces = 0;  ///< that came out with a volume
  std::size_t failed = 0;  ///< cells whose intersection CGAL gave up on
  double volumeError = 0;  ///< |Σ − source| / source
};

/// Voronoi cells in space, where the polyhedra are convex: the easiest case for it.
PeerCut cutByCorefinement(const TriMesh& surface, const std::vector<Vec3>& sites);

}  // namespace sherd::bench
