// What Statics is made of, before factoring: shares of tetrahedra, connected parts, the stiffness matrix.
#pragma once

#include <span>
#include <vector>

#include "simulate/element.h"
#include "simulate/sparse_cholesky.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Per tetrahedron, the share of its stiffness that counts: insideFraction, or kLeastSupport where one of its
/// nodes rests on less.
std::vector<double> stiffnessShares(const TetMesh& mesh);

/// Per node, the number of its connected part; parts are numbered by their lowest node. Returns their count.
Index connectedParts(const TetMesh& mesh, std::vector<Index>& partOf);

/// Σ_t weight_t K_t for E = 1, `weight` per tetrahedron being the volume that counts.
BlockMatrix assembleStiffness(std::span<const Vec3> nodes, std::span<const Tetra> tets,
                              std::span<const double> weight, const Lame& lame);

/// Adds six springs to the diagonal blocks that hold the part of `members` against rigid motion and nothing
/// else: all of the first of three nodes, the second across the line to it, the third across the three
/// nodes' plane. `start` (−1: the farthest from the centre) is the first; the other two are the farthest
/// from it and from the line.
void addGauge(BlockMatrix& stiffness, std::span<const Vec3> nodes, std::span<const Index> members,
              Index start);

}  // namespace sherd
