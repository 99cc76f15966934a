// Triangles that rounding laid flat, given to their neighbours.
#pragma once

#include "tessellate/clip.h"
#include "types/tet_mesh.h"

namespace sherd {

/// A crack that runs along an edge of the surface, but for rounding, leaves triangles whose three corners are
/// on one line: the crack has vertices on that line that the surface's edge has not. Such a triangle goes,
/// and what else meets at its longest side is split at its middle corner instead: the neighbour in its skin
/// or sheet (an edge flip), or the two others of three sheets that meet there. Where a half so made covers
/// another triangle, with nothing of one cell between them, both become one, or nothing. A flat triangle
/// stays where a cell's border would come to meet itself. `isCut`: per surface triangle; those that are split
/// here are marked, and their parts are in the skin. Returns how many went. Cost O(triangles of the meshes),
/// and O(their degree) per flat one.
std::size_t absorbFlatTriangles(const TetMesh& tets, const Arrangement& arrangement, ClippedMeshes& meshes,
                                std::vector<unsigned char>& isCut);

}  // namespace sherd
