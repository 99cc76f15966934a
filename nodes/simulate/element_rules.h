// How the energy of each element is integrated: over the part of it inside the surface.
//
// Strains of linear elements are constant, so that the part's volume says it all. Those of quadratic ones are
// linear, and their products' integrals over the part follow from its ∫ ξ_i ξ_j (geometry/tet_share.h): an
// element that a thin leg passes through is as stiff as the leg is where it is, not as if the leg's stuff
// were spread over the element, which bends far less.
#pragma once

#include <span>
#include <vector>

#include "base/exec.h"
#include "simulate/elements.h"

namespace sherd {

/// ∫ ξ_i ξ_j / V over the part of tetrahedron t inside the surface; zero where the surface that it holds does
/// not account for its insideFraction.
Eigen::Matrix4d productsInside(const TetMesh& mesh, std::size_t t);

class ElementRules {
 public:
  /// `share`: of each tetrahedron's stiffness that counts (stiffnessShares). What it has beyond the mesh's
  /// insideFraction is spread evenly over the tetrahedron; so is all of it where the surface that the
  /// tetrahedron holds does not account for its insideFraction (meshes that were given fractions by hand).
  /// Cost for quadratic elements O(held triangles); unfit for use when cancelled.
  ElementRules(const Elements& elements, std::span<const double> share, const Exec& exec);

  /// Of quadratic elements whose rules are known, one per tetrahedron.
  ElementRules(const Elements& elements, std::vector<ElementRule> rules);

  /// Of tetrahedron t; `nodes`: of the mesh, in any unit.
  ElementGradients gradients(std::span<const Vec3> nodes, std::size_t t) const;

 private:
  const TetMesh* mesh_;
  ElementOrder order_;
  std::vector<Index> ruleOf_;  ///< per tetrahedron, into rules_
  std::vector<ElementRule> rules_;
};

}  // namespace sherd
