// Surfaces without a solid behind them, such as leaves and cloth.
#pragma once

#include <span>

#include "repair/footing.h"
#include "repair/patchwork.h"

namespace sherd {

/// Adds a closed slab around the given triangles: each moved half of `thickness` (m) to the front and to the
/// back, along normals averaged at the vertices, with walls along their borders. The triangles themselves
/// stay. With a `footing`, vertices near it are first moved into that (Footing::reach), so that slab and
/// solid overlap.
void addSlabs(Patchwork& surface, std::span<const Index> triangles, double thickness,
              const Footing* footing = nullptr);

}  // namespace sherd
