// What Statics is made of, before factoring: shares of tetrahedra, connected parts, the stiffness matrix.
#pragma once

#include <span>
#include <vector>

#include "simulate/element_rules.h"
#include "simulate/elements.h"
#include "simulate/sparse_cholesky.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Per tetrahedron, the share of its stiffness that counts: insideFraction but at least kLeastShare, or
/// kLeastSupport (kLeastQuadraticSupport) where one of its element's nodes rests on less.
std::vector<double> stiffnessShares(const Elements& elements);

/// Per node of the mesh, the number of its connected part; parts are numbered by their lowest node. Returns
/// their count.
Index connectedParts(const TetMesh& mesh, std::vector<Index>& partOf);

/// The volume strain θ_n = Σ_t w_t tr ε_t / Σ_t w_t over a node's tetrahedra, of linear elements (Bonet and
/// Burton 1998, "A simple average nodal pressure tetrahedral element"). `weight`: volume that counts, per
/// tetrahedron.
struct NodalAverages {
  NodalAverages(const TetMesh& mesh, std::span<const double> weight);
  std::vector<Index> begin, tet;  ///< per node its tetrahedra: tet[begin[n]] … tet[begin[n + 1] − 1]
  std::vector<double> volume;     ///< per node: Σ_t w_t / 4
};

/// Σ_t w_t K_t for E = 1, `weight` per tetrahedron being the volume that counts, over the mesh's `nodes` (in
/// any unit). The averaged part of λ (VolumetricSplit) acts on the element's mean volume strain if elements
/// are quadratic, on θ_n of NodalAverages if linear: the latter couples the nodes of two adjoining rings.
BlockMatrix assembleStiffness(const Elements& elements, const ElementRules& rules,
                              std::span<const Vec3> nodes, std::span<const double> weight, double mu,
                              const VolumetricSplit& lambda);

/// Adds six springs to the diagonal blocks that hold the part of `members` against rigid motion and nothing
/// else: all of the first of three nodes, the second across the line to it, the third across the three
/// nodes' plane. `start` (−1: the farthest from the centre) is the first; the other two are the farthest
/// from it and from the line.
void addGauge(BlockMatrix& stiffness, std::span<const Vec3> nodes, std::span<const Index> members,
              Index start);

}  // namespace sherd
