// From pieces to what a GLB file holds.
#pragma once

#include "base/exec.h"
#include "export/bonds.h"
#include "export/crack_faces.h"
#include "export/glb.h"
#include "types/fragments.h"

namespace sherd {

/// As export_pieces.h says. Fails where a number is too large for a float. Parallel over pieces; when
/// cancelled it ends soon with an error.
Result<GlbScene> glbScene(const Fragments& fragments, const CrackAttributes& cracks,
                          const std::vector<Bond>& bonds, const Exec& exec);

}  // namespace sherd
