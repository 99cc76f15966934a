// A new surface around the same solid, from a level set.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "repair/patchwork.h"

namespace sherd {

struct Rebuilt {
  Patchwork surface;
  double voxel = 0;      ///< m
  double hausdorff = 0;  ///< m, between the old surface as seen from outside and the new one; of samples
};

/// Where the winding number is above 0 there is solid: the level set of the distance to the surface, with
/// that sign, on voxels of size diagonal / resolution (OpenVDB), as triangles between points of the edges of
/// a division of the voxels into tetrahedra (marching tetrahedra). Each tetrahedron holds at most two of them
/// and shares what is on its faces with the neighbours: closed, manifold and free of self-intersections by
/// construction, whatever the surface is. While a part of the old surface is farther than two voxels from the
/// new one, voxels are halved, up to `finest` (voxels along the diagonal). Corners get the attributes of the
/// closest point. As many triangles must run one way as the other at each edge. Cost O(area / voxel²). Fails
/// where nothing is inside.
Result<Rebuilt> rebuild(const Patchwork& surface, int resolution, int finest, const Exec& exec);

}  // namespace sherd
