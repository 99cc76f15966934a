// From weights to the point that a model compares (learn_degree.h).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "types/degree_model.h"
#include "types/partition.h"

namespace sherd {

/// Number of logarithms that a process takes of the weights.
inline constexpr Eigen::Index kFeatures = 6;

/// Σ w ‖x̄ − c‖², J·m²: E_D of the whole body, c its centroid by volume. O(nodes · dimensions).
double wholeEnergy(const std::vector<double>& weight, const std::vector<double>& volume,
                   const Embedding& embedding);

struct LogFeatures {
  /// ν_t, ν_t for 4 γ, E_1, S, Z_3/4 and Z_1/2, the last four over γ.
  Eigen::Matrix<double, kFeatures, 1> value;
  double pieces() const { return value[0]; }  ///< log ν_t
  double whole() const { return value[2]; }   ///< log(E_1 / γ); NaN or −∞ where nothing weighs
};
/// `order`: of splitOrder.
LogFeatures logFeatures(const std::vector<Index>& order, const std::vector<double>& weight,
                        const std::vector<double>& volume, const Embedding& embedding, double gamma);

/// What the principal components are of: weights over `scale`, or over their sum where it is 0.
Eigen::VectorXd dividedWeights(const std::vector<double>& weight, double scale);

struct WeightPoint {
  Eigen::VectorXd z;
  double logPieces = 0;  ///< log ν_t, where the model has features
  double logWhole = 0;   ///< log(E_1 / γ), where the model has features; NaN or −∞ where nothing weighs
  double residual =
      0;  ///< what of the weights lies outside of the basis, in units of distances between points
};
WeightPoint pointOf(const DegreeModel& model, const std::vector<double>& weight,
                    const std::vector<double>& volume, const Embedding& embedding);

}  // namespace sherd
