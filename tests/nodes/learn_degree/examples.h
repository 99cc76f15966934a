// Made-up examples of fracture whose degree is known.
#pragma once

#include <cmath>
#include <vector>

#include "cvd/cvd.h"
#include "learn_degree/learn_degree.h"
#include "support/lloyd_reference.h"

namespace sherd::examples {

inline double wholeEnergy(const reference::Cloud& c, const std::vector<double>& weight) {
  const Eigen::Map<const Eigen::VectorXd> v(c.weights.volume.data(), c.embedding->coordinates.cols());
  const Eigen::VectorXd centre = c.embedding->coordinates * v / v.sum();
  double sum = 0;
  for (std::size_t n = 0; n < weight.size(); ++n)
    sum += weight[n] * (c.embedding->coordinates.col(static_cast<Eigen::Index>(n)) - centre).squaredNorm();
  return sum;
}

/// Weights that fall off from node `hit`, `strength` J in all.
inline std::vector<double> hitAt(const reference::Cloud& c, int hit, double strength) {
  std::vector<double> weight;
  double sum = 0;
  for (std::size_t n = 0; n < c.weights.volume.size(); ++n) {
    const double r =
        (c.embedding->coordinates.col(static_cast<Eigen::Index>(n)) - c.embedding->coordinates.col(hit))
            .norm() /
        c.embedding->diameter;
    weight.push_back(c.weights.volume[n] / std::pow(0.05 + r, 3));
    sum += weight.back();
  }
  for (double& w : weight) w *= strength / sum;
  return weight;
}

/// N = ⌈ν⌉ with ν = (E_1/γ)^1.5, at least 1: a power law.
inline DegreeExample powerLaw(const reference::Cloud& c, std::vector<double> weight, double gamma,
                              int group) {
  const double crossing = std::pow(wholeEnergy(c, weight) / gamma, 1.5);
  DegreeExample e;
  e.weight = std::move(weight);
  e.degree = {std::max(1, static_cast<int>(std::ceil(crossing)))};
  e.crossing = {crossing <= 1 ? 0.5 : crossing};
  e.group = group;
  return e;
}

/// What a search finds: sites grown one at a time until E_D is below γ.
inline DegreeExample searched(const reference::Cloud& c, std::vector<double> weight, double gamma,
                              int group) {
  const WeightField field{nullptr, {}, weight, c.weights.volume};
  Lloyd lloyd = firstSites(*c.embedding, field, nullptr, Exec{});
  double before = lloyd.energy(), energy = before;
  while (!(energy < gamma) && growSite(lloyd, *c.embedding, field, Growth::ByEnergy, 1, Exec{}).ok())
    before = energy, energy = lloyd.energy();
  const auto n = static_cast<double>(lloyd.siteCount());
  const double share = std::log(before / gamma) / std::log(before / energy);
  DegreeExample e;
  e.weight = std::move(weight);
  e.degree = {static_cast<int>(n)};
  e.crossing = {n < 2 ? 0.5 : (n - 1) * std::pow(n / (n - 1), share)};
  e.group = group;
  return e;
}

/// Hits at `groups` nodes with `strengths` each.
inline std::vector<DegreeExample> powerLaws(const reference::Cloud& c, int groups, int strengths,
                                            double gamma) {
  std::vector<DegreeExample> out;
  for (int g = 0; g < groups; ++g)
    for (int s = 0; s < strengths; ++s) out.push_back(powerLaw(c, hitAt(c, 7 * g, 1.0 + s), gamma, g));
  return out;
}

}  // namespace sherd::examples
