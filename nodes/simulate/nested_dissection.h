// An elimination order of a mesh's nodes that keeps a Cholesky factor small (George 1973).
#pragma once

#include <span>
#include <vector>

#include "simulate/sparse_cholesky.h"

namespace sherd {

/// Sorts the nodes along each axis and along the mesh's own edges from one end to the other (which a plane
/// cannot do for a body with legs), cuts the order that has the least border where that is, makes the border
/// smaller (separator.h), puts it last and orders both sides in the same way; sets of a few dozen nodes are
/// left as they are. The factor is about as small as METIS makes it, and this is a pure function of its
/// arguments, unlike METIS, whose random numbers all threads share. Returns the nodes in order. Cost
/// O(n log² n).
std::vector<Index> nestedDissection(std::span<const Vec3> positions, const BlockMatrix& graph);

}  // namespace sherd
