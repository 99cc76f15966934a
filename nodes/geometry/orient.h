// Turns triangles so that a closed surface faces outward: shells against the outside, walls of voids into
// them.
#pragma once

#include <span>
#include <vector>

#include "geometry/edge_table.h"
#include "types/tri_mesh.h"

namespace sherd {

/// One edge-connected part of a surface.
struct SurfacePart {
  std::vector<Index> triangles;  ///< ascending
  bool closed = false;           ///< every edge is in exactly two of its triangles
  bool orientable =
      false;  ///< its triangles can be turned so that all neighbours agree; false if not manifold
  std::vector<Index>
      odd;              ///< the fewest triangles to be turned for that, ascending; none where not orientable
  Index conflict = -1;  ///< where not orientable, an edge at which the attempt fails
};

/// The parts, in the order of their first triangles. Cost O(triangles).
std::vector<SurfacePart> surfaceParts(std::span<const Triangle> triangles, const EdgeTable& edges);

/// Signed volume of each closed, coherent shell, and how many others it lies in (by its first corner; exact).
struct Nesting {
  std::vector<double> volume;  ///< m³; 0 for shells that are not closed or not coherent
  std::vector<int> depth;      ///< even: a solid's outside; odd: the wall of a void
};
/// A tree is built only for a shell whose box holds a corner of another. Touching and crossing shells are not
/// told from others: that is for the search for self-intersections to find.
Nesting nestShells(const TriMesh& mesh, const std::vector<SurfacePart>& shells);

struct Turned {
  std::size_t triangles = 0;  ///< that ran against their neighbours
  std::size_t shells = 0;     ///< outsides that were inside out
  std::size_t voids = 0;      ///< walls of voids that faced the solid
};

/// Makes every orientable shell coherent (the fewer of its triangles are turned), then, where all shells are
/// closed, each face outward: volume > 0 at even depth, < 0 at odd. Attributes follow their corners. Where
/// most of a turned set's normals then point inward, they are negated: they had been made for the wrong
/// winding.
Turned orient(TriMesh& mesh);

}  // namespace sherd
