// An elimination order of a mesh's nodes that keeps a Cholesky factor small (George 1973).
#pragma once

#include <span>
#include <vector>

#include "simulate/sparse_cholesky.h"

namespace sherd {

/// Halves the nodes by a plane across their longest extent, orders both halves in the same way, and puts last
/// those nodes of one half that touch the other; sets of a few dozen nodes are left as they are. A pure
/// function of its arguments, unlike METIS, whose random numbers all threads share. Returns the nodes in
/// order. Cost O(n log² n).
std::vector<Index> nestedDissection(std::span<const Vec3> positions, const BlockMatrix& graph);

}  // namespace sherd
