#include "train_degree/growth_path.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cvd/cvd.h"

namespace sherd {
namespace {

/// What rounding leaves between the deformations by two hits that differ in strength alone.
constexpr double kProportional = 1e-9;

}  // namespace

Result<std::vector<double>> growthPath(const Embedding& embedding, const WeightField& weights, double gamma,
                                       std::int64_t seed, int most, const Exec& exec) {
  SHERD_CHECK(checkLloydInput(embedding, weights));
  Lloyd lloyd(embedding, weights);
  lloyd.addSite(bodyCentroid(embedding, weights), exec);
  if (exec.cancelled()) return cancelledError();
  std::vector<double> energy{lloyd.energy()};
  while (static_cast<int>(energy.size()) < most && !(energy.back() < gamma)) {
    SHERD_ASSIGN(const bool grown, growSite(lloyd, embedding, weights, Growth::ByEnergy, seed, exec));
    if (!grown) break;
    energy.push_back(lloyd.energy());
  }
  return energy;
}

std::optional<PathEnd> endOf(const std::vector<double>& path, double factor, double gamma) {
  const auto first =
      std::find_if(path.begin(), path.end(), [&](double energy) { return factor * energy < gamma; });
  if (first == path.end()) return std::nullopt;
  PathEnd end;
  end.degree = static_cast<int>(first - path.begin()) + 1;
  if (end.degree == 1) return end;
  const double before = std::log(factor * *(first - 1)), after = std::log(factor * *first);
  const double share = (before - std::log(gamma)) / (before - after);  // 0 where `after` is −∞
  const double n = end.degree;
  end.crossing = std::clamp((n - 1) * std::pow(n / (n - 1), share), n - 1, n);
  return end;
}

std::optional<double> factorBetween(const std::vector<double>& weight, const std::vector<double>& reference) {
  const double sum = std::accumulate(reference.begin(), reference.end(), 0.0);
  if (!(sum > 0) || weight.size() != reference.size()) return std::nullopt;
  const double factor = std::accumulate(weight.begin(), weight.end(), 0.0) / sum;
  const double slack = kProportional * factor * *std::max_element(reference.begin(), reference.end());
  for (std::size_t n = 0; n < weight.size(); ++n)
    if (!(std::abs(weight[n] - factor * reference[n]) <= slack)) return std::nullopt;
  return factor;
}

}  // namespace sherd
