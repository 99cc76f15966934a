// Attributes at the corners of cut triangles.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "types/fragments.h"

namespace sherd {
namespace {

/// One piece of one triangle that is cut out of another with these weights.
struct Cut {
  Fragments f;
  Piece piece;
  explicit Cut(const CornerWeights& weights) {
    f.cutCorners.push_back({weights, weights, weights});
    piece.surfaceSource = {0};
    piece.surfaceCut = {0};
  }
};

TEST(CornerAttribute, LiesBetweenThoseOfTheCornersInSpiteOfRounding) {
  Rng rng(3);
  std::size_t rounded = 0;
  for (int i = 0; i < 2000; ++i) {
    CornerWeights w(rng.uniform(), rng.uniform(), rng.uniform());
    w /= w.sum();
    const Cut cut(w);
    const double value = rng.uniform();
    const std::vector<Vec4> equal(3, Vec4(1, value, 0, -value));
    EXPECT_EQ(cornerAttribute(cut.f, cut.piece, 0, 0, equal), equal[0]);
    rounded += (w[0] * equal[0] + w[1] * equal[1] + w[2] * equal[2]).y() != value;
    const std::vector<Vec2> ends = {Vec2(0, 1), Vec2(1, 1), Vec2(0.5, 0)};
    const Vec2 between = cornerAttribute(cut.f, cut.piece, 0, 0, ends);
    EXPECT_TRUE(between.minCoeff() >= 0 && between.maxCoeff() <= 1);
    EXPECT_NEAR(between.x(), w[1] + 0.5 * w[2], 1e-15);
    EXPECT_NEAR(between.y(), w[0] + w[1], 1e-15);
  }
  EXPECT_GT(rounded, 100u);  // or the test would say nothing
}

TEST(CornerAttribute, OfAnUncutTriangleIsTheVeryOne) {
  Cut cut(CornerWeights(2, -1, 0));
  cut.piece.surfaceCut = {-1};
  const std::vector<Vec2> uvs = {Vec2(0, 0.1), Vec2(3, 4), Vec2(-5, 1e300)};
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(cornerAttribute(cut.f, cut.piece, 0, c, uvs), uvs[c]);
}

}  // namespace
}  // namespace sherd
