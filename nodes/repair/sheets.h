// Sheets that hang on a solid: stray faces, fins, flags.
#pragma once

#include <vector>

#include "base/exec.h"
#include "repair/footing.h"
#include "repair/patchwork.h"

namespace sherd {

/// Open, and a solid without.
struct DanglingSheet {
  std::vector<Index> triangles;  ///< ascending
  double area = 0;               ///< m²
  Vec3 place = Vec3::Zero();     ///< m, a corner
};

/// Faces that hang together across edges of two triangles, have open edges, end in edges of three or more
/// triangles, bound next to no volume when their borders are filled (less than `thickness` times their area
/// times their diagonal), and without which what is left is as closed at those edges as it would be: an even
/// number of other triangles, two at least for one sheet of those that hang together. Neighbours agree in
/// which way they face. In the order of their first triangles. Cost O(n), and that of filling the borders.
std::vector<DanglingSheet> danglingSheets(const Patchwork& surface, double thickness, const Exec& exec);

enum class SheetPlace {
  Free,      ///< off the solid
  Touching,  ///< some of it on the solid or in it
  Within     ///< all of it
};
/// Where the sheet is, by points of each triangle a fiftieth of the solid apart. `on`: m, as far off the
/// solid counts as touching.
SheetPlace placeOf(const Patchwork& surface, const std::vector<Index>& sheet, const Footing& solid,
                   double on);
/// Does a slab of `thickness` (m) around the sheet share more with the solid than a touch? By the same
/// points.
bool slabOverlaps(const Patchwork& surface, const std::vector<Index>& sheet, const Footing& solid,
                  double thickness);

double areaOf(const Patchwork& surface, const std::vector<Index>& sheet);

}  // namespace sherd
