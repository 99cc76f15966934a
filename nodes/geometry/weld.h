// Joins vertices of identical position and leaves out what then takes no part in the surface.
#pragma once

#include <cstddef>
#include <vector>

#include "types/tri_mesh.h"

namespace sherd {

struct WeldCounts {
  std::size_t joined = 0;              ///< vertices that another one stood in the place of
  std::size_t collapsedTriangles = 0;  ///< left out: two corners are the same vertex after joining
  std::size_t unusedVertices = 0;      ///< left out: no triangle of the file uses them
};

/// Makes every position one vertex (−0 equals +0; the first one's bits stay), drops triangles with two equal
/// corners together with their attributes, and then vertices that no triangle uses. Nothing is moved, and the
/// order of what is kept stays. Attributes are per corner, so that seams lose nothing. Needs finite positions
/// and indices within range. Cost O(vertices + triangles), expected.
WeldCounts weld(TriMesh& mesh);

/// Keeps the triangles that are marked, and their attributes, in their order. keep.size() = triangles.
void keepTriangles(TriMesh& mesh, const std::vector<bool>& keep);

}  // namespace sherd
