#include "train_degree/growth_path.h"

#include <algorithm>
#include <cmath>

#include "cvd/cvd.h"
#include "types/value_bytes.h"

namespace sherd {
namespace {

std::span<const double> within(std::span<const double> energy, int most) {
  return energy.first(std::min(energy.size(), static_cast<std::size_t>(std::max(most, 0))));
}

/// The search as it was at the path's end. Labels are exact before and after, so they follow from the sites.
Lloyd stateOf(const GrowthPath& path, const Embedding& embedding, const WeightField& weights,
              const Exec& exec) {
  if (path.energy.empty()) return firstSites(embedding, weights, nullptr, exec);
  Lloyd lloyd(embedding, weights);
  for (Eigen::Index j = 0; j < path.sites.cols() && !exec.cancelled(); ++j)
    lloyd.addSite(path.sites.col(j), exec);
  return lloyd;
}

}  // namespace

void saveValue(ArchiveWriter& to, const GrowthPath& path) {
  to.array(path.energy);
  putBits(to, path.sites);
  to.put(path.isExhausted);
}

std::optional<GrowthPath> loadValue(ArchiveReader& from, std::type_identity<GrowthPath>) {
  GrowthPath path;
  from.array(path.energy);
  getBits(from, path.sites);
  path.isExhausted = from.get<bool>();
  const bool isSound = static_cast<Eigen::Index>(path.energy.size()) == path.sites.cols();
  if (!from.ok() || !isSound) return std::nullopt;
  return path;
}

bool isComplete(const GrowthPath& path, const PathGoal& goal) {
  if (path.energy.empty()) return false;
  return path.isExhausted || static_cast<int>(path.energy.size()) >= goal.most ||
         goal.factor * path.energy.back() < goal.gamma;
}

Result<void> follow(GrowthPath& path, const PathGoal& goal, const Embedding& embedding,
                    const WeightField& weights, std::int64_t seed, const Exec& exec) {
  if (isComplete(path, goal)) return {};
  SHERD_CHECK(checkLloydInput(embedding, weights));
  GrowthPath longer = path;
  Lloyd lloyd = stateOf(path, embedding, weights, exec);
  if (exec.cancelled()) return cancelledError();
  if (longer.energy.empty()) longer.energy.push_back(lloyd.energy());
  while (!isComplete(longer, goal)) {
    SHERD_ASSIGN(const bool grown, growSite(lloyd, embedding, weights, Growth::ByEnergy, seed, exec));
    longer.isExhausted = !grown;
    if (grown) longer.energy.push_back(lloyd.energy());
  }
  longer.sites = lloyd.sites();
  path = std::move(longer);
  return {};
}

std::optional<PathEnd> endOf(std::span<const double> all, const PathGoal& goal) {
  const auto energy = within(all, goal.most);
  const auto first =
      std::find_if(energy.begin(), energy.end(), [&](double e) { return goal.factor * e < goal.gamma; });
  if (first == energy.end()) return std::nullopt;
  PathEnd end;
  end.degree = static_cast<int>(first - energy.begin()) + 1;
  if (end.degree == 1) return end;
  const double before = std::log(goal.factor * *(first - 1)), after = std::log(goal.factor * *first);
  const double share = (before - std::log(goal.gamma)) / (before - after);  // 0 where `after` is −∞
  const double n = end.degree;
  end.crossing = std::clamp((n - 1) * std::pow(n / (n - 1), share), n - 1, n);
  return end;
}

}  // namespace sherd
