#include "embed/filter.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "embed/landmarks.h"

namespace sherd {
namespace {

constexpr std::size_t kPartners = 2000;

/// The least-squares problem's normal equations: A g ≈ b, g_k = f_k².
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  NormalEquations& operator+=(const NormalEquations& o) {
    matrix += o.matrix;
    right += o.right;
    return *this;
  }
};

NormalEquations equationsOf(const BodyPart& part, const Landmark& mark, const Eigen::MatrixXd& functions) {
  const std::size_t nodes = part.positions.size(), stride = (nodes + kPartners - 1) / kPartners;
  Eigen::MatrixXd rows(functions.cols() + 1, static_cast<Eigen::Index>((nodes + stride - 1) / stride));
  Eigen::VectorXd target(rows.cols());
  Eigen::Index used = 0;
  for (std::size_t n = 0; n < nodes; n += stride) {
    const double straight = (part.positions[n] - part.positions[mark.node]).norm();
    const double distance = mark.length[n];
    if (!(distance > 0) || !std::isfinite(distance)) continue;
    const auto i = static_cast<Eigen::Index>(n), m = static_cast<Eigen::Index>(mark.node);
    // Errors of squared distances over distances are errors of distances, up to a factor.
    target[used] = distance;
    rows(0, used) = straight * straight / distance;
    rows.col(used).tail(functions.cols()) =
        (functions.row(i) - functions.row(m)).array().square().transpose() / distance;
    ++used;
  }
  const auto filled = rows.leftCols(used);
  return {filled * filled.transpose(), filled * target.head(used)};
}

/// Minimises gᵀAg/2 − bᵀg over g ≥ 0, one coordinate after another.
Eigen::VectorXd nonNegativeSolution(NormalEquations e) {
  const Eigen::Index n = e.right.size();
  // Unit diagonal, so that one tolerance serves all unknowns.
  const Eigen::VectorXd scale =
      e.matrix.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  e.matrix = scale.asDiagonal() * e.matrix * scale.asDiagonal();
  e.right = scale.cwiseProduct(e.right);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
  for (int sweep = 0; sweep < 5000; ++sweep) {
    double change = 0;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (scale[k] == 0) continue;
      const double value = std::max(0.0, g[k] + e.right[k] - e.matrix.row(k).dot(g));
      change = std::max(change, std::abs(value - g[k]));
      g[k] = value;
    }
    if (change <= 1e-10 * g.maxCoeff()) break;
  }
  return scale.cwiseProduct(g);
}

}  // namespace

Eigen::VectorXd diffusionFilter(const Eigen::VectorXd& eigenvalues, double time) {
  if (eigenvalues.size() == 0) return {};
  return (-(time / eigenvalues[0]) * eigenvalues.array()).exp();
}

Result<FittedFilter> fittedFilter(const BodyPart& part, const Eigen::MatrixXd& functions, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<Landmark> marks, landmarksOf(part, exec));
  const Eigen::Index unknowns = functions.cols() + 1;
  const NormalEquations zero{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
  const NormalEquations sum = parallelSum(exec, marks.size(), 1, zero, [&](std::size_t begin, std::size_t) {
    return equationsOf(part, marks[begin], functions);
  });
  if (exec.cancelled()) return cancelledError();
  const Eigen::VectorXd factors = nonNegativeSolution(sum).cwiseSqrt();
  if (!factors.allFinite() || !(factors.maxCoeff() > 0))
    return failure("the eigenmodes don't fit the distances in the tetrahedral mesh", "use filter: diffusion",
                   "filter");
  return FittedFilter{factors[0], factors.tail(functions.cols())};
}

}  // namespace sherd
