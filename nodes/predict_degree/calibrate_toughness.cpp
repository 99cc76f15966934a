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

/// E_D of the body with one site.
Result<double> wholeEnergy(const WeightField& weights, const Embedding& embedding, const Exec& exec) {
  const double energy = firstSites(embedding, weights, nullptr, exec).energy();
  if (exec.cancelled()) return cancelledError();
  if (energy > 0) return energy;
  return failure("the example has no energy that could break it: E_D is 0",
                 "let it fall from higher, or throw faster, so that it is hit", "weights");
}

/// The step from N − 1 to N sites on the path that PredictDegree grows; N above 1.
Result<Step> stepTo(std::size_t wanted, double whole, const WeightField& weights, const Embedding& embedding,
                    const Sites* pinned, std::int64_t seed, const Exec& exec) {
  Lloyd lloyd = firstSites(embedding, weights, pinned, exec);
  if (exec.cancelled()) return cancelledError();
  if (lloyd.siteCount() > wanted)
    return failure(fmt::format("{} sites are pinned: it can't break into {}", lloyd.siteCount(), wanted),
                   "ask for at least as many as are pinned, or pin fewer", "pieces");
  Step step{lloyd.energy(), whole};
  std::size_t reachable = step.below < step.before ? lloyd.siteCount() : 1;  // the last that some γ stops at
  while (lloyd.siteCount() < wanted) {
    SHERD_ASSIGN(const bool grown, growSite(lloyd, embedding, weights, Growth::ByEnergy, seed, exec));
    if (!grown)
      return failure(
          fmt::format("it can't break into {} pieces: only {} nodes of the tetrahedral mesh hold energy",
                      wanted, lloyd.siteCount()),
          fmt::format("refine it (Tetrahedralize.tets), or ask for {} or fewer", reachable), "pieces");
    step.before = std::min(step.before, step.below);
    step.below = lloyd.energy();
    if (step.below < step.before) reachable = lloyd.siteCount();
    exec.progress(static_cast<double>(lloyd.siteCount()) / static_cast<double>(wanted));
  }
  if (reachable < wanted)
    return failure(fmt::format("no γ breaks it into exactly {} pieces: E_D is {:.6g} J·m² with {} already",
                               wanted, step.before, reachable),
                   fmt::format("ask for {}, or try another seed", reachable), "pieces");
  return step;
}

}  // namespace

Result<double> calibrateToughness(const WeightField& weights, const Embedding& embedding, const Sites* pinned,
                                  const CalibrateToughnessParams& params, const Exec& exec) {
  SHERD_CHECK(checkLloydInput(embedding, weights));
  if (pinned != nullptr) SHERD_CHECK(checkSites(embedding, *pinned, "pinned"));
  if (pinned != nullptr && pinned->pinned == 0)
    return failure("none of these sites is pinned", "wire PinSites", "pinned");
  if (params.pieces < 1)
    return failure(fmt::format("it can't break into {} pieces", params.pieces), "ask for at least one",
                   "pieces");
  const auto wanted = static_cast<std::size_t>(params.pieces);
  SHERD_ASSIGN(const double whole, wholeEnergy(weights, embedding, exec));
  if (!std::isfinite(2 * whole))
    return failure("the energy of the example is beyond all measure", "is the model in metres?", "weights");
  if (wanted == 1) {
    exec.info(fmt::format("a hit like this one doesn't break it with γ = {:.6g} J·m²", 2 * whole));
    return 2 * whole;
  }
  SHERD_ASSIGN(const Step step, stepTo(wanted, whole, weights, embedding, pinned, params.seed, exec));
  const double gamma = step.geometricMean();
  exec.info(
      fmt::format("a hit like this one breaks it into {} pieces with γ = {:.6g} J·m²; {:.6g} to {:.6g} do",
                  wanted, gamma, step.below, step.before));
  return gamma;
}

}  // namespace sherd
