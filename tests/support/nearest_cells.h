// Cells by nearest sites, for tests that say where sites and nodes are.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "types/partition.h"

namespace sherd::test {

/// `coordinates`: d × nodes; `sites`: d × N. Labels are the nearest sites, the lower index where two are
/// equally near.
inline Partition nearestCells(std::shared_ptr<const TetMesh> tets, Eigen::MatrixXd coordinates,
                              Eigen::MatrixXd sites, Embedding::Metric metric) {
  auto embedding = std::make_shared<Embedding>();
  embedding->tets = std::move(tets);
  embedding->metric = metric;
  embedding->coordinates = std::move(coordinates);
  const Eigen::MatrixXd& x = embedding->coordinates;
  embedding->diameter = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
  Partition cells;
  cells.sites = std::move(sites);
  for (Eigen::Index n = 0; n < x.cols(); ++n) {
    Eigen::Index best = 0;
    (cells.sites.colwise() - x.col(n)).colwise().squaredNorm().minCoeff(&best);
    cells.label.push_back(static_cast<Index>(best));
  }
  cells.embedding = std::move(embedding);
  return cells;
}

inline Eigen::MatrixXd columnsOf(const std::vector<Vec3>& points) {
  Eigen::MatrixXd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = points[i];
  return columns;
}

/// Voronoi cells in space itself.
inline Partition euclideanCells(std::shared_ptr<const TetMesh> tets, const std::vector<Vec3>& sites) {
  Eigen::MatrixXd nodes = columnsOf(tets->nodes);
  return nearestCells(std::move(tets), std::move(nodes), columnsOf(sites), Embedding::Metric::Euclidean);
}

}  // namespace sherd::test
