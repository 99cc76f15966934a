// How the surface and the sheets cut each other: crossings, their order along edges, and the segments they
// bound. Decided by exact predicates under Simulation of Simplicity, so that every pair of triangles that
// meets does so in one segment with two ends; nothing here depends on a rounded coordinate.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "geometry/edge_table.h"
#include "tessellate/crack_complex.h"
#include "types/tet_mesh.h"

namespace sherd {

/// An edge of one mesh through a triangle of the other.
struct Crossing {
  Index edge;      ///< in its own mesh's EdgeTable
  Index triangle;  ///< in the other mesh
  bool fromFront;  ///< the edge's lower end lies in front of the triangle
  Index vertex;    ///< its number in Arrangement::positions
};

/// The segment in which a surface triangle and a crack triangle meet, directed so that on the surface (seen
/// from outside) the crack triangle's back cell lies on its left.
struct Segment {
  Index surface, crack;  ///< triangles
  Index from, to;        ///< vertices
};

/// Crossings of one mesh's edges, grouped by edge and ordered along it from its lower end.
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
  std::vector<Triangle> crack;  ///< the sheets' triangles with their numbers shifted by firstCrack
  std::vector<Vec3> positions;
  Index firstCrack = 0, firstNew = 0;
  std::vector<Index> same;  ///< per vertex: the least-numbered one that rounding put on the same spot
  EdgeTable surfaceEdges, crackEdges;  ///< crackEdges' ends are unshifted numbers of the complex
  EdgeCrossings surfaceCrossings, crackCrossings;
  std::vector<Segment> segments;    ///< by (surface, crack)
  std::vector<Index> surfaceLabel;  ///< per surface vertex: the cell that it lies in
  std::vector<bool> crackInside;    ///< per crack vertex: lies inside of the surface
};

/// `tets.surface` is closed, coherently oriented and free of self-intersections. Error where the pairing of
/// ends does not come out even, which a surface that is not so can cause. Cost O(surface) for its edges plus
/// O(candidate pairs).
Result<Arrangement> arrange(const TetMesh& tets, std::span<const Index> nodeLabel,
                            const CrackComplex& complex, const Exec& exec);

}  // namespace sherd
