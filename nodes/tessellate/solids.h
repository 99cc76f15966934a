// Which parts bound which connected solid.
#pragma once

#include <span>
#include <vector>

#include "tessellate/cell_parts.h"

namespace sherd {

struct Solid {
  Index cell = -1;
  SolidSums sums;  ///< about TrianglePatches::origin
};

struct Solids {
  std::vector<Solid> list;
  std::vector<Index> ofPart;  ///< per part of CellParts
  std::size_t detached = 0;   ///< solids beyond the first of their cells
};

/// Joins a cell's parts over their edges into shells, and gives each void to the smallest solid of its cell
/// that holds it. A shell of no volume that nothing holds is a solid of its own. Cost O(parts), and O(faces)
/// of its cell for each void.
Solids findSolids(CellParts& parts, std::span<const Vec3> positions);

}  // namespace sherd
