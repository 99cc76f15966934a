// Surfaces without a solid behind them, such as leaves and cloth.
#pragma once

#include <span>

#include "repair/patchwork.h"

namespace sherd {

/// Adds a closed slab around the given triangles: each moved half of `thickness` (m) to the front and to the
/// back, along normals averaged at the vertices, with walls along their borders. The triangles themselves
/// stay.
void addSlabs(Patchwork& surface, std::span<const Index> triangles, double thickness);

}  // namespace sherd
