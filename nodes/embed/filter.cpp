#include "embed/filter.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "embed/paths.h"

namespace sherd {
namespace {

constexpr std::size_t kLandmarks = 64;
constexpr std::size_t kPartners = 2000;
constexpr double kLeastEigenvalue = 1e-4;  ///< of the largest: of what is left, much is noise

struct Landmark {
  std::size_t node;
  std::vector<double> length;  ///< m, of the shortest path to every node
};

/// Each the farthest from those before, beginning with node 0.
std::vector<Landmark> landmarks(const PathGraph& graph, std::size_t nodes, const Exec& exec) {
  std::vector<Landmark> marks;
  std::vector<double> nearest(nodes, std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  while (marks.size() < std::min(kLandmarks, nodes) && !exec.cancelled()) {
    marks.push_back({next, graph.lengthsFrom(static_cast<Index>(next))});
    for (std::size_t n = 0; n < nodes; ++n) nearest[n] = std::min(nearest[n], marks.back().length[n]);
    // The first of those about as far: rounding must not choose between places that mirror each other.
    const double farthest = *std::max_element(nearest.begin(), nearest.end());
    next = static_cast<std::size_t>(
        std::find_if(nearest.begin(), nearest.end(), [&](double d) { return d >= farthest * (1 - 1e-9); }) -
        nearest.begin());
    if (!(nearest[next] > 0)) break;
  }
  return marks;
}

/// How much longer paths are than the straight lines of pairs so near that they mostly see each other.
double zigzag(const BodyPart& part, const std::vector<Landmark>& marks, double link) {
  std::vector<double> ratio;
  for (const Landmark& mark : marks)
    for (std::size_t n = 0; n < part.positions.size(); ++n)
      if (mark.length[n] > 3 * link && mark.length[n] < 8 * link)
        ratio.push_back(mark.length[n] / (part.positions[n] - part.positions[mark.node]).norm());
  if (ratio.empty()) return 1;
  const auto middle = ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2);
  std::nth_element(ratio.begin(), middle, ratio.end());
  return *middle;
}

/// Spread over the body as it is, whatever lengths count there; lengths without their zigzag.
Result<std::vector<Landmark>> measured(const BodyPart& part, const Exec& exec) {
  const PathGraph graph(part.positions, part.tets, part.neighbours);
  if (exec.cancelled()) return cancelledError();
  std::vector<Landmark> marks = landmarks(graph, part.positions.size(), exec);
  if (exec.cancelled()) return cancelledError();
  const double longer = zigzag(part, marks, graph.meanLink());
  if (!part.stretch.empty()) {
    const PathGraph stretched(part.positions, part.tets, part.neighbours, part.stretch);
    for (Landmark& mark : marks) {
      if (exec.cancelled()) return cancelledError();
      mark.length = stretched.lengthsFrom(static_cast<Index>(mark.node));
    }
  }
  for (Landmark& mark : marks)
    for (double& length : mark.length) length /= longer;
  return marks;
}

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

NormalEquations equationsOf(std::span<const Vec3> places, const Landmark& mark,
                            const Eigen::MatrixXd& functions) {
  const std::size_t nodes = places.size(), stride = (nodes + kPartners - 1) / kPartners;
  Eigen::MatrixXd rows(functions.cols() + 1, static_cast<Eigen::Index>((nodes + stride - 1) / stride));
  Eigen::VectorXd target(rows.cols());
  Eigen::Index used = 0;
  for (std::size_t n = 0; n < nodes; n += stride) {
    const double straight = (places[n] - places[mark.node]).norm();
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

Result<Eigen::MatrixXd> pathCoordinates(const BodyPart& part, int most, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<Landmark> marks, measured(part, exec));
  const auto count = static_cast<Eigen::Index>(marks.size());
  Eigen::MatrixXd squared(count, static_cast<Eigen::Index>(part.positions.size()));
  for (Eigen::Index m = 0; m < count; ++m)
    for (Eigen::Index n = 0; n < squared.cols(); ++n)
      squared(m, n) = std::pow(marks[static_cast<std::size_t>(m)].length[static_cast<std::size_t>(n)], 2);
  Eigen::MatrixXd between(count, count);
  for (Eigen::Index m = 0; m < count; ++m)
    between.col(m) = squared.col(static_cast<Eigen::Index>(marks[static_cast<std::size_t>(m)].node));
  const Eigen::VectorXd mean = between.rowwise().mean();
  const Eigen::MatrixXd centring = Eigen::MatrixXd::Identity(count, count) -
                                   Eigen::MatrixXd::Constant(count, count, 1.0 / static_cast<double>(count));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(-0.5 * centring * between * centring);
  if (spectrum.info() != Eigen::Success)
    return failure("the lengths of paths have no coordinates", "use filter: diffusion", "stretch");
  if (exec.cancelled()) return cancelledError();
  Eigen::Index kept = 0;  // the largest come last
  while (kept < std::min<Eigen::Index>(most, count) &&
         spectrum.eigenvalues()[count - 1 - kept] > kLeastEigenvalue * spectrum.eigenvalues()[count - 1])
    ++kept;
  const auto values = spectrum.eigenvalues().tail(kept);
  const auto vectors = spectrum.eigenvectors().rightCols(kept);
  return Eigen::MatrixXd(-0.5 * (squared.colwise() - mean).transpose() * vectors *
                         values.cwiseSqrt().cwiseInverse().asDiagonal());
}

Result<FittedFilter> fittedFilter(const BodyPart& part, const Eigen::MatrixXd& functions, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<Landmark> marks, measured(part, exec));
  const Eigen::Index unknowns = functions.cols() + 1;
  const NormalEquations zero{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
  const NormalEquations sum = parallelSum(exec, marks.size(), 1, zero, [&](std::size_t begin, std::size_t) {
    return equationsOf(part.positions, marks[begin], functions);
  });
  if (exec.cancelled()) return cancelledError();
  const Eigen::VectorXd factors = nonNegativeSolution(sum).cwiseSqrt();
  if (!factors.allFinite() || !(factors.maxCoeff() > 0))
    return failure("the eigenmodes don't fit the distances in the tetrahedral mesh", "use filter: diffusion",
                   "filter");
  return FittedFilter{factors[0], factors.tail(functions.cols())};
}

}  // namespace sherd
