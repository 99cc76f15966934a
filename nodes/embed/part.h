// A connected part of a tetrahedral mesh, with nodes numbered on their own, and its border.
#pragma once

#include <span>
#include <vector>

#include "types/tet_mesh.h"

namespace sherd {

/// Where a mesh's nodes are when distances are taken, and by how much lengths count there.
struct MetricNodes {
  std::span<const Vec3> places = {};     ///< m, per node
  std::span<const double> stretch = {};  ///< per node, > 0; empty: 1 everywhere
};

struct BodyPart {
  std::vector<Index> node;      ///< per node of the part: its number in the whole mesh, ascending
  std::vector<Vec3> positions;  ///< m, where distances are taken
  std::vector<double> stretch;  ///< per node, what lengths there are multiplied by; empty: 1 everywhere
  std::vector<Tetra> tets, neighbours;
  std::vector<double> volume;  ///< m³, lumped, of the mesh's tetrahedra as a whole

  std::vector<Index> borderNode;  ///< per vertex of the border: its number in the part
  std::vector<Vec3> borderPositions;
  std::vector<double> borderStretch;      ///< per vertex of the border; empty: 1 everywhere
  std::vector<Triangle> borderTriangles;  ///< in border vertices, counter-clockwise from outside
  /// m, straight between two nodes, as lengths at these count.
  double lengthBetween(std::size_t a, std::size_t b) const {
    const double length = (positions[a] - positions[b]).norm();
    return stretch.empty() ? length : 0.5 * (stretch[a] + stretch[b]) * length;
  }
  int shells = 0;  ///< connected pieces of the border: 2 for a body with a void
};

/// The parts that no edge connects, in order of their lowest nodes. Cost O(tets log tets).
std::vector<BodyPart> bodyParts(const TetMesh& mesh, const MetricNodes& nodes);

}  // namespace sherd
