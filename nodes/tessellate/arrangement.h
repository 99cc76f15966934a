// How the surface and the sheets cut each other: crossings, their order along edges, and the segments they
// bound. What fills it decides by exact predicates and consistent ties, so that every surface triangle that
// meets a sheet polygon does so in one segment with two ends; nothing here depends on a rounded coordinate.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "tessellate/envelope.h"
#include "tessellate/sheets.h"
#include "types/tet_mesh.h"

namespace sherd {

/// An edge of the surface through a sheet polygon, or an edge of the sheets through a surface triangle.
struct Crossing {
  Index edge;      ///< of the surface: in Arrangement::cutEdges; of the sheets: in Sheets::edges
  Index through;   ///< the polygon, or the surface triangle
  bool fromFront;  ///< the edge's lower end lies in front of it
  Index vertex;    ///< its number in Arrangement::positions
};

/// The segment in which a surface triangle and a sheet polygon meet, directed so that on the surface (seen
/// from outside) the polygon's back cell lies on its left.
struct Segment {
  Index surface, polygon;
  Index from, to;  ///< vertices
};

/// Crossings grouped by edge and ordered along it from its lower end.
struct EdgeCrossings {
  std::vector<Crossing> list;
  std::vector<Index> begin;  ///< per edge, into list; one more at the end
  std::span<const Crossing> on(Index edge) const {
    return std::span(list).subspan(at(begin[at(edge)]), at(begin[at(edge) + 1] - begin[at(edge)]));
  }
};

/// Vertex numbers: the surface's vertices, then the sheets' (from firstCrack), then the crossings (from
/// firstNew).
struct Arrangement {
  std::span<const Triangle> surface;
  std::vector<Vec3> positions;
  Index firstCrack = 0, firstNew = 0;
  double spot = 0;          ///< m: how far rounding may put vertices apart that are one
  std::vector<Index> same;  ///< per vertex: the one that stands for all on its spot (equal_positions.h)
  std::vector<Index> surfaceLabel;  ///< per surface vertex: the cell that it lies in

  std::vector<Index> cutTriangles;  ///< surface triangles that a sheet crosses, ascending
  std::vector<std::array<Index, 3>>
      edgesOfCut;  ///< per cut triangle: its sides in cutEdges, −1 where nothing crosses
  std::vector<std::array<Index, 2>> cutEdges;  ///< crossed surface edges: ends, ascending
  EdgeCrossings surfaceCrossings;              ///< by cutEdges
  std::vector<Segment> segments;               ///< by (surface, polygon)
  std::vector<Index> segmentBegin;             ///< per cut triangle, into segments; one more at the end

  EdgeCrossings sheetCrossings;                  ///< by Sheets::edges
  std::vector<Index> byPolygonBegin, byPolygon;  ///< per polygon: the segments in it
  std::vector<unsigned char> sheetInside;        ///< per sheet vertex: lies inside of the surface
};

// `spot` (m, > 0) becomes Arrangement::spot.

/// The surface against exact sheets, which are connected on the way, with the predicates of symbolic_sign.h.
/// `tets.surface` is closed, coherently oriented and free of self-intersections. Error where what was found
/// does not fit together, which a surface that is not so can cause. Cost O(surface vertices) for their cells,
/// plus O(triangles held by tetrahedra with a sheet).
Result<Arrangement> arrangeExact(const TetMesh& tets, ExactSheets& exact, const SiteValues& values,
                                 double spot, const Exec& exec);

/// The surface against sheets with rounded vertices, under Simulation of Simplicity of all (exact_points.h).
/// `nodeLabel`: the cell of each node.
Result<Arrangement> arrangeRounded(const TetMesh& tets, std::span<const Index> nodeLabel,
                                   const Sheets& sheets, double spot, const Exec& exec);

/// The cage's boundary as the surface: the sheets end on it, and nothing is clipped. `tets.surface` is that
/// boundary with its triangles in the order of TetMesh::boundary; `nodeOf`: per surface vertex its node;
/// `nodeCell`: per node its cell. Cost O(boundary + sheets).
Result<Arrangement> arrangeConforming(const TetMesh& tets, std::span<const Index> nodeOf,
                                      std::span<const Index> nodeCell, const Sheets& sheets, double spot);

}  // namespace sherd
