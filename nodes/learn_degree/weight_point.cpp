#include "learn_degree/weight_point.h"

#include <cmath>
#include <numeric>

namespace sherd {
namespace {

/// What a feature that is next to nothing counts as, relative to the largest: its logarithm has to be finite.
constexpr double kLeastShare = 1e-12;
/// In place of a share of nothing, whose logarithm has to be finite.
constexpr double kNothing = 1e-300;

Eigen::VectorXd centroid(const std::vector<double>& volume, const Embedding& embedding) {
  const auto v = Eigen::Map<const Eigen::VectorXd>(volume.data(), static_cast<Eigen::Index>(volume.size()));
  const double total = v.sum();
  if (!(total > 0)) return embedding.coordinates.rowwise().mean();
  return embedding.coordinates * (v / total);
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

Eigen::Matrix<double, kFeatures, 1> logFeatures(const std::vector<double>& weight,
                                                const std::vector<double>& volume, const Embedding& embedding,
                                                double gamma) {
  const auto asArray = [](const std::vector<double>& v) {
    return Eigen::Map<const Eigen::ArrayXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  const Eigen::VectorXd c = centroid(volume, embedding);
  // Shares, so that no power over- or underflows whatever the units.
  const double totalWeight = asArray(weight).sum(), totalVolume = asArray(volume).sum();
  const Eigen::ArrayXd w = asArray(weight) / totalWeight, v = asArray(volume) / totalVolume;
  const double second =
      (embedding.coordinates.colwise() - c).colwise().squaredNorm().dot(w.matrix().transpose());
  const double first2 = (embedding.coordinates * w.matrix() - c).squaredNorm();
  // One power to make both of.
  const Eigen::ArrayXd fifteenth = ((w.max(kNothing) / v.max(kNothing)).log() / 15).exp();
  const Eigen::ArrayXd toTheFourth = fifteenth.square().square();
  const double threeFifths = (v * fifteenth * toTheFourth.square()).sum();
  const double third = (v * fifteenth * toTheFourth).sum();
  const double size2 = embedding.diameter * embedding.diameter;
  const double volume2 = std::pow(totalVolume, 2.0 / 3), least = kLeastShare * size2;
  Eigen::Matrix<double, kFeatures, 1> out;
  out << std::max(second, least), std::max(second - first2, least), size2,
      volume2 * std::max(std::pow(threeFifths, 5.0 / 3), kLeastShare),
      volume2 * std::max(third * third * third, kLeastShare);
  return out.array().log() + (std::log(totalWeight) - std::log(gamma));
}

Eigen::VectorXd dividedWeights(const std::vector<double>& weight, double scale) {
  const auto w = Eigen::Map<const Eigen::VectorXd>(weight.data(), static_cast<Eigen::Index>(weight.size()));
  const double divisor = scale > 0 ? scale : w.sum();
  if (!(divisor > 0)) return Eigen::VectorXd::Zero(w.size());
  return w / divisor;
}

WeightPoint pointOf(const DegreeModel& model, const std::vector<double>& weight,
                    const std::vector<double>& volume, const Embedding& embedding) {
  const Eigen::Index features = model.featureScale.rows(), components = model.basis.rows();
  WeightPoint point;
  point.z.resize(features + components);
  if (features > 0) {
    const auto logs = logFeatures(weight, volume, embedding, model.validFor.gamma);
    point.logWhole = logs[0];
    point.z.head(features) = (logs - model.featureScale.col(0)).cwiseProduct(model.featureScale.col(1));
  }
  if (components == 0) return point;
  const auto mean =
      Eigen::Map<const Eigen::VectorXd>(model.mean.data(), static_cast<Eigen::Index>(model.mean.size()));
  const Eigen::VectorXd centred = dividedWeights(weight, model.scale) - mean;
  point.z.tail(components) = model.basis * centred;
  const double inside = point.z.tail(components).squaredNorm();
  const double all = model.residualFactor * model.residualFactor * centred.squaredNorm();
  point.residual = std::sqrt(std::max(0.0, all - inside));
  return point;
}

}  // namespace sherd
