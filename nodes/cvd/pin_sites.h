// Sites put where an artist wants a piece: a place in the body becomes a place in its embedding.
//
// Within a tetrahedron the embedding is linear, so a point there has the coordinates of the corners, weighted
// by its barycentric ones. Beyond the tetrahedra there is no embedding: the nearest node stands in, with a
// warning.
#pragma once

#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/partition.h"
#include "types/vec.h"

namespace sherd {

struct PinSitesParams {
  std::vector<Vec3> points;  ///< m, in the space of the tetrahedra; one or more
};

/// One pinned site per point, in their order. Warns of points outside of all tetrahedra, with the distance to
/// the node that is taken, and of points that are at one place, since only the first of these gets a piece.
/// Errors: no points, or one that isn't finite; an embedding without its tetrahedra, or that isn't finite.
/// Cost O(points · tetrahedra).
Result<Sites> pinSites(const Embedding& embedding, const PinSitesParams& params, const Exec& exec);

}  // namespace sherd
