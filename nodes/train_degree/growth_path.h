// The search for the degree, done once for all weights that are proportional.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

/// E_D of the sites that PredictDegree's search grows, and where it stands.
///
/// Weights times a number give the same path with energies times that number: labels are by distances alone,
/// centroids and the draw of the next site by ratios of weights. So one path serves all heights that a body
/// is dropped from with the same orientation, which differ in the strength of the hit alone; and all γ: one
/// that was followed to a smaller γ holds what a larger one asks for, one to a larger γ goes on from its end.
struct GrowthPath {
  static constexpr const char* typeName = "GrowthPath";
  static constexpr int archiveVersion = 1;
  std::vector<double> energy;  ///< [N − 1] for N = 1, 2, … sites, J·m²
  Eigen::MatrixXd sites;       ///< m, dimensions × N: of the last
  bool isExhausted = false;    ///< no more can be grown
};
void saveValue(ArchiveWriter& to, const GrowthPath& path);
std::optional<GrowthPath> loadValue(ArchiveReader& from, std::type_identity<GrowthPath>);

/// What to follow a path to: the first N with factor · energy[N − 1] < γ, or `most` sites.
struct PathGoal {
  double factor = 1;
  double gamma = 0;  ///< J·m²
  int most = 1000;
};

/// Whether following it further would change endOf() for this goal, or for a smaller factor.
bool isComplete(const GrowthPath& path, const PathGoal& goal);

/// Follows a path, which may be empty, to the goal. The same path to the bit however often it ends and goes
/// on. Errors: those of checkLloydInput; cancelled, and then the path is as it was. Cost: about five runs of
/// Lloyd's iteration at N; taking up an old path a quarter of what it took.
Result<void> follow(GrowthPath& path, const PathGoal& goal, const Embedding& embedding,
                    const WeightField& weights, std::int64_t seed, const Exec& exec);

struct PathEnd {
  int degree = 1;         ///< N: the first with factor · energy[N − 1] < γ
  double crossing = 0.5;  ///< ν of learn_degree.h; ½ where N is 1
};
/// None where the path does not fall below γ within `most` sites.
std::optional<PathEnd> endOf(std::span<const double> energy, const PathGoal& goal);

}  // namespace sherd
