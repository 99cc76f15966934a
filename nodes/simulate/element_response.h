// What displacements give: the force K u of every node and the energy of every tetrahedron, for one load or
// a block of loads side by side.
//
// Every number of every load goes through the same operations in the same order whatever the width: a load's
// bits do not depend on what is computed beside it.
#pragma once

#include <span>
#include <vector>

#include "simulate/element_rules.h"
#include "simulate/elements.h"
#include "simulate/supernodal_solve.h"

namespace sherd {

class ElementResponse {
 public:
  /// All of them are referred to. `nodes`: of the mesh, in any unit; `volume`: that counts, per tetrahedron.
  ElementResponse(const Elements& elements, const ElementRules& rules, std::span<const Vec3> nodes,
                  std::span<const double> volume, const VolumetricSplit& lambda, double mu)
      : elements_(elements), rules_(rules), nodes_(nodes), volume_(volume), lambda_(lambda), mu_(mu) {}

  /// Displacements and what they give, `width` (1 or kSolveWidth) loads beside each other.
  struct Block {
    std::size_t width;
    const double* displacement;  ///< [element node][axis][load]
    const double* dilatation;    ///< [mesh node][load], that the averaged part of λ acts on; may be null,
                                 ///< as it must be for quadratic elements
    double* force;               ///< as the displacement; added to
    double* energy;              ///< [tetrahedron][load]
  };
  /// For E = 1. Without `dilatation` the averaged part of λ acts on each element's mean.
  void add(const Block& block) const;

  /// Σ_t w_t tr ε_t / 4 per node of the mesh, of linear elements, added to `sum`: [mesh node][load].
  void addDilatation(std::size_t width, const double* displacement, double* sum) const;

 private:
  const Elements& elements_;
  const ElementRules& rules_;
  std::span<const Vec3> nodes_;
  std::span<const double> volume_;
  VolumetricSplit lambda_;
  double mu_;
};

}  // namespace sherd
