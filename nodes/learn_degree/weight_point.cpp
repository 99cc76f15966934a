#include "learn_degree/weight_point.h"

#include <array>
#include <cmath>

#include "learn_degree/split_tree.h"
#include "learn_degree/sums.h"

namespace sherd {
namespace {

/// What a feature that is next to nothing counts as, relative to the largest: its logarithm has to be finite.
constexpr double kLeastShare = 1e-12;

Columns columnsOf(const Eigen::MatrixXd& m) {
  return {m.data(), static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols())};
}

Eigen::Map<const Eigen::ArrayXd> asArray(const std::vector<double>& v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

Eigen::VectorXd centroid(const std::vector<double>& volume, const Embedding& embedding) {
  const double total = asArray(volume).sum();
  if (!(total > 0)) return embedding.coordinates.rowwise().mean();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(embedding.coordinates.rows());
  addProduct(columnsOf(embedding.coordinates), volume.data(), sum.data());
  return sum / total;
}

}  // namespace

double wholeEnergy(const std::vector<double>& weight, const std::vector<double>& volume,
                   const Embedding& embedding) {
  const Eigen::VectorXd c = centroid(volume, embedding);
  double sum = 0;
  for (std::size_t n = 0; n < weight.size(); ++n)
    sum += weight[n] * (embedding.coordinates.col(static_cast<Eigen::Index>(n)) - c).squaredNorm();
  return sum;
}

LogFeatures logFeatures(const std::vector<Index>& order, const std::vector<double>& weight,
                        const std::vector<double>& volume, const Embedding& embedding, double gamma) {
  const std::array thresholds{4 * gamma, gamma};
  const TreeEnergy tree = treeEnergy(order, embedding, centroid(volume, embedding), weight, thresholds);
  // Shares, so that no root over- or underflows whatever the units.
  const double totalVolume = asArray(volume).sum();
  const Eigen::ArrayXd w = asArray(weight) / tree.weight, v = asArray(volume) / totalVolume;
  const RootSums sums = rootSums({v.data(), volume.size()}, {w.data(), weight.size()});
  const double size2 = embedding.diameter * embedding.diameter, least = kLeastShare * size2;
  const double volume2 = std::pow(totalVolume, 2.0 / 3);
  const double logScale = std::log(tree.weight) - std::log(gamma);
  const auto over = [&](double value) { return std::log(value) + logScale; };
  LogFeatures out;
  out.value << tree.logPieces[1], tree.logPieces[0], over(tree.whole / tree.weight),
      over(std::max(tree.centred / tree.weight, least)),
      over(volume2 * std::max(std::cbrt(sums.threeQuarters) * sums.threeQuarters, kLeastShare)),
      over(volume2 * std::max(sums.half * sums.half, kLeastShare));
  return out;
}

Eigen::VectorXd dividedWeights(const std::vector<double>& weight, double scale) {
  const auto w = asArray(weight).matrix();
  const double divisor = scale > 0 ? scale : w.sum();
  if (!(divisor > 0)) return Eigen::VectorXd::Zero(w.size());
  return w / divisor;
}

WeightPoint pointOf(const DegreeModel& model, const std::vector<double>& weight,
                    const std::vector<double>& volume, const Embedding& embedding) {
  const Eigen::Index features = model.featureScale.rows(), components = model.basis.rows();
  WeightPoint point;
  point.z.setZero(features + components);
  if (features > 0) {
    const LogFeatures logs = logFeatures(model.order, weight, volume, embedding, model.validFor.gamma);
    point.logPieces = logs.pieces();
    point.logWhole = logs.whole();
    point.z.head(features) = (logs.value - model.featureScale.col(0)).cwiseProduct(model.featureScale.col(1));
  }
  if (components == 0) return point;
  const Eigen::VectorXd centred = dividedWeights(weight, model.scale) - asArray(model.mean).matrix();
  addProduct(columnsOf(model.basis), centred.data(), point.z.data() + features);
  const double inside = point.z.tail(components).squaredNorm();
  const double all = model.residualFactor * model.residualFactor * centred.squaredNorm();
  point.residual = std::sqrt(std::max(0.0, all - inside));
  return point;
}

}  // namespace sherd
