// The boundary of what a surface winds around.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "repair/patchwork.h"

namespace sherd {

struct Hull {
  Patchwork surface;        ///< rounded to doubles, not yet checked for what that does to it
  std::size_t pairs = 0;    ///< of triangles that met
  std::vector<Index> lost;  ///< triangles that stand free on both sides and bound nothing: leaves
  std::vector<Vec3>
      backward;  ///< m, corners and middles of faces around space of negative winding number, left out
};

/// The surface, cut along all lines in which it meets itself (arrangement.h), without the parts that don't
/// bound the space of winding number above 0, or with `bothWays` other than 0. Winding numbers are exact:
/// crossings of a line through each patch of faces with the surface, counted in exact arithmetic. At each
/// edge of the given surface as many triangles must run one way as the other, with none of zero area.
/// Triangles that meet no other one stay bitwise as they are. More than `pairLimit` pairs per thousand
/// triangles, or so, are an error.
Result<Hull> outerHull(const Patchwork& surface, bool bothWays, std::size_t pairLimit, const Exec& exec);

}  // namespace sherd
