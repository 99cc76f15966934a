// How far convex stand-ins of different pieces reach into each other.
#pragma once

#include <vector>

#include "base/exec.h"
#include "types/proxies.h"

namespace sherd {

/// Fills PieceProxy::overlap: the volumes that its hulls share with those of every other piece, added up.
/// Where three pieces' hulls share a place it counts twice. Hulls of more than 96 corners are measured by the
/// hull of those that lie farthest in 96 directions, a few hundredths smaller. Cost O(pairs of hulls that
/// meet · facets of both).
void measureOverlaps(std::vector<PieceProxy>& pieces, const Exec& exec);

/// m³ that both hulls hold. Exact up to rounding.
double sharedVolume(const ConvexHull& a, const ConvexHull& b);

}  // namespace sherd
