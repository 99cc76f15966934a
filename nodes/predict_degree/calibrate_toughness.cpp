#include "predict_degree/calibrate_toughness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cvd/cvd.h"

namespace sherd {
namespace {

/// The ends of the thresholds that stop at N: E_D(N) < γ ≤ the least E_D before it.
struct Step {
  double below = 0, before = 0;  ///< J·m²

  double geometricMean() const {
    if (below == 0) return before / 2;
    const double mean = std::sqrt(below) * std::sqrt(before);
    return mean > below && mean <= before ? mean : before;  // ends that are neighbours, to the last bit
  }
};

std::string sitesText(std::size_t sites) { return fmt::format("{} piece{}", sites, sites == 1 ? "" : "s"); }

/// The step from N − 1 to N sites on the path that PredictDegree grows.
Result<Step> stepTo(std::size_t wanted, const WeightField& weights, const Embedding& embedding,
                    std::int64_t seed, const Exec& exec) {
  Lloyd lloyd(embedding, weights);
  lloyd.addSite(bodyCentroid(embedding, weights), exec);
  if (exec.cancelled()) return cancelledError();
  Step step{lloyd.energy(), lloyd.energy()};
  std::size_t reachable = 1;  // the largest number so far that some γ stops at
  if (!(step.below > 0))
    return failure("the example has no energy that could break it: E_D is 0",
                   "let it fall from higher, or throw faster, so that it is hit", "weights");
  while (lloyd.siteCount() < wanted) {
    SHERD_ASSIGN(const bool grown, growSite(lloyd, embedding, weights, Growth::ByEnergy, seed, exec));
    if (!grown)
      return failure(fmt::format("it can't break into {}: only {} nodes of the tetrahedral mesh hold energy",
                                 sitesText(wanted), lloyd.siteCount()),
                     fmt::format("refine it (Tetrahedralize.tets), or ask for {} or fewer", reachable),
                     "pieces");
    step.before = std::min(step.before, step.below);
    step.below = lloyd.energy();
    if (step.below < step.before) reachable = lloyd.siteCount();
    exec.progress(static_cast<double>(lloyd.siteCount()) / static_cast<double>(wanted));
  }
  if (wanted > 1 && reachable < wanted)
    return failure(fmt::format("no γ breaks it into exactly {}: E_D stays at {:.6g} J·m² from {} to {}",
                               sitesText(wanted), step.below, reachable, wanted),
                   fmt::format("ask for {}, or try another seed", reachable), "pieces");
  return step;
}

}  // namespace

Result<double> calibrateToughness(const WeightField& weights, const Embedding& embedding,
                                  const CalibrateToughnessParams& params, const Exec& exec) {
  SHERD_CHECK(checkLloydInput(embedding, weights));
  if (params.pieces < 1)
    return failure(fmt::format("it can't break into {} pieces", params.pieces), "ask for at least one",
                   "pieces");
  const auto wanted = static_cast<std::size_t>(params.pieces);
  SHERD_ASSIGN(const Step step, stepTo(wanted, weights, embedding, params.seed, exec));
  const double gamma = wanted == 1 ? 2 * step.below : step.geometricMean();
  if (!std::isfinite(gamma))
    return failure("the energy of the example is beyond all measure", "is the model in metres?", "weights");
  if (wanted == 1)
    exec.info(fmt::format("a hit like this one doesn't break it with γ = {:.6g} J·m²", gamma));
  else
    exec.info(fmt::format("a hit like this one breaks it into {} with γ = {:.6g} J·m²; {:.6g} to {:.6g} do",
                          sitesText(wanted), gamma, step.below, step.before));
  return gamma;
}

}  // namespace sherd
