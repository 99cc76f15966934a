// From clipped triangles to closed, connected pieces.
#pragma once

#include "base/exec.h"
#include "tessellate/arrangement.h"
#include "tessellate/clip.h"
#include "types/fragments.h"

namespace sherd {

struct AssembleParams {
  std::size_t sites = 1;  ///< cells
  double minVolume = 0;   ///< m³
  double density = 1;     ///< kg/m³
};

/// Gathers each cell's skin and sheets, splits it into connected solids (joined by shared edges; a void
/// belongs to the solid around it), lets small solids join their neighbours (solid_merger.h), and fills in
/// all of Fragments but `tets`, `material`, and what the cells' search found. `tets` has the links and
/// patches of geometry/surface_links.h. When exec is cancelled it ends soon with something unfinished: check
/// exec.cancelled() afterwards. Cost: copying the surface, plus O(patches + new triangles).
Fragments assemblePieces(const TetMesh& tets, const Sheets& sheets, Arrangement arrangement,
                         ClippedMeshes meshes, const AssembleParams& params, const Exec& exec);

}  // namespace sherd
