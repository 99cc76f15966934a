// From weights to the point that a model compares (learn_degree.h).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "types/degree_model.h"
#include "types/partition.h"

namespace sherd {

/// Number of logarithms that a process takes of the weights.
inline constexpr Eigen::Index kFeatures = 5;

/// Σ w ‖x̄ − c‖², J·m²: E_D of the whole body, c its centroid by volume. O(nodes · dimensions).
double wholeEnergy(const std::vector<double>& weight, const std::vector<double>& volume,
                   const Embedding& embedding);

/// The logarithms over γ of E_1, S, T, Z_3/5 and Z_1/3; weights that are not all zero.
Eigen::Matrix<double, kFeatures, 1> logFeatures(const std::vector<double>& weight,
                                                const std::vector<double>& volume, const Embedding& embedding,
                                                double gamma);

/// What the principal components are of: weights over `scale`, or over their sum where it is 0.
Eigen::VectorXd dividedWeights(const std::vector<double>& weight, double scale);

struct WeightPoint {
  Eigen::VectorXd z;
  double logWhole = 0;  ///< log(E_1 / γ), where the model has features; NaN where nothing weighs
  double residual =
      0;  ///< what of the weights lies outside of the basis, in units of distances between points
};
WeightPoint pointOf(const DegreeModel& model, const std::vector<double>& weight,
                    const std::vector<double>& volume, const Embedding& embedding);

}  // namespace sherd
