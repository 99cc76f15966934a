#include "learn_degree/network.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "base/parallel.h"
#include "learn_degree/principal_components.h"

namespace sherd {
namespace {

constexpr Eigen::Index kMostCentres = 100;
/// A column with less than this left of its square after taking out the others is one of their combinations.
constexpr double kDependent = 1e-12;

std::vector<Index> asIndices(const std::vector<Eigen::Index>& list) { return {list.begin(), list.end()}; }

Eigen::MatrixXd distances(const Eigen::MatrixXd& points, const std::vector<Index>& centres) {
  Eigen::MatrixXd phi(points.cols(), static_cast<Eigen::Index>(centres.size()));
  for (Eigen::Index k = 0; k < phi.cols(); ++k)
    phi.col(k) =
        (points.colwise() - points.col(centres[static_cast<std::size_t>(k)])).colwise().norm().transpose();
  return phi;
}

/// Forward selection by orthogonal least squares. Rows of weight 0 take no part but are carried along, so
/// that the error on them is at hand after each step.
class ForwardSelection {
 public:
  ForwardSelection(const Samples& samples, Eigen::VectorXd rowWeight)
      : weight_(std::move(rowWeight)), residual_(samples.target) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < weight_.size(); ++i)
      if (weight_[i] > 0) rows.push_back(i);
    for (const Eigen::Index i : evenlyChosen(static_cast<Eigen::Index>(rows.size()), kMostExamples))
      candidates_.push_back(static_cast<Index>(rows[static_cast<std::size_t>(i)]));
    columns_ = distances(samples.points, candidates_);
    takeOut(Eigen::VectorXd::Ones(weight_.size()));  // the bias comes first
    norm2_ = columns_.cwiseAbs2().transpose() * weight_;
    firstNorm2_ = norm2_;
    product_ = columns_.transpose() * weight_.cwiseProduct(residual_);
  }

  /// Adds the centre that lowers the error most. False where none does.
  bool step() {
    Eigen::Index best = -1;
    double most = 0;
    for (Eigen::Index k = 0; k < product_.size(); ++k) {
      if (!(norm2_[k] > kDependent * firstNorm2_[k])) continue;
      const double gain = product_[k] * product_[k] / norm2_[k];
      if (gain > most) most = gain, best = k;
    }
    if (best < 0) return false;
    chosen_.push_back(candidates_[static_cast<std::size_t>(best)]);
    const double product = product_[best], norm2 = norm2_[best];
    const Eigen::VectorXd share = takeOut(Eigen::VectorXd(columns_.col(best)));
    // What is left of the columns is orthogonal to the one taken out, and so is the residual.
    product_ -= product * share;
    norm2_ -= norm2 * share.cwiseAbs2();
    norm2_[best] = 0;
    return true;
  }

  const std::vector<Index>& chosen() const { return chosen_; }
  /// Sum over the samples fitted to.
  double squaredError() const { return weight_.dot(residual_.cwiseAbs2()); }
  double squaredErrorOver(const Eigen::VectorXd& weight) const { return weight.dot(residual_.cwiseAbs2()); }

 private:
  /// Returns what share of q each column held.
  Eigen::VectorXd takeOut(const Eigen::VectorXd& q) {
    const Eigen::VectorXd scaled = weight_.cwiseProduct(q) / weight_.dot(q.cwiseAbs2());
    residual_ -= scaled.dot(residual_) * q;
    const Eigen::VectorXd share = columns_.transpose() * scaled;
    columns_.noalias() -= q * share.transpose();
    return share;
  }

  Eigen::VectorXd weight_, residual_;
  std::vector<Index> candidates_, chosen_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd norm2_, firstNorm2_, product_;
};

/// How many centres give the least error on the groups left out; the most there may be where nothing can be
/// left out.
Result<Eigen::Index> centresByValidation(const Samples& samples, const Exec& exec) {
  const Folds folds = foldsOf(samples.group);
  const Eigen::Index most = std::min(kMostCentres, samples.points.cols());
  if (folds.count < 2) return most;
  std::vector<std::vector<double>> errors(static_cast<std::size_t>(folds.count));
  parallelFor(exec, errors.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t fold = begin; fold < end; ++fold) {
      Eigen::VectorXd fitted = samples.count, left = samples.count;
      for (Eigen::Index i = 0; i < fitted.size(); ++i)
        (folds.of[static_cast<std::size_t>(i)] == static_cast<int>(fold) ? fitted : left)[i] = 0;
      ForwardSelection selection(samples, fitted);
      do errors[fold].push_back(selection.squaredErrorOver(left));
      while (static_cast<Eigen::Index>(errors[fold].size()) <= most && !exec.cancelled() && selection.step());
    }
  });
  if (exec.cancelled()) return cancelledError();
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k <= static_cast<std::size_t>(most); ++k) {
    double sum = 0;  // a fold that has no more centres to add stays as it is
    for (const auto& list : errors) sum += list[std::min(k, list.size() - 1)];
    if (sum < least) least = sum, best = k;
  }
  return static_cast<Eigen::Index>(best);
}

}  // namespace

Folds foldsOf(const std::vector<int>& group) {
  std::map<int, int> rank;
  for (const int g : group) rank.emplace(g, 0);
  int next = 0;
  for (auto& [g, r] : rank) r = next++;
  Folds folds;
  folds.count = std::clamp(next, 1, 5);
  for (const int g : group) folds.of.push_back(rank[g] % folds.count);
  return folds;
}

Result<Fit> fitNetwork(const Samples& samples, double tolerance, std::optional<Eigen::Index> most,
                       const Exec& exec) {
  if (!most) {
    SHERD_ASSIGN(most, centresByValidation(samples, exec));
  }
  const double mean = samples.count.dot(samples.target) / samples.count.sum();
  const double enough = samples.count.sum() * std::pow(tolerance * mean, 2);
  ForwardSelection selection(samples, samples.count);
  while (static_cast<Eigen::Index>(selection.chosen().size()) < *most && selection.squaredError() > enough) {
    if (exec.cancelled()) return cancelledError();
    if (!selection.step()) break;
  }
  Fit fit;
  fit.centres = selection.chosen();
  const auto centres = static_cast<Eigen::Index>(fit.centres.size());
  Eigen::MatrixXd system(samples.points.cols(), centres + 1);
  system.leftCols(centres) = distances(samples.points, fit.centres);
  system.col(centres).setOnes();
  const Eigen::VectorXd root = samples.count.cwiseSqrt();
  const Eigen::VectorXd solution = Eigen::MatrixXd(root.asDiagonal() * system)
                                       .colPivHouseholderQr()
                                       .solve(Eigen::VectorXd(root.cwiseProduct(samples.target)));
  fit.coefficient = solution.head(centres);
  fit.bias = solution[centres];
  return fit;
}

Result<Fit> fitExactly(const Samples& samples, const Exec& exec) {
  if (exec.cancelled()) return cancelledError();
  Fit fit;
  fit.centres = asIndices(evenlyChosen(samples.points.cols(), kMostExamples));
  const auto n = static_cast<Eigen::Index>(fit.centres.size());
  const Eigen::MatrixXd points = samples.points(Eigen::all, fit.centres);
  std::vector<Index> all(fit.centres.size());
  std::iota(all.begin(), all.end(), 0);
  const double mean = samples.target.mean();
  Eigen::MatrixXd system = Eigen::MatrixXd::Ones(n + 1, n + 1);
  system.topLeftCorner(n, n) = distances(points, all);
  system(n, n) = 0;
  // Lengths near 1 beside the ones of the bias.
  const double size = system.topLeftCorner(n, n).maxCoeff();
  if (size > 0) system.topLeftCorner(n, n) /= size;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + 1);
  right.head(n) = samples.target(fit.centres).array() - mean;
  const Eigen::VectorXd solution = system.completeOrthogonalDecomposition().solve(right);
  fit.coefficient = solution.head(n) / (size > 0 ? size : 1);
  fit.bias = mean + solution[n];
  return fit;
}

}  // namespace sherd
