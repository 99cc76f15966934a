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

Result<void> checkPinned(const Embedding& embedding, const Sites& pinned, const PredictDegreeParams& params) {
  SHERD_CHECK(checkSites(embedding, pinned, "pinned"));
  if (pinned.pinned == 0) return failure("none of these sites is pinned", "wire PinSites", "pinned");
  const bool given = params.degree > 0;
  const int most = given ? params.degree : params.maxDegree;
  if (pinned.pinned > most)
    return failure(fmt::format("{} sites are pinned, but only {} are {}", pinned.pinned, most,
                               given ? "wanted" : "allowed"),
                   "ask for at least as many as are pinned, or pin fewer", given ? "degree" : "max_degree");
  return {};
}

/// What the search begins with: the pinned sites, unless the whole body is below γ.
Lloyd startOf(const WeightField& weights, const Embedding& embedding, const Sites* pinned,
              const PredictDegreeParams& params, const Exec& exec) {
  Lloyd whole = firstSites(embedding, weights, nullptr, exec);
  if (pinned == nullptr || (params.degree == 0 && whole.energy() < params.gamma)) return whole;
  return firstSites(embedding, weights, pinned, exec);
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
    exec.info(fmt::format("{} {}, E_D = {:.6g} J·m²", sites, sites == 1 ? "site" : "sites", energy));
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

Result<Sites> predictDegree(const WeightField& weights, const Embedding& embedding, const Sites* pinned,
                            const PredictDegreeParams& params, const Exec& exec) {
  SHERD_CHECK(checkLloydInput(embedding, weights));
  SHERD_CHECK(checkParams(params));
  if (pinned != nullptr) SHERD_CHECK(checkPinned(embedding, *pinned, params));

  const bool given = params.degree > 0;
  const auto most = static_cast<std::size_t>(given ? params.degree : params.maxDegree);
  Lloyd lloyd = startOf(weights, embedding, pinned, params, exec);
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
  return Sites{lloyd.sites(), energy, params.gamma, given, static_cast<std::int64_t>(lloyd.pinnedCount())};
}

}  // namespace sherd
