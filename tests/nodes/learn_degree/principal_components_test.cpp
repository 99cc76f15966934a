#include "learn_degree/principal_components.h"

#include <gtest/gtest.h>

namespace sherd {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

PrincipalComponents componentsOf(const MatrixXd& examples, double tolerance) {
  auto result = principalComponents(examples, tolerance, Exec{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(result).value();
}

/// What the basis leaves of the centred examples.
double leftOver(const MatrixXd& examples, const PrincipalComponents& pc) {
  const MatrixXd x = examples.colwise() - pc.mean;
  return (x - pc.basis.transpose() * (pc.basis * x)).norm();
}

void expectOrthonormal(const PrincipalComponents& pc) {
  const MatrixXd gram = pc.basis * pc.basis.transpose();
  EXPECT_LT((gram - MatrixXd::Identity(gram.rows(), gram.cols())).norm(), 1e-12);
}

TEST(PrincipalComponents, OneExampleIsItsOwnMean) {
  const MatrixXd one = MatrixXd::Random(50, 1);
  const auto pc = componentsOf(one, 0.02);
  EXPECT_EQ(pc.mean, one.col(0));
  EXPECT_EQ(pc.basis, MatrixXd::Zero(1, 50));
  EXPECT_EQ(pc.total, 0);
}

TEST(PrincipalComponents, EqualExamplesHaveNone) {
  const MatrixXd equal = MatrixXd::Random(50, 1).replicate(1, 7);
  EXPECT_EQ(componentsOf(equal, 0.0).basis, MatrixXd::Zero(1, 50));
  EXPECT_EQ(componentsOf(MatrixXd::Zero(5, 3), 0.0).basis, MatrixXd::Zero(1, 5));
}

TEST(PrincipalComponents, RankDeficientExamplesHaveTheirRank) {
  const MatrixXd examples = MatrixXd::Random(80, 3) * MatrixXd::Random(3, 20);
  const auto pc = componentsOf(examples, 0.0);
  EXPECT_EQ(pc.basis.rows(), 3);
  expectOrthonormal(pc);
  EXPECT_LT(leftOver(examples, pc), 1e-6 * pc.total);
}

TEST(PrincipalComponents, ToleranceIsOfTheNormThatIsLeft) {
  for (const auto& [rows, columns] : {std::pair<Index, Index>{400, 30}, {30, 400}}) {
    MatrixXd examples = MatrixXd::Random(rows, columns);
    for (Index i = 0; i < rows; ++i) examples.row(i) *= std::pow(0.8, static_cast<double>(i % 30));
    for (const double tolerance : {0.5, 0.1, 0.02, 0.001}) {
      const auto pc = componentsOf(examples, tolerance);
      expectOrthonormal(pc);
      EXPECT_NEAR(leftOver(examples, pc), pc.residual, 1e-7 * pc.total);
      EXPECT_LE(pc.residual, tolerance * pc.total);
      PrincipalComponents fewer = pc;
      fewer.basis.conservativeResize(pc.basis.rows() - 1, rows);
      EXPECT_GT(leftOver(examples, fewer), tolerance * pc.total);
    }
  }
}

TEST(PrincipalComponents, KnownDirectionsWithTheirLargestEntryPositive) {
  MatrixXd examples = MatrixXd::Zero(6, 4);
  examples(4, 0) = -10, examples(4, 1) = 10;
  examples(1, 2) = -1, examples(1, 3) = 1;
  const auto pc = componentsOf(examples, 0.0);
  ASSERT_EQ(pc.basis.rows(), 2);
  EXPECT_NEAR(pc.basis(0, 4), 1, 1e-12);
  EXPECT_NEAR(pc.basis(1, 1), 1, 1e-12);
}

TEST(PrincipalComponents, ScaleDoesNotMatter) {
  const MatrixXd examples = MatrixXd::Random(40, 12);
  const auto pc = componentsOf(examples, 0.05), small = componentsOf(examples * 0x1p-500, 0.05);
  EXPECT_EQ(pc.basis, small.basis);
  EXPECT_EQ(pc.total * 0x1p-500, small.total);
}

TEST(PrincipalComponents, NotANumberIsAnErrorWithTheExample) {
  MatrixXd examples = MatrixXd::Random(10, 5);
  examples(3, 2) = std::nan("");
  const auto result = principalComponents(examples, 0.02, Exec{});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().what, "example 3 holds a number that is not finite");
  EXPECT_FALSE(principalComponents(MatrixXd(10, 0), 0.02, Exec{}).ok());
}

}  // namespace
}  // namespace sherd
