// Closes cracks: borders that lie on each other, or as good as, without being one edge.
#pragma once

#include <array>
#include <vector>

#include "base/exec.h"
#include "repair/patchwork.h"

namespace sherd {

/// Splits every triangle that has edge {ends[0], ends[1]} at vertex ends[2], and its parts at what of the
/// list they have. A triangle whose third corner is that vertex is left out. Attributes follow linearly.
void splitEdges(Patchwork& surface, const std::vector<std::array<Index, 3>>& splits);

struct Stitched {
  std::size_t joined = 0;     ///< vertices that were moved onto another
  std::size_t split = 0;      ///< border edges that were split where another border's vertex lies on them
  double moved = 0;           ///< m, the farthest that anything was moved
  Vec3 place = Vec3::Zero();  ///< m, the first of them
};

/// Joins vertices of open edges that are nearer to each other than `tolerance` (m), and splits open edges at
/// such vertices. Never farther than a quarter of the edges there, so that nothing collapses. Cost O(n log
/// n).
Stitched stitch(Patchwork& surface, double tolerance, const Exec& exec);

}  // namespace sherd
