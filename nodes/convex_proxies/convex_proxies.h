// Convex hulls that stand for the pieces in a rigid-body engine.
//
// One hull per piece holds all of it, and whatever lies in its hollows. Where that is too much, the piece is
// cut by planes into parts, and each part gets the hull of its own: again and again the part whose hull is
// most too large is cut by that one of some dozens of planes which leaves the smallest hulls: planes through
// the deepest of its concave edges (along either side of the edge, and across it), and across its principal
// axes. This is the idea of Mamou and Ghorbel (A simple and efficient approach for 3D mesh approximate convex
// decomposition, ICIP 2009) on the solid itself instead of voxels. Deviations: the measure is volume, exact
// up to rounding (the divergence theorem on the clipped surface and its sections), not the concavity of a
// surface; and parts come from planes, so that the hulls of a piece never overlap each other: their volumes
// add up.
//
//   error = (Σ hulls − piece) / piece ≥ 0
//
// Hulls of neighbouring pieces overlap where the crack between them is not flat: an engine pushes them apart.
// The overlap is computed too (overlaps.h); a decomposition makes it smaller.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "types/fragments.h"
#include "types/proxies.h"

namespace sherd {

struct ConvexProxiesParams {
  int maxHulls = 8;         ///< ≥ 1, per piece; 1: its convex hull
  double tolerance = 0.05;  ///< ≥ 0: error at which a piece is cut no further
};

/// One proxy per piece, in their order. Every vertex of a piece lies in one of its hulls: exactly where it
/// has one hull, up to rounding (1e-12 of the piece's size) where it was cut. A piece whose vertices all lie
/// in one plane gets its polygon from both sides, with volume 0; says so. Says the largest error and the
/// largest share of a piece that other pieces' hulls reach into.
///
/// Bit-identical for any number of threads. Errors: no pieces, parameters out of range. Cost: some dozens of
/// hulls of a few hundred points for each cut (about 20 ms), pieces in parallel.
Result<Proxies> convexProxies(const Fragments& fragments, const ConvexProxiesParams& params,
                              const Exec& exec);

}  // namespace sherd
