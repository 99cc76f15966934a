// The metric, the sites and the cells: what PredictDegree and CVD work in and hand on.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/material.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Coordinates in which straight distances are the body's distances (design section 4, point 7).
struct Embedding {
  static constexpr const char* typeName = "Embedding";
  static constexpr int archiveVersion = 1;
  enum class Metric { Euclidean, Interior };
  std::shared_ptr<const TetMesh> tets;
  Metric metric = Metric::Euclidean;
  Eigen::MatrixXd coordinates;  ///< d × nodes, m; column n is x̄_n
  double diameter = 0;  ///< m, diagonal of the coordinates' bounding box: what tolerances are relative to
};

/// Sites p̄_j and what the search for them found.
struct Sites {
  static constexpr const char* typeName = "Sites";
  static constexpr int archiveVersion = 2;
  Eigen::MatrixXd positions;  ///< d × N, m, in the embedding; N ≥ 1
  double energy = 0;  ///< J·m², E_D of these sites; 0 of pinned ones that no energy was asked for yet
  double gamma = 0;   ///< J·m², the threshold asked for; decided nothing where the degree was given
  bool degreeGiven = false;  ///< N was asked for, not found by γ
  std::int64_t pinned = 0;   ///< the first so many were put where they are by hand, and stay there; in [0, N]
};

/// Every node's nearest site.
struct Partition {
  static constexpr const char* typeName = "Cells";
  static constexpr int archiveVersion = 1;
  std::shared_ptr<const Embedding> embedding;
  Material material;
  Eigen::MatrixXd sites;     ///< d × N, m
  std::vector<Index> label;  ///< per node, in [0, N)
  double energy = 0;         ///< J·m², E_D
  double gamma = 0;          ///< J·m²; decided nothing where the degree was given, 0 where there was none
  bool degreeGiven = false;  ///< N was asked for, not found by γ
  int iterations = 0;        ///< Lloyd passes made
  bool converged = false;

  std::size_t siteCount() const { return static_cast<std::size_t>(sites.cols()); }
};

void hashValue(Hasher& hasher, const Embedding& embedding);
void hashValue(Hasher& hasher, const Sites& sites);
void hashValue(Hasher& hasher, const Partition& partition);
std::size_t byteSize(const Embedding& embedding);
std::size_t byteSize(const Sites& sites);
std::size_t byteSize(const Partition& partition);
void saveValue(ArchiveWriter& to, const Embedding& embedding);
std::optional<Embedding> loadValue(ArchiveReader& from, std::type_identity<Embedding>);
void saveValue(ArchiveWriter& to, const Sites& sites);
std::optional<Sites> loadValue(ArchiveReader& from, std::type_identity<Sites>);
void saveValue(ArchiveWriter& to, const Partition& partition);
std::optional<Partition> loadValue(ArchiveReader& from, std::type_identity<Partition>);

}  // namespace sherd
