#include "predict_degree/predict_degree.h"

#include <fmt/format.h>

#include <cmath>

#include "cvd/cvd.h"

namespace sherd {
namespace {

Result<void> checkParams(const PredictDegreeParams& params) {
  if (!(params.gamma >= 0) || !std::isfinite(params.gamma))
    return failure(fmt::format("γ is {}", params.gamma), "it has to be a finite number that is not negative",
                   "gamma");
  if (params.degree < 0) return failure("the degree is negative", "it is 0 or the number of sites", "degree");
  if (params.maxDegree < 1) return failure("no site is allowed", "allow at least one", "max_degree");
  return {};
}

/// The search's end, told as the user has to know it.
void report(const PredictDegreeParams& params, std::size_t sites, double energy, bool exhausted,
            const Exec& exec) {
  if (params.degree > 0) {
    if (exhausted)
      exec.warn(
          fmt::format("{} sites were asked for, but the tetrahedral mesh has only nodes for {}; refine it "
                      "(Tetrahedralize.tets), or ask for fewer",
                      params.degree, sites));
    exec.info(fmt::format("{} sites as asked for, E_D = {:.6g} J·m²", sites, energy));
  } else if (energy < params.gamma) {
    if (sites == 1)
      exec.info(fmt::format("does not break: E_D = {:.6g} J·m² of the whole body is below γ = {:.6g} J·m²",
                            energy, params.gamma));
    else
      exec.info(fmt::format("{} sites, E_D = {:.6g} J·m² < γ = {:.6g} J·m²", sites, energy, params.gamma));
  } else if (exhausted) {
    exec.warn(fmt::format(
        "γ = {:.6g} J·m² is not reached: every node that weighs has one of the {} sites, and E_D is "
        "still {:.6g} J·m²; raise γ, or refine the tetrahedral mesh (Tetrahedralize.tets)",
        params.gamma, sites, energy));
  } else {
    exec.warn(
        fmt::format("γ = {:.6g} J·m² is not reached with max_degree = {} sites: E_D is still {:.6g} J·m²; "
                    "raise γ or max_degree",
                    params.gamma, sites, energy));
  }
}

}  // namespace

Result<Sites> predictDegree(const WeightField& weights, const Embedding& embedding,
                            const PredictDegreeParams& params, const Exec& exec) {
  SHERD_CHECK(checkLloydInput(embedding, weights));
  SHERD_CHECK(checkParams(params));

  const bool given = params.degree > 0;
  const auto most = static_cast<std::size_t>(given ? params.degree : params.maxDegree);
  Lloyd lloyd(embedding, weights);
  lloyd.addSite(bodyCentroid(embedding, weights), exec);
  if (exec.cancelled()) return cancelledError();

  double energy = lloyd.energy();
  bool exhausted = false;
  while (lloyd.siteCount() < most && (given || !(energy < params.gamma))) {
    SHERD_ASSIGN(const bool grown, growSite(lloyd, embedding, weights,
                                            given ? Growth::ByVolume : Growth::ByEnergy, params.seed, exec));
    exhausted = !grown;
    if (exhausted) break;
    energy = lloyd.energy();
    exec.progress(static_cast<double>(lloyd.siteCount()) / static_cast<double>(most));
  }
  if (lloyd.siteCount() > 1) {
    SHERD_CHECK(lloyd.run(LloydLimits{}, exec));
    energy = lloyd.energy();
  }
  report(params, lloyd.siteCount(), energy, exhausted, exec);
  return Sites{lloyd.sites(), energy, given ? 0.0 : params.gamma, given};
}

}  // namespace sherd
