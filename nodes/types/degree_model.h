// What was learned of a body's fracture degree from examples, and what it is valid for.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/material.h"
#include "types/tri_mesh.h"

namespace sherd {

/// A degree is a function of the weights, the metric and γ: all that these were made of.
struct DegreeValidity {
  Digest tets{}, embedding{};  ///< content; a renumbered mesh is another one
  Material material;
  double gamma = 0;  ///< J·m²
  double alpha = 1;
  Digest beta{};  ///< WeightField::beta
};

enum class DegreeMethod { Process, Network, Exact };

/// How well the model foretells examples that it was fitted without. Degrees are pieces.
struct DegreeErrors {
  double examples = 0;      ///< searches that are compared
  double meanDegree = 0;    ///< of the searches
  double meanAbsolute = 0;  ///< of the difference between foretold and searched
  double rSquared = 0;      ///< 1 − Σ (foretold − searched)² / Σ (searched − mean)²
  double noise =
      0;  ///< mean absolute difference of a search from the mean over seeds: what nobody can foretell
};

/// A point z of the weights w, and a degree of the point (learn_degree/learn_degree.h):
///   z = [ factor · (feature(w) − mean) …, basis · (w / scale − mean) ],
///   y = bias + Σ_i coefficient_i φ(‖z − z_i‖).
struct DegreeModel {
  static constexpr const char* typeName = "DegreeModel";
  static constexpr int archiveVersion = 2;

  DegreeValidity validFor;
  DegreeMethod method = DegreeMethod::Process;

  double scale = 0;           ///< J: what weights are divided by; 0: their sum
  std::vector<double> mean;   ///< per node, of the divided weights; empty where there is no basis
  Eigen::MatrixXd basis;      ///< components × nodes
  double residualFactor = 0;  ///< what the part of w / scale − mean outside the basis counts in distances
  Eigen::MatrixXd featureScale;  ///< features × 2: mean and factor
  std::vector<Index> order;      ///< the nodes as the tree has them that a process compares with; empty: none

  Eigen::MatrixXd points;           ///< dimensions × examples: z_i of the distinct ones
  std::vector<Index> centres;       ///< which of them have a coefficient
  std::vector<double> coefficient;  ///< per centre
  double bias = 0;
  Eigen::MatrixXd whitening;  ///< centres × centres, upper: L⁻ᵀ with L Lᵀ = K + noise of a process
  double variance = 0;        ///< of a process, of y
  double noise = 0;           ///< of a process: of one search, in variances

  double reach = 0;  ///< a point farther from all examples than this lies outside of what was learned
  DegreeErrors errors;
};

void hashValue(Hasher& hasher, const DegreeModel& model);
std::size_t byteSize(const DegreeModel& model);
void saveValue(ArchiveWriter& to, const DegreeModel& model);
std::optional<DegreeModel> loadValue(ArchiveReader& from, std::type_identity<DegreeModel>);

/// What of `other` is not as in `valid`, with both: "γ (1e-4 J·m² there, 2e-4 J·m² here)"; empty where all
/// is.
std::string differences(const DegreeValidity& valid, const DegreeValidity& other);

}  // namespace sherd
