// Closes what is open.
#pragma once

#include <vector>

#include "base/exec.h"
#include "repair/patchwork.h"

namespace sherd {

struct Hole {
  std::size_t edges = 0;
  double size = 0;            ///< m, diagonal of the border's bounding box
  Vec3 place = Vec3::Zero();  ///< m, a vertex of the border
};

/// Fills every hole with triangles between the vertices of its border, so that at each edge of the surface as
/// many triangles run one way as the other; whatever faces how, that makes winding numbers whole. Holes of up
/// to 2000 edges get the triangles of least dihedral angle and area (CGAL, Liepa 2003); longer ones a strip
/// that takes the shorter diagonal at each step. Corners take the attributes of the faces at the border.
/// Needs coherent neighbours (orient first). Cost O(border²) at worst.
std::vector<Hole> fillHoles(Patchwork& surface, const Exec& exec);

}  // namespace sherd
