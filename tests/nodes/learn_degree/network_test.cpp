#include "learn_degree/network.h"

#include <gtest/gtest.h>

#include "base/parallel.h"

namespace sherd {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double valueOf(const Fit& fit, const MatrixXd& points, const VectorXd& z) {
  double y = fit.bias;
  for (Eigen::Index k = 0; k < fit.coefficient.size(); ++k)
    y += fit.coefficient[k] * (points.col(fit.centres[static_cast<std::size_t>(k)]) - z).norm();
  return y;
}

Samples samplesOf(const MatrixXd& points, const VectorXd& target) {
  Samples s{points, target, VectorXd::Ones(target.size()), {}};
  for (int i = 0; i < target.size(); ++i) s.group.push_back(i);
  return s;
}

template <class T>
T valueOf(Result<T> result) {
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(result).value();
}

TEST(Network, OneSampleIsAConstant) {
  const Samples s = samplesOf(MatrixXd::Random(3, 1), VectorXd::Constant(1, 7));
  for (const Fit& fit : {valueOf(fitNetwork(s, 0.01, {}, Exec{})), valueOf(fitExactly(s, Exec{}))})
    EXPECT_NEAR(valueOf(fit, s.points, VectorXd::Random(3)), 7, 1e-9);
}

TEST(Network, ConstantTargetsNeedNoCentre) {
  const Samples s = samplesOf(MatrixXd::Random(4, 30), VectorXd::Ones(30));
  const Fit fit = valueOf(fitNetwork(s, 0.01, {}, Exec{}));
  EXPECT_TRUE(fit.centres.empty());
  EXPECT_NEAR(fit.bias, 1, 1e-12);
}

TEST(Network, ExactlyThroughEverySample) {
  const Samples s = samplesOf(MatrixXd::Random(4, 60), 10 * VectorXd::Random(60));
  const Fit fit = valueOf(fitExactly(s, Exec{}));
  for (Eigen::Index i = 0; i < 60; ++i)
    EXPECT_NEAR(valueOf(fit, s.points, s.points.col(i)), s.target[i], 1e-9);
  EXPECT_NEAR(fit.coefficient.sum(), 0, 1e-9);  // so that it is the smoothest in the sense of φ
}

TEST(Network, ExactlyCopesWithPointsThatCannotBeToldApart) {
  MatrixXd points = MatrixXd::Random(2, 10);
  points.col(4) = points.col(5).array() + 1e-18;
  const Fit fit = valueOf(fitExactly(samplesOf(points, VectorXd::LinSpaced(10, 1, 10)), Exec{}));
  EXPECT_TRUE(fit.coefficient.allFinite());
  EXPECT_NEAR(valueOf(fit, points, points.col(0)), 1, 0.5);
}

TEST(Network, FindsTheCentreThatMadeTheTargets) {
  const MatrixXd points = MatrixXd::Random(3, 80);
  VectorXd target(80);
  for (Eigen::Index i = 0; i < 80; ++i)
    target[i] = 5 + 3 * (points.col(i) - points.col(17)).norm() - (points.col(i) - points.col(60)).norm();
  const Samples s = samplesOf(points, target);
  const Fit fit = valueOf(fitNetwork(s, 1e-9, {}, Exec{}));
  EXPECT_TRUE(std::count(fit.centres.begin(), fit.centres.end(), 17));
  EXPECT_TRUE(std::count(fit.centres.begin(), fit.centres.end(), 60));
  for (Eigen::Index i = 0; i < 80; ++i) EXPECT_NEAR(valueOf(fit, points, points.col(i)), target[i], 1e-6);
}

TEST(Network, StopsBeforeItLearnsNoise) {
  // A plane under noise: each centre beyond a few makes unseen samples worse.
  const MatrixXd points = MatrixXd::Random(6, 120);
  const VectorXd target = (20 + 4 * points.row(0).array()).matrix().transpose() + 3 * VectorXd::Random(120);
  const Fit fit = valueOf(fitNetwork(samplesOf(points, target), 0.0, {}, Exec{}));
  EXPECT_LT(fit.centres.size(), 40u);
  double error = 0;
  for (int k = 0; k < 200; ++k) {
    const VectorXd z = VectorXd::Random(6);
    error += std::abs(valueOf(fit, points, z) - 20 - 4 * z[0]) / 200;
  }
  EXPECT_LT(error, 1.5);
}

TEST(Network, CountsWeigh) {
  // Two samples at one place by count are as two samples.
  MatrixXd points(1, 3);
  points << 0, 1, 2;
  Samples s = samplesOf(points, Eigen::Vector3d(1, 5, 1));
  s.count << 1, 2, 1;
  s.group = {0, 0, 0};
  const Fit fit = valueOf(fitNetwork(s, 10.0, {}, Exec{}));  // the bias alone is good enough
  EXPECT_TRUE(fit.centres.empty());
  EXPECT_NEAR(fit.bias, 3, 1e-12);
}

TEST(Network, FoldsKeepGroupsTogether) {
  const Folds folds = foldsOf({9, 9, 4, 4, 7, 1, 1, 2, 3, 9});
  EXPECT_EQ(folds.count, 5);
  EXPECT_EQ(folds.of[0], folds.of[1]);
  EXPECT_EQ(folds.of[0], folds.of[9]);
  EXPECT_EQ(folds.of[2], folds.of[3]);
  EXPECT_EQ(foldsOf({3, 3, 3}).count, 1);
}

}  // namespace
}  // namespace sherd
