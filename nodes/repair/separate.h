// Solids that touch in an edge or a vertex, drawn apart.
#pragma once

#include <optional>

#include "base/exec.h"
#include "repair/patchwork.h"

namespace sherd {

struct Separated {
  std::size_t vertices = 0;   ///< that were doubled
  double moved = 0;           ///< m, the farthest
  Vec3 place = Vec3::Zero();  ///< m, the first
};

/// Gives every fan of triangles that meets others in a vertex a vertex of its own, and moves all but one,
/// mostly the largest, by at most `distance` (m) and a hundredth of the edges there: into its own solid, or
/// whichever of some thirty ways meets nothing (exact). At edges of four and more triangles the two at each
/// wedge of solid stay together. For surfaces that don't meet themselves elsewhere, with as many triangles
/// running one way as the other at each edge. None, with some fans moved, where the wedges can't be told or
/// no way was found. Cost O(n log n).
std::optional<Separated> separate(Patchwork& surface, double distance, const Exec& exec);

}  // namespace sherd
