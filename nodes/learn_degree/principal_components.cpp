#include "learn_degree/principal_components.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

namespace sherd {
namespace {

/// Directions whose deviation is less than this of the largest are rounding: they come of squares.
constexpr double kSmallestShare = 1e-7;

/// Twice: once leaves a part of the others where the deviations differ much.
void orthonormalize(Eigen::MatrixXd& basis) {
  for (Eigen::Index k = 0; k < basis.rows(); ++k) {
    for (int pass = 0; pass < 2; ++pass)
      for (Eigen::Index j = 0; j < k; ++j) basis.row(k) -= basis.row(k).dot(basis.row(j)) * basis.row(j);
    basis.row(k).normalize();
    Eigen::Index largest = 0;
    basis.row(k).cwiseAbs().maxCoeff(&largest);
    if (basis(k, largest) < 0) basis.row(k) *= -1;
  }
}

/// How many of the squared deviations, largest first, are wanted; and what they leave.
Eigen::Index countComponents(const Eigen::VectorXd& squared, double tolerance, double& residual) {
  const double total = squared.sum();
  double left = total;
  Eigen::Index count = 0;
  while (count < squared.size() && left > tolerance * tolerance * total &&
         squared[count] > kSmallestShare * kSmallestShare * squared[0]) {
    ++count;
    left = squared.tail(squared.size() - count).sum();  // not by subtraction, which loses the small ones
  }
  residual = std::sqrt(left);
  return count;
}

}  // namespace

std::vector<Eigen::Index> evenlyChosen(Eigen::Index of, Eigen::Index count) {
  std::vector<Eigen::Index> chosen;
  const Eigen::Index n = std::min(of, count);
  for (Eigen::Index i = 0; i < n; ++i) chosen.push_back(i * of / n);
  return chosen;
}

Result<PrincipalComponents> principalComponents(const Eigen::MatrixXd& examples, double tolerance,
                                                const Exec& exec) {
  if (examples.cols() == 0 || examples.rows() == 0) return failure("there are no examples to learn from");
  for (Eigen::Index i = 0; i < examples.cols(); ++i)
    if (!examples.col(i).allFinite())
      return failure(fmt::format("example {} holds a number that is not finite", i + 1));
  PrincipalComponents out;
  out.mean = examples.rowwise().mean();
  Eigen::MatrixXd x = examples(Eigen::all, evenlyChosen(examples.cols(), kMostExamples)).colwise() - out.mean;
  const double largest = x.cwiseAbs().maxCoeff();
  // Equal examples differ from their mean by rounding only.
  if (!(largest > 1e-14 * examples.cwiseAbs().maxCoeff())) {
    out.basis = Eigen::MatrixXd::Zero(1, examples.rows());
    return out;
  }
  x /= largest;

  const bool few = x.cols() <= x.rows();  // then the smaller matrix has the same deviations
  const Eigen::MatrixXd gram = few ? Eigen::MatrixXd(x.transpose() * x) : Eigen::MatrixXd(x * x.transpose());
  if (exec.cancelled()) return cancelledError();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
  if (exec.cancelled()) return cancelledError();
  if (solver.info() != Eigen::Success) return failure("the principal components could not be found");
  const Eigen::VectorXd squared = solver.eigenvalues().reverse().cwiseMax(0.0);
  const Eigen::Index count = countComponents(squared, tolerance, out.residual);
  const Eigen::MatrixXd vectors = solver.eigenvectors().rowwise().reverse().leftCols(count);
  out.basis = few ? Eigen::MatrixXd((x * vectors).transpose()) : Eigen::MatrixXd(vectors.transpose());
  orthonormalize(out.basis);
  out.total = std::sqrt(squared.sum()) * largest;
  out.residual *= largest;
  return out;
}

}  // namespace sherd
