// The search for the degree, done once for all weights that are proportional.
#pragma once

#include <optional>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

/// E_D of the sites that PredictDegree's search grows: energy[N − 1] for N = 1, 2, … J·m². Ends below γ, at
/// `most` sites, or where no more can be grown.
///
/// Weights times a number give the same path with energies times that number: labels are by distances alone,
/// centroids and the draw of the next site by ratios of weights. So one path serves all heights that a body
/// is dropped from with the same orientation, which differ in the strength of the hit alone.
Result<std::vector<double>> growthPath(const Embedding& embedding, const WeightField& weights, double gamma,
                                       std::int64_t seed, int most, const Exec& exec);

struct PathEnd {
  int degree = 1;         ///< N: the first with factor · energy[N − 1] < γ
  double crossing = 0.5;  ///< ν of learn_degree.h; ½ where N is 1
};
/// None where the path does not fall below γ.
std::optional<PathEnd> endOf(const std::vector<double>& path, double factor, double gamma);

/// The number that makes `weight` of `reference`, to 1e-9 of the largest weight; none where there is no such
/// number.
std::optional<double> factorBetween(const std::vector<double>& weight, const std::vector<double>& reference);

}  // namespace sherd
