// Where the surface lies in its cage and how its triangles hang together: made once per body, used by every
// cut.
#pragma once

#include "base/exec.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Fills TetMesh::vertexTet, surfaceNeighbours and patches from the surface and the held triangles. A vertex
/// on a face that tetrahedra share belongs to the one that an infinitely small step in the direction of (1,
/// δ, δ²), δ → 0, leads to; exact (CGAL's predicates). −1 for a vertex outside of all. Patches grow in rings
/// up to 32 triangles, each next one beside those before. Cost O(held triangles + surface).
void linkSurface(TetMesh& mesh, const Exec& exec);

}  // namespace sherd
