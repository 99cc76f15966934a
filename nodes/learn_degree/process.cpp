#include "learn_degree/process.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "learn_degree/principal_components.h"

namespace sherd {
namespace {

constexpr std::array kFeatureFactors{0.015625, 0.0625, 0.125, 0.25, 0.5, 1.0, 2.0};
constexpr std::array kComponentFactors{0.0, 0.0625, 0.125, 0.25, 0.5, 1.0, 2.0};
constexpr std::array kNoises{1e-3, 1e-2, 0.1, 0.3, 1.0, 10.0};

class Process {
 public:
  Process(const Samples& samples, Eigen::Index features, std::vector<Eigen::Index> used)
      : used_(std::move(used)),
        features_(samples.points(Eigen::seqN(0, features), used_)),
        components_(samples.points(Eigen::seqN(features, samples.points.rows() - features), used_)),
        count_(samples.count(used_)) {
    const Eigen::VectorXd target = samples.target(used_);
    mean_ = count_.dot(target) / count_.sum();
    target_ = target.array() - mean_;
    featureDistance2_ = squaredDistances(features_);
    componentDistance2_ = squaredDistances(components_);
  }

  Eigen::MatrixXd covariance(const ProcessScales& s) const {
    Eigen::MatrixXd k =
        s.feature * s.feature * featureDistance2_ + s.component * s.component * componentDistance2_;
    for (Eigen::Index j = 0; j < k.cols(); ++j) k.col(j) = maternOf(k.col(j).array().sqrt());
    k.array() += kMeanVariance;
    k.diagonal() += s.noise * count_.cwiseInverse();
    return k;
  }

  /// The logarithm of the marginal likelihood, with the variance that makes it largest.
  double likelihood(const ProcessScales& s) const {
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance(s));
    if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    const auto n = static_cast<double>(count_.size());
    const double fit = target_.dot(factor.solve(target_)) / n;
    if (!(fit > 0)) return -std::numeric_limits<double>::infinity();
    return -0.5 * n * std::log(fit) - Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum();
  }

  ProcessFit fit(const ProcessScales& s) const {
    ProcessFit out{{}, s};
    const auto n = count_.size();
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance(s));
    out.fit.centres.assign(used_.begin(), used_.end());
    out.fit.coefficient = factor.solve(target_);
    out.fit.whitening = factor.matrixU().solve(Eigen::MatrixXd::Identity(n, n));
    out.fit.variance = target_.dot(out.fit.coefficient) / static_cast<double>(n);
    out.fit.bias = mean_ + kMeanVariance * out.fit.coefficient.sum();
    return out;
  }

  bool isConstant() const { return !(target_.cwiseAbs().maxCoeff() > 1e-12 * (1 + std::abs(mean_))); }
  double mean() const { return mean_; }

 private:
  static Eigen::MatrixXd squaredDistances(const Eigen::MatrixXd& points) {
    Eigen::MatrixXd d(points.cols(), points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      d.col(i) = (points.colwise() - points.col(i)).colwise().squaredNorm().transpose();
    return d;
  }

  std::vector<Eigen::Index> used_;
  Eigen::MatrixXd features_, components_;
  Eigen::VectorXd count_, target_;
  double mean_ = 0;
  Eigen::MatrixXd featureDistance2_, componentDistance2_;
};

/// Tries the other values for one of the scales; true where one is better.
bool improve(const Process& process, ProcessScales& scales, double ProcessScales::*one,
             std::span<const double> values, double& best, const Exec& exec) {
  std::vector<ProcessScales> tried;
  for (const double value : values) {
    if (value == scales.*one) continue;
    tried.push_back(scales);
    tried.back().*one = value;
  }
  std::vector<double> likelihood(tried.size());
  parallelFor(exec, tried.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) likelihood[i] = process.likelihood(tried[i]);
  });
  if (exec.cancelled()) return false;
  bool changed = false;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (!(likelihood[i] > best)) continue;
    best = likelihood[i];
    scales = tried[i];
    changed = true;
  }
  return changed;
}

}  // namespace

Eigen::ArrayXd maternOf(const Eigen::ArrayXd& r) {
  const Eigen::ArrayXd a = std::sqrt(5.0) * r;
  return (1 + a + a.square() / 3) * (-a).exp();
}

Result<ProcessFit> fitProcess(const Samples& samples, Eigen::Index features,
                              const std::optional<ProcessScales>& given, const Exec& exec) {
  const Process process(samples, features, evenlyChosen(samples.points.cols(), kMostExamples));
  if (process.isConstant()) {
    ProcessFit constant;
    constant.fit.bias = process.mean();
    return constant;
  }
  if (given) return process.fit(*given);
  ProcessScales scales;
  double best = process.likelihood(scales);
  for (int round = 0; round < 4; ++round) {
    bool changed = improve(process, scales, &ProcessScales::component, kComponentFactors, best, exec);
    changed |= improve(process, scales, &ProcessScales::feature, kFeatureFactors, best, exec);
    changed |= improve(process, scales, &ProcessScales::noise, kNoises, best, exec);
    if (exec.cancelled()) return cancelledError();
    if (!changed) break;
  }
  return process.fit(scales);
}

}  // namespace sherd
