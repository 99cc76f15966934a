// Lengths of ways inside a body from a few nodes spread over it: what metrics are fitted to.
#pragma once

#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "embed/part.h"

namespace sherd {

struct Landmark {
  std::size_t node;
  std::vector<double> length;  ///< m, of the way to every node of the part; infinite where there is none
};

/// Up to 64 nodes, each the farthest from those before in the body as it is, whatever its stretch. Lengths
/// are those of paths (PathGraph, with the stretch) divided by the median ratio to the straight distance over
/// pairs 3 to 8 links apart (without), which takes out their zigzag. Cost O(landmarks · links · log nodes).
/// Errors: cancelled.
Result<std::vector<Landmark>> landmarksOf(const BodyPart& part, const Exec& exec);

}  // namespace sherd
