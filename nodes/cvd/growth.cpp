// Drawing and adding sites, and the checks before (cvd.h).
#include <fmt/format.h>

#include <cmath>

#include "base/rng.h"
#include "cvd/cvd.h"

namespace sherd {
namespace {

constexpr std::uint64_t kSiteStream = 0x73697465;            // "site"
constexpr double kLeastSize = 1e-150, kLargestSize = 1e150;  // m: squares are numbers, with room to add
constexpr double kSamePlace = 1e-12;                         // of the embedding's diameter

/// The node that `uniform` in [0, 1) falls on when each is as wide as its share; none where all are 0.
std::optional<Index> drawFrom(const std::vector<double>& share, double uniform) {
  double total = 0;
  for (const double s : share) total += s;
  if (!(total > 0)) return std::nullopt;
  const double target = uniform * total;
  double sum = 0;
  std::size_t last = 0;  // where rounding leaves the sum just short of the target
  for (std::size_t n = 0; n < share.size(); ++n) {
    if (!(share[n] > 0)) continue;
    sum += share[n];
    last = n;
    if (sum > target) break;
  }
  return static_cast<Index>(last);
}

Result<void> checkAmounts(const std::vector<double>& values, std::size_t nodes, const char* what) {
  if (values.size() != nodes)
    return failure(fmt::format("{} {} for {} nodes of the embedding", values.size(), what, nodes),
                   "weights and embedding have to be of one tetrahedral mesh", "weights");
  for (std::size_t n = 0; n < nodes; ++n)
    if (!std::isfinite(values[n]) || values[n] < 0)
      return failure(fmt::format("{} of node {} are {}", what, n, values[n]),
                     "they are finite and not negative", "weights");
  return {};
}

}  // namespace

Result<void> checkLloydInput(const Embedding& embedding, const WeightField& weights) {
  const auto nodes = static_cast<std::size_t>(embedding.coordinates.cols());
  if (nodes == 0 || embedding.coordinates.rows() == 0)
    return failure("the embedding is empty", {}, "embedding");
  if (!embedding.coordinates.allFinite() || !std::isfinite(embedding.diameter))
    return failure("the embedding holds a coordinate that is not a finite number", {}, "embedding");
  if (embedding.diameter != 0 && !(embedding.diameter > kLeastSize && embedding.diameter < kLargestSize))
    return failure(fmt::format("the body is {:g} m wide", embedding.diameter),
                   "squares of distances have to be numbers: between 1e-150 and 1e150 m", "embedding");
  SHERD_CHECK(checkAmounts(weights.weight, nodes, "weights"));
  return checkAmounts(weights.volume, nodes, "volumes");
}

Result<void> checkSites(const Embedding& embedding, const Sites& sites, const char* port) {
  if (sites.positions.cols() == 0) return failure("there are no sites", {}, port);
  if (sites.positions.rows() != embedding.coordinates.rows())
    return failure(fmt::format("the sites have {} dimensions, the embedding {}", sites.positions.rows(),
                               embedding.coordinates.rows()),
                   "sites have to come from a search, or be pinned, in this embedding", port);
  if (!sites.positions.allFinite()) return failure("a site is not at a finite place", {}, port);
  if (sites.pinned < 0 || sites.pinned > sites.positions.cols())
    return failure(fmt::format("{} of {} sites are pinned", sites.pinned, sites.positions.cols()), {}, port);
  return {};
}

Eigen::VectorXd bodyCentroid(const Embedding& embedding, const WeightField& weights) {
  const Eigen::Index nodes = embedding.coordinates.cols();
  double total = 0;
  for (const double v : weights.volume) total += v;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(embedding.coordinates.rows());
  for (Eigen::Index n = 0; n < nodes; ++n) {
    const double share =
        total > 0 ? weights.volume[static_cast<std::size_t>(n)] / total : 1.0 / static_cast<double>(nodes);
    sum += share * embedding.coordinates.col(n);
  }
  return sum;
}

Lloyd firstSites(const Embedding& embedding, const WeightField& weights, const Sites* pinned,
                 const Exec& exec) {
  Lloyd lloyd(embedding, weights, exec);
  if (pinned == nullptr || pinned->pinned == 0) {
    lloyd.addSite(bodyCentroid(embedding, weights), exec);
    return lloyd;
  }
  for (Eigen::Index j = 0; j < pinned->pinned && (j == 0 || !exec.cancelled()); ++j)
    lloyd.addSite(pinned->positions.col(j), exec);
  lloyd.pin(static_cast<std::size_t>(pinned->pinned));
  return lloyd;
}

std::optional<Index> drawSite(const Lloyd& lloyd, const Embedding& embedding, const WeightField& weights,
                              Growth growth, std::int64_t seed) {
  if (lloyd.siteCount() >= lloyd.nodeCount()) return std::nullopt;
  const double uniform = Rng(static_cast<std::uint64_t>(seed), kSiteStream).uniformAt(lloyd.siteCount());
  // A centroid of nodes in one place may miss it by rounding: that is no distance.
  const double nothing = kSamePlace * embedding.diameter;
  std::vector<double> d2 = lloyd.squaredDistances();
  for (double& d : d2)
    if (d <= nothing * nothing) d = 0;
  std::vector<double> share(d2.size());
  auto drawBy = [&](const std::vector<double>& amount) {
    for (std::size_t n = 0; n < share.size(); ++n) share[n] = amount[n] * d2[n];
    return drawFrom(share, uniform);
  };
  const auto byEnergy = drawBy(weights.weight);
  if (byEnergy || growth == Growth::ByEnergy) return byEnergy;
  const auto byVolume = drawBy(weights.volume);
  return byVolume ? byVolume : drawFrom(d2, uniform);
}

Result<bool> growSite(Lloyd& lloyd, const Embedding& embedding, const WeightField& weights, Growth growth,
                      std::int64_t seed, const Exec& exec) {
  const auto node = drawSite(lloyd, embedding, weights, growth, seed);
  if (!node) return false;
  lloyd.addSite(embedding.coordinates.col(*node), exec);
  SHERD_CHECK(lloyd.run({.maxIterations = kGrowthPasses}, exec));
  return true;
}

}  // namespace sherd
