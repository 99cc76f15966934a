// Triangles that rounding laid flat, given to their neighbours.
#pragma once

#include "tessellate/clip.h"
#include "types/tet_mesh.h"

namespace sherd {

/// A crack that runs along an edge of the surface, but for rounding, leaves triangles whose three corners are
/// on one line: the crack has vertices on that line that the surface's edge has not. Such a triangle goes
/// where the triangle across its longest side belongs to the same cell and the same skin or sheet: that one
/// is split at the flat one's middle corner instead (an edge flip). Where the other has no place for it, it
/// stays. `isCut`: per surface triangle; those that are split here are marked, and their parts are in the
/// skin. Returns how many went. Cost O(triangles of the meshes), and O(their degree) per flat one.
std::size_t absorbFlatTriangles(const TetMesh& tets, const Arrangement& arrangement, ClippedMeshes& meshes,
                                std::vector<unsigned char>& isCut);

}  // namespace sherd
