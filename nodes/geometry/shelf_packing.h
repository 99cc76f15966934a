// Places rectangles side by side.
#pragma once

#include <vector>

#include "types/vec.h"

namespace sherd {

/// The lower left corners of rectangles of the given sizes (width, height ≥ 0) so that no two overlap, with a
/// gap between them of a fiftieth of their mean side: shelves from the highest rectangle to the lowest, in
/// about a square from (0, 0). Cost O(n log n).
std::vector<Vec2> packShelves(const std::vector<Vec2>& sizes);

}  // namespace sherd
