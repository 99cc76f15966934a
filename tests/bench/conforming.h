// A tetrahedral mesh that ends at the surface, as a reference for cages that enclose it.
#pragma once

#include <memory>

#include "base/result.h"
#include "types/tet_mesh.h"

namespace sherd::bench {

/// Tetrahedra of `edge` (share of the bounding box's diagonal) that fill `surface`; their boundary, some
/// hundredths of an edge away from it, is the result's own surface, and all of them lie inside. Meshing
/// starts from every `step`-th vertex of the surface, so that a fine surface makes a fine boundary.
Result<std::shared_ptr<const TetMesh>> conformingMesh(const TriMesh& surface, double edge, std::size_t step);

}  // namespace sherd::bench
