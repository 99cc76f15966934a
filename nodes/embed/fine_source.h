// Eigenmodes of the fine surface itself, at the nodes of the cage around it.
#pragma once

#include <optional>

#include "base/exec.h"
#include "base/result.h"
#include "embed/embed.h"
#include "embed/part.h"
#include "embed/spectrum.h"

namespace sherd {

/// The `params.dimensions` lowest modes of the surface within the part (cotangent Laplacian), at the part's
/// nodes. A node outside of the surface or on it gets the modes of the closest point of the surface; one
/// inside them by params.extension: mean value coordinates with respect to the surface, or harmonically in
/// the tetrahedra. None where the surface within the part does not hang together, as around a void. Errors:
/// libraries' failures; mean value coordinates that are not defined; cancelled. Cost: that of the modes, and
/// O(inner nodes · triangles) for mean value coordinates.
Result<std::optional<Modes>> fineModes(const TetMesh& tets, const BodyPart& part, const EmbedParams& params,
                                       const Exec& exec);

}  // namespace sherd
