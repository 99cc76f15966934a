// From clipped triangles to closed, connected pieces.
#pragma once

#include "base/exec.h"
#include "tessellate/arrangement.h"
#include "tessellate/clip.h"
#include "types/fragments.h"

namespace sherd {

/// Gathers each cell's skin and sheets, splits it into connected solids (joined by shared edges; a void
/// belongs to the solid around it), lets solids smaller than `minVolume` (m³) join the neighbour with the
/// largest contact area, and fills in all of Fragments but `tets`, `material`, and what the cells' search
/// found. Solids without a neighbour stay, however small, but for pockets of cut
/// skin that rounding laid flat. `neighbours`: TetMesh::surfaceNeighbours. When exec
/// is cancelled it ends soon with something unfinished: check exec.cancelled() afterwards. Cost O(surface +
/// new triangles).
Fragments assemblePieces(const Arrangement& arrangement, ClippedMeshes meshes,
                         std::span<const Triangle> neighbours, double minVolume, double density,
                         const Exec& exec);

}  // namespace sherd
