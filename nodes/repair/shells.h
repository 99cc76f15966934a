// Which way the parts of a surface face.
#pragma once

#include "base/exec.h"
#include "geometry/inspect_surface.h"
#include "repair/patchwork.h"

namespace sherd {

/// Makes neighbours across edges of two triangles agree, the fewer being turned. One-sided parts stay with an
/// edge at which they don't. Counts the turned triangles. Cost O(n).
Defect makeCoherent(Patchwork& surface);

/// Finds parts that bound next to no volume even now that their holes are filled: less than `thickness` times
/// their area times their diagonal. Their triangles, ascending, those that fill their holes among them. Cost
/// O(n log n).
std::vector<std::vector<Index>> findLeaves(const Patchwork& surface, double thickness);

struct Shells {
  Defect inverted;  ///< parts that were turned
  Defect inner;     ///< parts that lay in the solid and faced outward
};
/// For closed surfaces. From the largest volume to the smallest: a part that lies in no solid is turned to
/// face outward, and with it what lies in it; one in a solid that faces inward is the wall of a void; one in
/// a solid that faces outward bounds nothing and, unless `crossing`, is left out where `dropInner` and turned
/// to be a void's wall otherwise. `crossing` tells of each triangle whether it meets another one: what
/// crosses is for the winding number to resolve. Cost O(n log n) for parts whose boxes don't overlap much.
Shells faceOutward(Patchwork& surface, bool dropInner, const std::vector<bool>& crossing, const Exec& exec);

}  // namespace sherd
