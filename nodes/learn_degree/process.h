// A Gaussian process with an unknown mean (learn_degree.h).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/exec.h"
#include "base/result.h"
#include "learn_degree/network.h"

namespace sherd {

/// Matérn's correlation with ν = 5/2 at distance r, in lengths.
Eigen::ArrayXd maternOf(const Eigen::ArrayXd& r);

/// Variance of a process' mean beside that of what is on top of it: next to nothing is known of it before.
inline constexpr double kMeanVariance = 1e4;

/// 1 / length of features and of components (0: these play no part), and the noise of one search in
/// variances.
struct ProcessScales {
  double feature = 0.25, component = 0, noise = 0.1;
};

struct ProcessFit {
  Fit fit;  ///< distances are of features and components times these
  ProcessScales scales;
};

/// The first `features` coordinates of the points have one length, the others, components, another. At most
/// 512 samples, evenly chosen, are used. `scales`: not given, those of the largest marginal likelihood on a
/// grid, one after the other until none changes. Errors: cancelled. Cost: some 40 Cholesky factorizations, or
/// one.
Result<ProcessFit> fitProcess(const Samples& samples, Eigen::Index features,
                              const std::optional<ProcessScales>& scales, const Exec& exec);

}  // namespace sherd
