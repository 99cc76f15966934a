// Lines 7 to 9 of Algorithm 1 (Schvartzman and Otaduy 2014): a body moves until it is hit, and
// the hit deforms it.
//
// The impulses J of the first impact (rigid/rigid.h) become forces F = 1.84 J / T, the peak of Hertz's
// contact of duration T; a force acts as a pressure over a patch of the surface (simulate/patch_load.h);
// and the body's quasi-static deformation under these and the d'Alembert forces (simulate/statics.h) gives
// its strain energy. With a given contact duration that energy is ∝ J², so ∝ the drop height; with
// Hertz's, F ∝ v^(6/5).
//
// Known limit: the duration is that of the contact alone. A slender body's own compliance would lengthen it;
// without that its quasi-static energy can be larger than the kinetic energy of the hit.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "rigid/rigid.h"
#include "simulate/elements.h"
#include "types/fields.h"

namespace sherd {

struct SimulateParams : RigidParams {
  double threshold = 0;  ///< N·s, ≥ 0: a hit whose impulses add up to less deforms nothing
  /// Quadratic ones cost some fifteen times as much on the same tetrahedra and are worth it where energies
  /// matter to a few per cent: in bending, linear ones are too stiff unless several lie across the thickness.
  ElementOrder elements = ElementOrder::Linear;
  /// Quadratic elements: smaller ones where the impact presses and where they would hold much of the energy
  /// (simulate/impact_refinement.h). Linear ones are never refined.
  bool refine = true;
};

struct SimulateOutput {
  EnergyField energy;  ///< material is params.body; all zero with a hit below the threshold
  Impact impact;
};

/// mesh: the body, its tetrahedra enclosing its surface. Bit-identical for any number of threads. Says
/// to the user: what was hit, how much energy it gave and what memory that took at most, or that the hit is
/// below the threshold: then statics are skipped. Errors: nothing is hit, by the parameter to change
/// (whyNoImpact); those of dropUntilImpact, Statics::factor and PatchLoader::add; an energy that isn't
/// finite, or not to be had since the body is too flat or hangs together by too little. Cost: the
/// factorization, O(nodes²) at most and most of the time; O(triangles) per contact; refinement some ten
/// back-substitutions and the factorization of what is refined.
Result<SimulateOutput> simulate(std::shared_ptr<const TetMesh> mesh, const SimulateParams& params,
                                const Exec& exec);

/// Peak forces of an impact, N, per element node.
Result<std::vector<Vec3>> impactForces(std::shared_ptr<const Elements> elements, const Impact& impact);

/// What learning needs of an impact.
struct ImpactEnergy {
  double total = 0;                ///< J
  std::vector<double> nodeEnergy;  ///< J, per node of the mesh: EnergyField::nodeEnergy
};

/// Takes the energies of the impacts from number `first` on, and may say that something went wrong.
using ImpactEnergySink = std::function<Result<void>(std::size_t first, std::vector<ImpactEnergy> energies)>;

/// The energies that simulate() finds for these impacts, to the bit (total: that of `work` up to rounding),
/// with one factorization and blocks of kSolveWidth back-substitutions: for training on a thousand impacts of
/// a body. What is refined is refined for each impact on its own. `sink` is called with some of them at a
/// time, in their order, by the calling thread. Impacts that hit nothing have no energy. Errors: those of
/// `sink`, Statics::factor and PatchLoader::add; an energy that isn't finite, or not to be had since the body
/// is too flat or hangs together by too little; cancelled. Memory beyond the factor: O(nodes) for each of
/// some hundred impacts.
Result<void> eachImpactEnergy(std::shared_ptr<const TetMesh> mesh, std::span<const Impact> impacts,
                              const Material& material, ElementOrder elements, bool refine, const Exec& exec,
                              const ImpactEnergySink& sink);

/// The same, all at once.
Result<std::vector<ImpactEnergy>> impactEnergies(std::shared_ptr<const TetMesh> mesh,
                                                 std::span<const Impact> impacts, const Material& material,
                                                 ElementOrder elements, bool refine, const Exec& exec);

/// J: total strain energy.
double totalEnergy(const EnergyField& field);

}  // namespace sherd
