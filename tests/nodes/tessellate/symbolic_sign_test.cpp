#include "tessellate/symbolic_sign.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace sherd {
namespace {

const std::array<Vec3, 4> kTet{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

/// g of two sites at the four nodes.
struct Pair {
  std::array<double, 4> plus{}, minus{};
  AffineFunction function(Index plusRank, Index minusRank) const {
    AffineFunction f;
    f.plus = plusRank;
    f.minus = minusRank;
    for (std::size_t i = 0; i < 4; ++i) f.plusAt[i] = &plus[i], f.minusAt[i] = &minus[i];
    return f;
  }
};

AffineFunction corner(int i) {
  AffineFunction f;
  f.corner = i;
  return f;
}

TEST(SymbolicSign, BarycentricCoordinatesOfAPoint) {
  const Vec3 inside(0.1, 0.2, 0.3), beyond(1, 1, 1);
  for (int i = 0; i < 4; ++i) {
    const AffineFunction f = corner(i);
    EXPECT_EQ(vertexDeterminantSign(kTet, std::span(&inside, 1), std::span(&f, 1)), 1);
    EXPECT_EQ(vertexDeterminantSign(kTet, std::span(&beyond, 1), std::span(&f, 1)), i == 0 ? -1 : 1);
  }
}

TEST(SymbolicSign, APointOnAFaceIsMovedAlongX) {
  // On the slanted face a step along x leads out of the tetrahedron; on x = 0, into it.
  const AffineFunction slanted = corner(0), left = corner(1);
  const Vec3 onSlanted(0.25, 0.25, 0.5), onLeft(0, 0.25, 0.5);
  EXPECT_EQ(vertexDeterminantSign(kTet, std::span(&onSlanted, 1), std::span(&slanted, 1)), -1);
  EXPECT_EQ(vertexDeterminantSign(kTet, std::span(&onLeft, 1), std::span(&left, 1)), 1);
}

TEST(SymbolicSign, OfTwoEqualSitesTheOneOfLowerRankIsNearer) {
  const Pair p{{1, 2, 3, 4}, {1, 2, 3, 4}};
  const Vec3 v(0.2, 0.2, 0.2);
  const AffineFunction f = p.function(5, 2), g = p.function(2, 5);
  EXPECT_EQ(vertexDeterminantSign(kTet, std::span(&v, 1), std::span(&f, 1)), 1);  // g_5 − g_2 > 0
  EXPECT_EQ(vertexDeterminantSign(kTet, std::span(&v, 1), std::span(&g, 1)), -1);
  const int node = 1;
  EXPECT_EQ(nodeDeterminantSign(std::span(&node, 1), std::span(&f, 1)), 1);
}

TEST(SymbolicSign, SwappingPointsOrFunctionsTurnsTheSign) {
  // Integer coordinates, so that many determinants vanish in the given doubles.
  Rng rng(5);
  const auto integer = [&] { return std::floor(rng.uniform() * 4) - 1; };
  int zeros = 0;
  for (int round = 0; round < 300; ++round) {
    std::array<Vec3, 3> v;
    for (Vec3& p : v) p = Vec3(integer(), integer(), integer());
    Pair p, q;
    for (std::size_t i = 0; i < 4; ++i) p.plus[i] = integer(), q.plus[i] = integer();
    std::array<AffineFunction, 3> f{p.function(1, 0), q.function(2, 0), corner(round % 4)};
    const int sign = vertexDeterminantSign(kTet, v, f);
    zeros += sign == 0;
    std::swap(v[0], v[2]);
    EXPECT_EQ(vertexDeterminantSign(kTet, v, f), -sign);
    std::swap(f[0], f[1]);
    EXPECT_EQ(vertexDeterminantSign(kTet, v, f), sign);
  }
  EXPECT_LT(zeros, 60);  // three corners on one line
}

TEST(SymbolicSign, TheSmallestMoveDecides) {
  // An edge in the plane y = 0 and one of its corners on z = 0: moved up, both are on the inner side.
  const AffineFunction y = corner(2);
  for (const Vec3& p : {Vec3(0.2, 0, 0.1), Vec3(0.7, 0, 0)})
    EXPECT_EQ(vertexDeterminantSign(kTet, std::span(&p, 1), std::span(&y, 1)), 1);
}

TEST(SymbolicSign, WeightsOfAnOrdinaryPoint) {
  const Pair p{{1, -3, 0, 0}, {}};
  const AffineFunction f = p.function(1, 0);
  const std::array<int, 2> nodes{0, 1};
  const auto w = nodeWeights(nodes, std::span(&f, 1));
  EXPECT_DOUBLE_EQ(w[0], 0.75);
  EXPECT_DOUBLE_EQ(w[1], 0.25);
  // On the surface: x = 1/4 in the unit tetrahedron, on an edge along x.
  const std::array<Vec3, 2> edge{Vec3(-1, 0.1, 0.1), Vec3(1, 0.1, 0.1)};
  const Pair q{{-0.25, 0.75, -0.25, -0.25}, {}};
  const AffineFunction g = q.function(1, 0);
  const auto u = vertexWeights(kTet, edge, std::span(&g, 1));
  EXPECT_DOUBLE_EQ(u[0], 0.375);
  EXPECT_DOUBLE_EQ(u[1], 0.625);
}

TEST(SymbolicSign, OrderAlongAnEdgeAndAlongALine) {
  const Pair near{{-0.25, 0.75, -0.25, -0.25}, {}}, far{{-0.5, 0.5, -0.5, -0.5}, {}};  // x = 1/4 and x = 1/2
  const std::array<Vec3, 2> edge{Vec3(0, 0.1, 0.1), Vec3(1, 0.1, 0.1)};
  const AffineFunction f = near.function(1, 0), g = far.function(1, 0);
  EXPECT_EQ(compareAlongEdge(edge, kTet, f, kTet, g), -1);
  EXPECT_EQ(compareAlongEdge(edge, kTet, g, kTet, f), 1);
  EXPECT_EQ(compareAlongEdge(edge, kTet, f, kTet, f), 0);

  // The line x = 1/4, y = 0 through two horizontal triangles that face upward.
  const auto level = [](double z) {
    return std::array<Vec3, 3>{Vec3(-1, -1, z), Vec3(2, -1, z), Vec3(0, 3, z)};
  };
  const AffineFunction y = corner(2);
  EXPECT_EQ(sideOfMeeting(kTet, y, f, level(0.2), level(0.7)), -1);
  EXPECT_EQ(sideOfMeeting(kTet, y, f, level(0.7), level(0.2)), 1);
  EXPECT_EQ(sideOfMeeting(kTet, f, y, level(0.2), level(0.7)), -1);
}

}  // namespace
}  // namespace sherd
