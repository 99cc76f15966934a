#include "tessellate/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "base/rng.h"

namespace sherd {
namespace {

using Loop = std::vector<Index>;

double area2(const std::vector<PlanarCorner>& c, const PolygonTriangulation& t) {
  double sum = 0;
  for (const Triangle& f : t.triangles) sum += loopArea2(c, {f[0], f[1], f[2]});
  return sum;
}

/// Every loop edge once in its direction, every other edge once in each.
void expectBoundary(const std::vector<Loop>& loops, const PolygonTriangulation& t) {
  std::map<std::pair<Index, Index>, int> edges;
  for (const Triangle& f : t.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{f[i], f[(i + 1) % 3]}], --edges[{f[(i + 1) % 3], f[i]}];
  for (const Loop& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      --edges[{loop[i], loop[(i + 1) % loop.size()]}], ++edges[{loop[(i + 1) % loop.size()], loop[i]}];
  for (const auto& [edge, balance] : edges) EXPECT_EQ(balance, 0) << edge.first << "-" << edge.second;
}

std::vector<PlanarCorner> cornersOf(const std::vector<Vec2>& points) {
  std::vector<PlanarCorner> corners;
  for (const Vec2& p : points) corners.push_back({p, 0});
  return corners;
}

TEST(Polygon, TriangleIsPassedThrough) {
  const auto c = cornersOf({Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)});
  const auto t = PolygonTriangulator().triangulate(c, std::vector<Loop>{{0, 1, 2}});
  ASSERT_EQ(t.triangles.size(), 1u);
  EXPECT_EQ(t.triangles[0], (Triangle{0, 1, 2}));
}

TEST(Polygon, SquareTakesTheBetterDiagonal) {
  const auto c = cornersOf({Vec2(0, 0), Vec2(2, 0.2), Vec2(2.2, 1), Vec2(0, 1)});
  const auto t = PolygonTriangulator().triangulate(c, std::vector<Loop>{{0, 1, 2, 3}});
  EXPECT_EQ(t.triangles.size(), 2u);
  EXPECT_EQ(t.forced, 0);
  expectBoundary({{0, 1, 2, 3}}, t);
}

TEST(Polygon, CornersOnALineMakeNoFlatTriangles) {
  // Four corners on the bottom line, two of them rounded to either side of it.
  auto c = cornersOf({Vec2(0, 0), Vec2(1, 1e-17), Vec2(2, -1e-17), Vec2(3, 0), Vec2(1.5, 2)});
  for (std::size_t i = 0; i < 4; ++i) c[i].lines = 1;
  const std::vector<Loop> loops{{0, 1, 2, 3, 4}};
  const auto t = PolygonTriangulator().triangulate(c, loops);
  EXPECT_EQ(t.forced, 0);
  expectBoundary(loops, t);
  for (const Triangle& f : t.triangles) EXPECT_GT(loopArea2(c, {f[0], f[1], f[2]}), 0.1);
}

TEST(Polygon, HolesAndIslands) {
  std::vector<Vec2> p{Vec2(0, 0), Vec2(10, 0), Vec2(10, 10), Vec2(0, 10)};
  std::vector<Loop> loops{{0, 1, 2, 3}};
  double expected = 200;
  for (const Vec2& centre : {Vec2(3, 3), Vec2(7, 3), Vec2(5, 7)}) {
    Loop hole;
    for (int i = 0; i < 8; ++i) {
      hole.insert(hole.begin(), static_cast<Index>(p.size()));
      p.push_back(centre + Vec2(std::cos(i * std::numbers::pi / 4), std::sin(i * std::numbers::pi / 4)));
    }
    const auto c = cornersOf(p);
    expected += loopArea2(c, hole);  // negative
    loops.push_back(hole);
  }
  loops.push_back(
      {static_cast<Index>(p.size()), static_cast<Index>(p.size()) + 1, static_cast<Index>(p.size()) + 2});
  for (const Vec2& q : {Vec2(2.8, 2.8), Vec2(3.2, 2.8), Vec2(3, 3.2)})
    p.push_back(q);  // an island in the first hole
  expected += 0.16;
  const auto c = cornersOf(p);
  const auto t = PolygonTriangulator().triangulate(c, loops);
  EXPECT_EQ(t.forced, 0);
  EXPECT_NEAR(area2(c, t), expected, 1e-9);
  expectBoundary(loops, t);
}

TEST(Polygon, RandomStarsAreCoveredOnce) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Rng rng(seed);
    const int n = 4 + static_cast<int>(rng.below(60));
    std::vector<Vec2> p;
    Loop loop;
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n, r = 0.2 + rng.uniform();
      p.emplace_back(r * std::cos(a), r * std::sin(a));
      loop.push_back(i);
    }
    const auto c = cornersOf(p);
    const auto t = PolygonTriangulator().triangulate(c, std::vector<Loop>{loop});
    EXPECT_EQ(t.forced, 0) << seed;
    EXPECT_EQ(t.triangles.size(), static_cast<std::size_t>(n) - 2);
    EXPECT_NEAR(area2(c, t), loopArea2(c, loop), 1e-12);
    for (const Triangle& f : t.triangles) EXPECT_GT(loopArea2(c, {f[0], f[1], f[2]}), 0);
    expectBoundary({loop}, t);
  }
}

TEST(Polygon, NonsenseCoordinatesStillClose) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Rng rng(seed, 1);
    std::vector<Vec2> p;
    Loop loop;
    for (int i = 0; i < 12; ++i) {
      p.emplace_back(rng.uniform(), seed % 3 == 0 ? 0.0 : rng.uniform());
      loop.push_back(i);
    }
    const auto t = PolygonTriangulator().triangulate(cornersOf(p), std::vector<Loop>{loop});
    EXPECT_EQ(t.triangles.size(), 10u);
    expectBoundary({loop}, t);
  }
}

}  // namespace
}  // namespace sherd
