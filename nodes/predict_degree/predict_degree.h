// How many fragments: the smallest number N of sites, grown one at a time, with E_D(N) < γ.
// Schvartzman and Otaduy (2014), section 2.2: the fracture degree is the smallest for which the energy of the
// centroidal Voronoi diagram falls below the material's threshold γ.
//
// Deviation: the paper adds sites and searches anew from random starts, whose E_D rises with N now and then,
// so that a first N below γ means little. Here each site is added to those before (drawn by the seed with
// probability ∝ w ‖x̄ − p̄‖²) and a few passes of Lloyd's iteration go on from there (growSite): E_D never
// rises with N. The iteration is followed to its end at the N found. With N = 1 the site is the body's
// centroid by volume: E_D(1) < γ means that the hit is too weak to break it.
#pragma once

#include <memory>

#include "base/exec.h"
#include "base/result.h"
#include "types/degree_model.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

/// What finds the degree where there is a model.
enum class DegreeBy { Model, Search };
/// What to do with a hit that lies far outside of what a model was made of.
enum class OutsideModel { Search, Predict };
/// What to do with a body that a model was not made for: a fragment, or another tetrahedral mesh.
enum class OtherBody { Search, Refuse };

struct PredictDegreeParams {
  double gamma = 1e-4;  ///< J·m², ≥ 0: halved, more pieces
  int degree = 0;       ///< ≥ 0; 0: from the energy, otherwise that many sites, whatever γ
  std::int64_t seed = 1;
  int maxDegree = 1000;  ///< ≥ 1, of the search by γ, and of what a model foretells
  DegreeBy by = DegreeBy::Model;
  OutsideModel outside = OutsideModel::Search;
  OtherBody otherBody = OtherBody::Search;
};

/// `pinned`: sites of the same embedding that are pinned by hand, or null. They count among the N, are the
/// first of the result, and stay where they are; the search goes on from them. A hit that leaves the whole
/// body below γ breaks nothing all the same: then there is one site, and it isn't pinned.
///
/// Sites p̄_j (m, in the embedding), E_D and γ, which decided nothing where `degreeGiven`. γ = 0 itself asks
/// for every site there can be. Says the outcome; warns where `maxDegree`, or the number of distinct nodes
/// (that weigh), ends the search before γ is reached. Errors: those of cvd (sizes, finiteness), parameters
/// out of range; `pinned` without pins, or with more than `degree` or `maxDegree`. Cost: about five runs of
/// Lloyd's iteration at N.
Result<Sites> predictDegree(const WeightField& weights, const Embedding& embedding, const Sites* pinned,
                            const PredictDegreeParams& params, const Exec& exec);

inline Result<Sites> predictDegree(const WeightField& weights, const Embedding& embedding,
                                   const PredictDegreeParams& params, const Exec& exec) {
  return predictDegree(weights, embedding, nullptr, params, exec);
}

/// The same with what was learned of the body in place of the search: as many sites as the model foretells,
/// grown as with `degree` (from those pinned), with γ handed on: E_D of them may be somewhat above it. A
/// degree that is given goes before. Says what it foretells; warns where the hit lies outside of what the
/// model was made of, and then does as `outside` says. A body with other tetrahedra than the model's is
/// searched, which is said, or refused, as `otherBody` says. Errors: also a model that was made for the same
/// body and something else that differs (embedding, material, γ, α, β), by all that does. Cost beyond
/// growing: that of estimateDegree (learn_degree/learn_degree.h).
Result<Sites> predictByModel(const DegreeModel& model, const WeightField& weights,
                             const std::shared_ptr<const Embedding>& embedding,
                             const PredictDegreeParams& params, const Exec& exec,
                             const Sites* pinned = nullptr);

}  // namespace sherd
