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

#include <memory>

#include "base/exec.h"
#include "base/result.h"
#include "rigid/rigid.h"
#include "types/fields.h"

namespace sherd {

struct SimulateParams : RigidParams {
  double threshold = 0;  ///< N·s, ≥ 0: a hit whose impulses add up to less deforms nothing
};

struct SimulateOutput {
  EnergyField energy;  ///< material is params.body; all zero with a hit below the threshold
  Impact impact;
};

/// mesh: the body, its tetrahedra enclosing its surface. Bit-identical for any number of threads. Says
/// to the user: what was hit and how much energy it gave, or that the hit is below the threshold: then
/// statics are skipped. Errors: nothing is hit, by the parameter to change (whyNoImpact); those of
/// dropUntilImpact, Statics::factor and PatchLoader::add. Cost: the factorization, O(nodes²) at most and most
/// of the time; O(triangles) per contact.
Result<SimulateOutput> simulate(std::shared_ptr<const TetMesh> mesh, const SimulateParams& params,
                                const Exec& exec);

/// Nodal peak forces of an impact, N. For one who drops a body again and again and keeps its Statics.
Result<std::vector<Vec3>> impactForces(std::shared_ptr<const TetMesh> mesh, const Impact& impact);

/// J: total strain energy.
double totalEnergy(const EnergyField& field);

}  // namespace sherd
