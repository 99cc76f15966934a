// Which vertices of an arrangement lie on one spot but for rounding.
#pragma once

#include <vector>

#include "tessellate/arrangement.h"

namespace sherd {

/// Per vertex the one that stands for all within Arrangement::spot of it: of the sheets' vertices, the
/// crossings, and the corners of cut triangles, the only ones that can meet there, each goes to the nearest
/// of those that were numbered before and stand for themselves. Cost O(new vertices), and to number the
/// others.
std::vector<Index> equalPositions(const Arrangement& arrangement);

}  // namespace sherd
