// How many fragments: the smallest number N of sites, grown one at a time, with E_D(N) < γ.
// Schvartzman and Otaduy (2014), section 2.2: the fracture degree is the smallest for which the energy of the
// centroidal Voronoi diagram falls below the material's threshold γ.
//
// Deviation: the paper adds sites and searches anew from random starts, whose E_D rises with N now and then,
// so that a first N below γ means little. Here each site is added to the converged ones (drawn by the seed
// with probability ∝ w ‖x̄ − p̄‖²) and Lloyd's iteration goes on from there: E_D never rises with N. With N = 1
// the site is the body's centroid by volume: E_D(1) < γ means that the hit is too weak to break it.
#pragma once

#include <memory>

#include "base/exec.h"
#include "base/result.h"
#include "types/degree_model.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

/// What to do with a hit that lies far outside of what a model was made of.
enum class OutsideModel { Search, Predict };

struct PredictDegreeParams {
  double gamma = 1e-4;  ///< J·m², ≥ 0: halved, more pieces
  int degree = 0;       ///< ≥ 0; 0: from the energy, otherwise that many sites, whatever γ
  std::int64_t seed = 1;
  int maxDegree = 1000;  ///< ≥ 1, of the search by γ, and of what a model foretells
  OutsideModel outside = OutsideModel::Search;
};

/// Sites p̄_j (m, in the embedding), E_D and γ, or 0 and `degreeGiven`. γ = 0 itself asks for every site there
/// can be. Says the outcome; warns where `maxDegree`, or the number of distinct nodes (that weigh), ends the
/// search before γ is reached. Errors: those of cvd (sizes, finiteness), parameters out of range. Cost: that
/// of N runs of Lloyd's iteration from nearly converged sites.
Result<Sites> predictDegree(const WeightField& weights, const Embedding& embedding,
                            const PredictDegreeParams& params, const Exec& exec);

/// The same with what was learned of the body in place of the search: as many sites as the model foretells,
/// grown as with `degree`; a degree that is given goes before. Says what it foretells; warns where the hit
/// lies outside of what the model was made of, and then does as `outside` says. Errors: also a model that was
/// made for something else, by all that differs. Cost beyond growing: that of estimateDegree
/// (learn_degree/learn_degree.h).
Result<Sites> predictByModel(const DegreeModel& model, const WeightField& weights,
                             const std::shared_ptr<const Embedding>& embedding,
                             const PredictDegreeParams& params, const Exec& exec);

}  // namespace sherd
