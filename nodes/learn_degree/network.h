// Networks of radial basis functions φ(r) = r with a bias (learn_degree.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/tri_mesh.h"

namespace sherd {

/// Distinct points and what to find at them.
struct Samples {
  Eigen::MatrixXd points;  ///< dimensions × n
  Eigen::VectorXd target;  ///< mean over the searches at a point
  Eigen::VectorXd count;   ///< of these, > 0
  std::vector<int> group;
};

/// y = bias + Σ_i coefficient_i φ(‖z − z_centre(i)‖).
struct Fit {
  std::vector<Index> centres;
  Eigen::VectorXd coefficient;
  double bias = 0;
  Eigen::MatrixXd whitening;  ///< of a process
  double variance = 0;
};

/// Centres by orthogonal least squares until the rms error is at most `tolerance` · the mean target, or there
/// are `most`; not given, as many as give the least error on groups left out, a fifth at a time, and at most
/// 100. Coefficients by least squares over all samples, weighted by their counts. Errors: cancelled. Cost O(n
/// · 512) per centre, six times where `most` isn't given.
Result<Fit> fitNetwork(const Samples& samples, double tolerance, std::optional<Eigen::Index> most,
                       const Exec& exec);

/// Through the target of every sample (at most 512, evenly chosen): the solution of
///   [Φ 1; 1ᵀ 0] [coefficient; bias] = [target; 0],
/// which is unique for distinct points; of the least norm where they are too close to be told apart. O(n³).
Result<Fit> fitExactly(const Samples& samples, const Exec& exec);

/// Which fifth of the groups each sample belongs to, in [0, folds); folds is 1 where there is one group.
struct Folds {
  std::vector<int> of;
  int count = 1;
};
Folds foldsOf(const std::vector<int>& group);

}  // namespace sherd
