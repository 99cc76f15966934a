// Where pieces touch: what holds a body together in a simulator until it is overcome.
#pragma once

#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/fragments.h"

namespace sherd {

struct Bond {
  Index low = -1, high = -1;     ///< pieces, low < high
  double area = 0;               ///< m²
  Vec3 centroid = Vec3::Zero();  ///< m, of the contact's area
  Vec3 normal = Vec3::Zero();    ///< unit, mean over the contact, from `low` to `high`; 0 where the contact
                                 ///< faces all ways alike (one piece inside the other)
};

/// One per pair of pieces with a common crack face, ascending by (low, high). Fails where a crack triangle
/// has no twin. Cost O(n log n).
Result<std::vector<Bond>> findBonds(const Fragments& fragments, const Exec& exec);

/// Per piece the bonds that it takes part in, ascending by the other piece.
std::vector<std::vector<Bond>> bondsByPiece(const std::vector<Bond>& bonds, std::size_t pieces);

}  // namespace sherd
