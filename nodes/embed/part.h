// A connected part of a tetrahedral mesh, with nodes numbered on their own, and its border.
#pragma once

#include <span>
#include <vector>

#include "types/tet_mesh.h"

namespace sherd {

struct BodyPart {
  std::vector<Index> node;      ///< per node of the part: its number in the whole mesh, ascending
  std::vector<Vec3> positions;  ///< m, where distances are taken
  std::vector<Tetra> tets, neighbours;
  std::vector<double> volume;  ///< m³, lumped, of the mesh's tetrahedra as a whole

  std::vector<Index> borderNode;  ///< per vertex of the border: its number in the part
  std::vector<Vec3> borderPositions;
  std::vector<Triangle> borderTriangles;  ///< in border vertices, counter-clockwise from outside
  int shells = 0;                         ///< connected pieces of the border: 2 for a body with a void
};

/// The parts that no edge connects, in order of their lowest nodes. Cost O(tets log tets).
/// `places`: per node of the mesh, where it is when distances are taken.
std::vector<BodyPart> bodyParts(const TetMesh& mesh, std::span<const Vec3> places);

}  // namespace sherd
