// A small body to train on.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "support/tet_families.h"
#include "train_degree/train_degree.h"

namespace sherd {

struct Body {
  std::shared_ptr<const TetMesh> tets;
  std::shared_ptr<const Embedding> embedding;
};

inline Body bodyOf(TetMesh mesh) {
  Body body;
  body.tets = std::make_shared<const TetMesh>(std::move(mesh));
  auto e = std::make_shared<Embedding>();
  e->tets = body.tets;
  const auto& nodes = body.tets->nodes;
  e->coordinates.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n) e->coordinates.col(static_cast<Eigen::Index>(n)) = nodes[n];
  e->diameter = (e->coordinates.rowwise().maxCoeff() - e->coordinates.rowwise().minCoeff()).norm();
  body.embedding = e;
  return body;
}

/// A block of stoneware, 12 × 8 × 20 cm.
inline Body block() { return bodyOf(families::box(6, 4, 10, Vec3(0.12, 0.08, 0.2))); }

inline TrainDegreeParams small() {
  TrainDegreeParams p;
  p.heights = {0.5, 1, 2};
  p.orientations = 8;
  p.repeats = 2;
  p.gamma = 2e-3;
  return p;
}

template <class T>
T valueOf(Result<T> result) {
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(result).value();
}

inline DropExamples drops(const Body& body, const TrainDegreeParams& params, Memo* memo = nullptr) {
  return valueOf(dropExamples(body.tets, body.embedding, nullptr, params, Exec{}, memo));
}

/// Equal to the bit in all that is learned from.
inline void expectSame(const DropExamples& a, const DropExamples& b) {
  ASSERT_EQ(a.drops.size(), b.drops.size());
  EXPECT_EQ(a.volume, b.volume);
  for (std::size_t i = 0; i < a.drops.size(); ++i) {
    EXPECT_EQ(a.drops[i].strainEnergy, b.drops[i].strainEnergy) << i;
    EXPECT_EQ(a.drops[i].wholeEnergy, b.drops[i].wholeEnergy) << i;
    EXPECT_EQ(a.drops[i].example.weight, b.drops[i].example.weight) << i;
    EXPECT_EQ(a.drops[i].example.degree, b.drops[i].example.degree) << i;
    EXPECT_EQ(a.drops[i].example.crossing, b.drops[i].example.crossing) << i;
    EXPECT_EQ(a.drops[i].example.group, b.drops[i].example.group) << i;
  }
}

}  // namespace sherd
