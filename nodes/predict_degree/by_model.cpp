// The degree from what was learned of the body (predict_degree.h).
#include <fmt/format.h>

#include <algorithm>

#include "cvd/cvd.h"
#include "learn_degree/learn_degree.h"
#include "predict_degree/predict_degree.h"

namespace sherd {
namespace {

/// The number of sites to grow; 0 where the search is to find it.
int foretold(const DegreeEstimate& estimate, const PredictDegreeParams& params, const Exec& exec) {
  if (estimate.isOutside) {
    const bool searches = params.outside == OutsideModel::Search;
    exec.warn(fmt::format(
        "this hit lies far outside of what the model was made of: {}",
        searches ? "its degree is searched for; train with more hits of its kind"
                 : fmt::format("that it gives {} pieces is a guess; train with more hits of its kind",
                               estimate.degree)));
    if (searches) return 0;
  }
  if (estimate.degree > params.maxDegree)
    exec.warn(fmt::format("the model foretells {} pieces, more than max_degree = {}", estimate.degree,
                          params.maxDegree));
  else if (estimate.degree == 1)
    exec.info("the model foretells that it does not break");
  else if (estimate.deviation > 0)
    exec.info(fmt::format("the model foretells {} ± {:.2g} pieces", estimate.degree, estimate.deviation));
  else
    exec.info(fmt::format("the model foretells {} pieces", estimate.degree));
  return std::min(estimate.degree, params.maxDegree);
}

}  // namespace

Result<Sites> predictByModel(const DegreeModel& model, const WeightField& weights,
                             const std::shared_ptr<const Embedding>& embedding,
                             const PredictDegreeParams& params, const Exec& exec, const Sites* pinned) {
  if (params.by == DegreeBy::Search) return predictDegree(weights, *embedding, pinned, params, exec);
  PredictDegreeParams grown = params;
  if (params.degree == 0) {
    SHERD_CHECK(checkLloydInput(*embedding, weights));
    const DegreeValidity wanted = validityOf(weights, embedding, params.gamma);
    if (model.validFor.tets != wanted.tets && params.otherBody == OtherBody::Search) {
      exec.info("the model was made for another body: the degree of this one is searched for");
      return predictDegree(weights, *embedding, pinned, params, exec);
    }
    SHERD_CHECK(checkValidity(model, wanted));
    grown.degree = foretold(estimateDegree(model, weights, *embedding, Deviation::Known), params, exec);
  }
  // Pins count among the pieces of a body that breaks, and play no part in one that doesn't.
  if (params.degree == 0 && grown.degree == 1) pinned = nullptr;
  if (params.degree == 0 && grown.degree > 1 && pinned != nullptr)
    grown.degree = std::max(grown.degree, static_cast<int>(pinned->pinned));
  SHERD_ASSIGN(Sites sites, predictDegree(weights, *embedding, pinned, grown, exec));
  if (params.degree > 0) return sites;
  sites.gamma = params.gamma;
  sites.degreeGiven = false;
  return sites;
}

}  // namespace sherd
