#include "embed/unfold.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "embed/landmarks.h"

namespace sherd {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kPartners = 2000;
constexpr Eigen::Index kMostDimensions = 8;
constexpr double kLeastAxis = 1e-3;      ///< eigenvalue of the classical scaling that counts, of the largest
constexpr double kLeastPathAxis = 1e-4;  ///< the same where paths' own coordinates are wanted
constexpr double kEnough = 1e-3;         ///< relative fall of the stress below which a step is the last
constexpr int kMostSteps = 300;
constexpr double kSingular = 1e-12;

/// Functions of a node, in rows: positions about the first node's, and modes, each with unit root mean
/// square.
MatrixXd basisOf(const BodyPart& part, const MatrixXd& functions) {
  MatrixXd basis(3 + functions.cols(), static_cast<Eigen::Index>(part.positions.size()));
  for (std::size_t n = 0; n < part.positions.size(); ++n)
    basis.col(static_cast<Eigen::Index>(n)).head<3>() = part.positions[n] - part.positions[0];
  basis.bottomRows(functions.cols()) = functions.transpose();
  const VectorXd means = basis.rowwise().mean();
  basis.colwise() -= means;
  for (Eigen::Index k = 0; k < basis.rows(); ++k)
    if (const double size = basis.row(k).norm(); size > 0)
      basis.row(k) *= std::sqrt(static_cast<double>(basis.cols())) / size;
  return basis;
}

/// Lengths between landmarks and partners (nodes), and where these are in the basis.
struct Targets {
  MatrixXd length, weight;   ///< landmarks × partners; m, m⁻²
  MatrixXd marks, partners;  ///< columns of the basis
};

Targets targetsOf(const std::vector<Landmark>& landmarks, const MatrixXd& basis) {
  const std::size_t nodes = static_cast<std::size_t>(basis.cols()),
                    stride = (nodes + kPartners - 1) / kPartners;
  std::vector<Eigen::Index> marks, partners;
  for (const Landmark& m : landmarks) marks.push_back(static_cast<Eigen::Index>(m.node));
  for (std::size_t n = 0; n < nodes; n += stride) partners.push_back(static_cast<Eigen::Index>(n));
  Targets out{MatrixXd::Zero(marks.size(), partners.size()), MatrixXd::Zero(marks.size(), partners.size()),
              basis(Eigen::all, marks), basis(Eigen::all, partners)};
  for (Eigen::Index m = 0; m < out.length.rows(); ++m)
    for (Eigen::Index n = 0; n < out.length.cols(); ++n) {
      const double length = landmarks[static_cast<std::size_t>(m)]
                                .length[static_cast<std::size_t>(partners[static_cast<std::size_t>(n)])];
      if (!(length > 0) || !std::isfinite(length)) continue;
      out.length(m, n) = length;
      out.weight(m, n) = 1 / (length * length);
    }
  return out;
}

/// Σ_m Σ_n w_mn (a_n − a_m)(b_n − b_m)ᵀ.
MatrixXd sumOverPairs(const MatrixXd& w, const MatrixXd& a, const MatrixXd& aMarks, const MatrixXd& b,
                      const MatrixXd& bMarks) {
  const VectorXd ofPartners = w.colwise().sum().transpose(), ofMarks = w.rowwise().sum();
  return a * ofPartners.asDiagonal() * b.transpose() + aMarks * ofMarks.asDiagonal() * bMarks.transpose() -
         (aMarks * w) * b.transpose() - (a * w.transpose()) * bMarks.transpose();
}

MatrixXd pseudoInverse(const MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
  const double least = kSingular * solver.eigenvalues().maxCoeff();
  const VectorXd inverse = solver.eigenvalues().unaryExpr([&](double e) { return e > least ? 1 / e : 0.0; });
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

/// Classical scaling of the landmarks, and from it places for nodes whose squared lengths from the landmarks
/// are given (landmarks × nodes): up to `most` × nodes. Empty where there are no lengths.
MatrixXd classicalScaling(const std::vector<Landmark>& landmarks, const MatrixXd& squaredLengths,
                          Eigen::Index most, double leastAxis) {
  const auto count = static_cast<Eigen::Index>(landmarks.size());
  MatrixXd squared(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const Landmark &a = landmarks[static_cast<std::size_t>(i)], &b = landmarks[static_cast<std::size_t>(j)];
      squared(i, j) = std::pow(0.5 * (a.length[b.node] + b.length[a.node]), 2);
    }
  const MatrixXd centring =
      MatrixXd::Identity(count, count) - MatrixXd::Constant(count, count, 1 / static_cast<double>(count));
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(-0.5 * centring * squared * centring);
  const VectorXd values = solver.eigenvalues().reverse();
  Eigen::Index used = 0;
  while (used < std::min(count, most) && values[used] > leastAxis * values[0]) ++used;
  MatrixXd axes(used, count);
  for (Eigen::Index k = 0; k < used; ++k)
    axes.row(k) = solver.eigenvectors().col(count - 1 - k).transpose() / std::sqrt(values[k]);
  return 0.5 * axes * (squared.rowwise().mean().replicate(1, squaredLengths.cols()) - squaredLengths);
}

Error noLengths() {
  return failure("the ways inside the tetrahedral mesh have no lengths to unfold by", "use filter: diffusion",
                 "filter");
}

/// The linear map that comes closest to the places.
MatrixXd fittedMap(const MatrixXd& basis, const MatrixXd& places) {
  const MatrixXd about = basis.colwise() - VectorXd(basis.rowwise().mean());
  return (places * about.transpose()) * pseudoInverse(about * about.transpose());
}

Result<MatrixXd> majorized(MatrixXd map, const Targets& t, const Exec& exec) {
  const MatrixXd inverse = pseudoInverse(sumOverPairs(t.weight, t.partners, t.marks, t.partners, t.marks));
  MatrixXd pull(t.length.rows(), t.length.cols());
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    if (exec.cancelled()) return cancelledError();
    const MatrixXd x = map * t.partners, marks = map * t.marks;
    double stress = 0;
    for (Eigen::Index n = 0; n < x.cols(); ++n)
      for (Eigen::Index m = 0; m < marks.cols(); ++m) {
        const double distance = (x.col(n) - marks.col(m)).norm();
        stress += t.weight(m, n) * std::pow(distance - t.length(m, n), 2);
        pull(m, n) = distance > 0 ? t.weight(m, n) * t.length(m, n) / distance : 0;
      }
    if (!(stress < last * (1 - kEnough))) break;
    last = stress;
    map = sumOverPairs(pull, x, marks, t.partners, t.marks) * inverse;
  }
  return map;
}

MatrixXd onPrincipalAxes(const MatrixXd& x) {
  const MatrixXd about = x.colwise() - VectorXd(x.rowwise().mean());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(about * about.transpose());
  return solver.eigenvectors().rowwise().reverse().transpose() * x;
}

}  // namespace

Result<MatrixXd> unfolded(const BodyPart& part, const MatrixXd& functions, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<Landmark> landmarks, landmarksOf(part, exec));
  const MatrixXd basis = basisOf(part, functions);
  const Targets targets = targetsOf(landmarks, basis);
  const MatrixXd start = classicalScaling(landmarks, targets.length.cwiseAbs2(), kMostDimensions, kLeastAxis);
  if (start.rows() == 0 || !start.allFinite()) return noLengths();
  SHERD_ASSIGN(const MatrixXd map, majorized(fittedMap(targets.partners, start), targets, exec));
  return onPrincipalAxes(map * basis);
}

Result<MatrixXd> pathCoordinates(const BodyPart& part, int most, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<Landmark> landmarks, landmarksOf(part, exec));
  MatrixXd squared(static_cast<Eigen::Index>(landmarks.size()),
                   static_cast<Eigen::Index>(part.positions.size()));
  for (std::size_t m = 0; m < landmarks.size(); ++m)
    for (std::size_t n = 0; n < part.positions.size(); ++n)
      squared(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n)) =
          std::pow(landmarks[m].length[n], 2);
  const MatrixXd places = classicalScaling(landmarks, squared, most, kLeastPathAxis);
  if (places.rows() == 0 || !places.allFinite()) return noLengths();
  return places;
}

}  // namespace sherd
