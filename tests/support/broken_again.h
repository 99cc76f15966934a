// Breaking a body, and its pieces again, by cells that depend on shape alone: every node weighs what it
// holds.
#pragma once

#include <memory>

#include "cvd/cvd.h"
#include "predict_degree/predict_degree.h"
#include "tessellate/tessellate.h"
#include "tetrahedralize/tetrahedralize.h"
#include "types/fragments.h"

namespace sherd::test {

struct BreakParams {
  int tets = 300;
  int degree = 4;
  std::int64_t seed = 1;
};

/// The body in cells of the Euclidean metric.
inline Result<Fragments> breakBody(std::shared_ptr<const TetMesh> tets, const BreakParams& params) {
  auto embedding = std::make_shared<Embedding>();
  embedding->tets = tets;
  embedding->coordinates.resize(3, static_cast<Eigen::Index>(tets->nodes.size()));
  for (std::size_t n = 0; n < tets->nodes.size(); ++n)
    embedding->coordinates.col(static_cast<Eigen::Index>(n)) = tets->nodes[n];
  embedding->diameter = boxOf(tets->nodes).diagonal();
  WeightField weights{tets, {}, lumpedVolumes(*tets), lumpedVolumes(*tets)};
  PredictDegreeParams search;
  search.degree = params.degree;
  search.seed = params.seed;
  SHERD_ASSIGN(const Sites sites, predictDegree(weights, *embedding, search, Exec{}));
  SHERD_ASSIGN(const Partition cells, cvd(embedding, weights, &sites, {}, Exec{}));
  return tessellate(cells, {}, Exec{});
}

inline Result<Fragments> breakBody(std::shared_ptr<const TriMesh> surface, const BreakParams& params) {
  SHERD_ASSIGN(TetMesh tets, tetrahedralize(std::move(surface), {.tets = params.tets}, Exec{}));
  return breakBody(std::make_shared<const TetMesh>(std::move(tets)), params);
}

}  // namespace sherd::test
