// What a model says of new weights (learn_degree.h).
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/value_type.h"
#include "learn_degree/learn_degree.h"
#include "learn_degree/process.h"
#include "learn_degree/sums.h"
#include "learn_degree/weight_point.h"

namespace sherd {
namespace {

constexpr double kMostPieces = 0x1p20;
/// Rounding between two points that are the same, of their size.
constexpr double kSamePoint = 1e-9;

Eigen::Map<const Eigen::VectorXd> asVector(const std::vector<double>& v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

/// y of the model, and the standard deviation of it that a process knows.
struct Output {
  double y = 0, deviation = 0;
};

Output outputOf(const DegreeModel& model, const Eigen::VectorXd& distance, Deviation deviation) {
  const bool isProcess = model.method == DegreeMethod::Process;
  Eigen::ArrayXd phi(static_cast<Eigen::Index>(model.centres.size()));
  for (Eigen::Index k = 0; k < phi.size(); ++k) phi[k] = distance[model.centres[static_cast<std::size_t>(k)]];
  if (isProcess) phi = maternOf(phi);
  Output out;
  out.y = model.bias + asVector(model.coefficient).dot(phi.matrix());
  if (deviation == Deviation::Unknown || model.whitening.size() == 0) return out;
  phi += kMeanVariance;
  const auto size = static_cast<std::size_t>(phi.size());
  const double unexplained =
      1 + kMeanVariance - squaredNormOfProduct({model.whitening.data(), size, size}, phi.data());
  out.deviation = std::sqrt(model.variance * (std::max(0.0, unexplained) + model.noise));
  return out;
}

int rounded(double pieces, double least) {
  return static_cast<int>(std::lround(std::fmin(std::fmax(pieces, least), kMostPieces)));
}

}  // namespace

DegreeEstimate estimateDegree(const DegreeModel& model, const WeightField& weights,
                              const Embedding& embedding, Deviation deviation) {
  const bool isProcess = model.method == DegreeMethod::Process;
  const WeightPoint point = pointOf(model, weights.weight, weights.volume, embedding);
  if (isProcess && !(point.logWhole >= 0)) return {};  // below γ as it is
  Eigen::VectorXd distance2(model.points.cols());
  squaredDistances({model.points.data(), static_cast<std::size_t>(model.points.rows()),
                    static_cast<std::size_t>(model.points.cols())},
                   point.z.data(), distance2.data());
  DegreeEstimate estimate;
  estimate.distance = std::numeric_limits<double>::infinity();
  if (distance2.size() > 0)
    estimate.distance = std::sqrt(distance2.minCoeff() + point.residual * point.residual);
  estimate.isOutside = !(estimate.distance <= model.reach + kSamePoint * (1 + point.z.norm()));
  const Output out = outputOf(model, distance2.cwiseSqrt(), deviation);
  if (!isProcess) {
    estimate.degree = rounded(out.y, 1);
    return estimate;
  }
  // N = ⌈ν⌉, so on average half a piece above ν.
  const double crossing = std::exp(out.y + point.logPieces);
  estimate.degree = rounded(crossing + 0.5, 2);
  estimate.deviation = crossing * out.deviation;
  return estimate;
}

DegreeValidity validityOf(const WeightField& weights, const std::shared_ptr<const Embedding>& embedding,
                          double gamma) {
  DegreeValidity valid;
  if (weights.tets) valid.tets = sharedDigest(valueType<TetMesh>(), weights.tets);
  if (embedding) valid.embedding = sharedDigest(valueType<Embedding>(), embedding);
  valid.material = weights.material;
  valid.gamma = gamma;
  valid.alpha = weights.alpha;
  valid.beta = weights.beta;
  return valid;
}

Result<void> checkValidity(const DegreeModel& model, const DegreeValidity& wanted) {
  const std::string different = differences(model.validFor, wanted);
  if (different.empty()) return {};
  return failure(
      "the model was made for something else; what differs: " + different,
      "wire a TrainDegree with the same body, embedding, material, γ, α and β, or leave `model` open",
      "model");
}

}  // namespace sherd
