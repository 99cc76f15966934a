// Energy, toughness and the artist's exponent become the one field of weights that all later steps use.
//
//   ρ_n = e_n / V_n                       energy density (J/m³)
//   w_n = c β_n V_n ρ_n^α                 with c such that Σ c V ρ^α = Σ e, and 0⁰ = 1
//
// Schvartzman and Otaduy (2014), section 2.4, raise the lumped energy itself to α. That is an integral over
// the node's share of the body, so α = 0 would mean "equal weight per node", a property of the meshing.
// Raising the density instead makes α = 0 mean "equal weight per volume", and the rescaling keeps the amount
// of energy (and with it the meaning of γ) while α moves it about. β multiplies after the rescaling: β > 1
// everywhere is a body that is more fragile, not only one whose energy lies elsewhere.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/scalar_grid.h"

namespace sherd {

struct WeightsParams {
  double alpha = 1;  ///< in [0, 4]; 0: where the energy is doesn't matter, > 1: drawn to where it is highest
};

/// `energy.nodeEnergy`: J per node of energy.tets, finite and ≥ 0. `beta`: null for 1 everywhere; a constant
/// grid is read once and costs nothing; one whose paint leaves all of the body at its background is warned
/// of, with the places of both. The result has one weight ≥ 0 per node; a node with V_n = 0 (it lies outside
/// the surface with all its tetrahedra) weighs 0. All energies 0 give all weights 0. Errors: sizes that don't
/// match; energy or β that is negative, NaN or infinite, with node and place; α out of range. Cost O(nodes +
/// tets).
Result<WeightField> weights(const EnergyField& energy, const ScalarGrid* beta, const WeightsParams& params,
                            const Exec& exec);

}  // namespace sherd
