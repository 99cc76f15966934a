// Exact cells: the lower envelope of the sites' values in each tetrahedron (design section 4, point 11).
//
// Cell j is where g_j (site_values.h) is least. The sheet between j and k in a tetrahedron is the convex
// polygon
//   { g_j = g_k ≤ g_l for every other site l },
// cut out of the plane g_j = g_k by the tetrahedron's faces and by each l in turn. Its corners are the points
// where an edge of the tetrahedron meets two sites' values, a face three, or its inside four; they are named
// by (nodes, sites) in ascending order, computed once, and the same seen from every tetrahedron around. Sites
// that are least at no node appear like any other.
#pragma once

#include <array>
#include <vector>

#include "base/exec.h"
#include "tessellate/sheets.h"
#include "tessellate/site_values.h"
#include "types/partition.h"

namespace sherd {

/// What an edge of a polygon lies on.
struct SheetEdgeLine {
  int face;     ///< of its tetrahedron (kTetraFace), −1 for none
  Index third;  ///< the rank of the site that is equally near there, −1 for none
};

struct ExactSheets {
  Sheets sheets;
  std::vector<std::array<Index, 2>> ranks;  ///< per polygon: back and front by rank, ascending
  std::vector<SheetEdgeLine> lines;         ///< per corner: of the edge that begins there

  std::span<const SheetEdgeLine> linesOf(Index polygon) const {
    const SheetPolygon& p = sheets.polygons[at(polygon)];
    return std::span(lines).subspan(at(p.first), at(p.count));
  }
};

/// All predicates are exact in the doubles of `values` (filtered, then in rational numbers), with its ties;
/// positions are rounded. The sheets are not connected yet. Tetrahedra that lie outside of the surface are
/// left out. Cost O(tets · (sites + m³)) with m sites that contend for a tetrahedron, mostly 1 to 3; in
/// parallel over tetrahedra.
ExactSheets exactSheets(const TetMesh& tets, const SiteValues& values, const Exec& exec);

}  // namespace sherd
