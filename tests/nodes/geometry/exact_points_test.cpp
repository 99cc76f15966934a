#include "geometry/exact_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"

namespace sherd {
namespace {

TEST(ExactPoints, OrientationOfGeneralPoints) {
  const std::vector<Vec3> p{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)};
  const ExactPoints points(p);
  EXPECT_EQ(points.orientation(0, 1, 2, 3), 1);
  EXPECT_EQ(points.orientation(0, 1, 2, 4), -1);
  EXPECT_EQ(points.side({0, 1, 2}, 3), 1);
}

TEST(ExactPoints, NeverZeroAndAntisymmetricOnDegenerateInput) {
  // All on a line, all equal, all in a plane: every sign is decided, and flips with every exchange.
  std::vector<std::vector<Vec3>> inputs;
  inputs.push_back(std::vector<Vec3>(6, Vec3(1, 2, 3)));
  inputs.emplace_back();
  for (int i = 0; i < 6; ++i) inputs.back().emplace_back(0.1 * i, 0.2 * i, 0.3 * i);
  inputs.emplace_back();
  for (int i = 0; i < 6; ++i) inputs.back().emplace_back(i % 3, i / 3, 0.7);
  for (const auto& input : inputs) {
    const ExactPoints points(input);
    for (Index a = 0; a < 6; ++a)
      for (Index b = 0; b < 6; ++b)
        for (Index c = 0; c < 6; ++c)
          for (Index d = 0; d < 6; ++d) {
            if (a == b || a == c || a == d || b == c || b == d || c == d) continue;
            const int sign = points.orientation(a, b, c, d);
            EXPECT_EQ(std::abs(sign), 1);
            EXPECT_EQ(points.orientation(b, a, c, d), -sign);
            EXPECT_EQ(points.orientation(a, c, b, d), -sign);
            EXPECT_EQ(points.orientation(a, b, d, c), -sign);
          }
  }
}

TEST(ExactPoints, ConsistentWithOneGeneralPosition) {
  // Five points in general position have no impossible set of signs: for the tetrahedra left by dropping each
  // point in turn, the alternating signs can't all agree to make a point lie beyond every face
  // (Grassmann-Plücker for rank 4: here checked in the plane-sharing case, where all answers come from the
  // displacement).
  std::vector<Vec3> p;
  for (int i = 0; i < 6; ++i) p.emplace_back(i % 2, (i / 2) % 2, i == 5 ? 0.5 : 0.0);
  const ExactPoints points(p);
  // Rank-4 chirotope, three-term relation: {ab·cd − ac·bd + ad·bc} must be able to vanish.
  auto chi = [&](Index a, Index b, Index c, Index d) { return points.orientation(a, b, c, d); };
  for (Index x = 0; x < 6; ++x)
    for (Index y = x + 1; y < 6; ++y) {
      std::vector<Index> r;
      for (Index i = 0; i < 6; ++i)
        if (i != x && i != y) r.push_back(i);
      const int s1 = chi(x, y, r[0], r[1]) * chi(x, y, r[2], r[3]),
                s2 = -chi(x, y, r[0], r[2]) * chi(x, y, r[1], r[3]),
                s3 = chi(x, y, r[0], r[3]) * chi(x, y, r[1], r[2]);
      EXPECT_FALSE(s1 == s2 && s2 == s3) << x << " " << y;
    }
}

TEST(ExactPoints, CrossingsOfAClosedSurfaceAreEvenEvenThroughVerticesAndEdges) {
  // An octahedron, probed along lines through its corners and edges: what goes in comes out.
  std::vector<Vec3> p{Vec3(1, 0, 0),   Vec3(-1, 0, 0), Vec3(0, 1, 0),  Vec3(0, -1, 0), Vec3(0, 0, 1),
                      Vec3(0, 0, -1),  Vec3(-3, 0, 0), Vec3(3, 0, 0),  Vec3(0, -2, 0), Vec3(0, 2, 0),
                      Vec3(-1, -1, 0), Vec3(1, 1, 0),  Vec3(-2, 1, 0), Vec3(2, 1, 0)};
  const std::vector<Triangle> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  const ExactPoints points(p);
  for (Index from = 6; from < 14; from += 2) {
    int crossings = 0, balance = 0;
    for (const Triangle& t : faces)
      if (points.crosses(from, from + 1, t)) {
        ++crossings;
        balance += points.side(t, from);
      }
    EXPECT_EQ(crossings % 2, 0) << from;
    EXPECT_EQ(balance, 0) << from;
  }
}

TEST(ExactPoints, CrossingsAreOrderedExactly) {
  // Planes one unit in the last place apart.
  const double x = 0.5, next = std::nextafter(x, 1.0);
  std::vector<Vec3> p{Vec3(0, 0, 0), Vec3(1, 0, 0)};
  for (const double at : {x, next, x}) {
    p.emplace_back(at, -1, -1);
    p.emplace_back(at, 2, -1);
    p.emplace_back(at, -1, 2);
  }
  const ExactPoints points(p);
  const Triangle first{2, 3, 4}, second{5, 6, 7}, again{8, 9, 10};
  EXPECT_EQ(points.compareCrossings(0, 1, first, second), -1);
  EXPECT_EQ(points.compareCrossings(0, 1, second, first), 1);
  EXPECT_EQ(points.compareCrossings(1, 0, first, second), 1);
  EXPECT_EQ(points.compareCrossings(0, 1, first, again), 0);
}

TEST(ExactPoints, ABodyThatTouchesAnotherIsMovedAsAWhole) {
  // A moved square's corners in the plane x = 0 of a fixed triangle: all on the side that the move leads to.
  std::vector<Vec3> p{Vec3(0, 0, 0),   Vec3(0, 1, 0),  Vec3(0, 1, 1), Vec3(0, 0, 1),
                      Vec3(0, -5, -5), Vec3(0, 5, -5), Vec3(0, 0, 7)};
  const ExactPoints points(p, 4);
  const Triangle fixed{4, 5, 6};
  for (Index i = 0; i < 4; ++i) EXPECT_EQ(points.side(fixed, i), 1);
  // The very same seen from the fixed body.
  for (Index i = 4; i < 7; ++i) EXPECT_EQ(points.side({0, 1, 2}, i), -1);
}

TEST(ExactPoints, CrossingsAtOnePointAreOrderedByTheMove) {
  // A segment along x through the common edge of two fixed planes, x = y and x = −y; the move is along y,
  // too, less.
  std::vector<Vec3> p{Vec3(-1, 0, 0), Vec3(1, 0, 0),   Vec3(-3, -3, -3), Vec3(3, 3, -3),
                      Vec3(0, 0, 5),  Vec3(-3, 3, -3), Vec3(3, -3, -3),  Vec3(0, 0, 5)};
  const ExactPoints points(p, 2), still(p);
  EXPECT_EQ(still.compareCrossings(0, 1, {2, 3, 4}, {5, 6, 7}), 0);
  // At y = δ > 0 the segment meets x = −y first.
  EXPECT_EQ(points.compareCrossings(0, 1, {2, 3, 4}, {5, 6, 7}), 1);
  EXPECT_EQ(points.compareCrossings(0, 1, {5, 6, 7}, {2, 3, 4}), -1);
  EXPECT_EQ(points.compareCrossings(1, 0, {2, 3, 4}, {5, 6, 7}), -1);
}

TEST(ExactPoints, CrossingPointKeepsSharedCoordinatesAndDoesNotDependOnDirection) {
  Rng rng(7);
  for (int i = 0; i < 200; ++i) {
    auto coordinate = [&] { return rng.uniform() * 2 - 1; };
    const double plane = 0.1 * coordinate();
    std::vector<Vec3> p{Vec3(coordinate() * 0.1, coordinate() * 0.1, -1),
                        Vec3(coordinate() * 0.1, coordinate() * 0.1, 1), Vec3(-2, -2, plane),
                        Vec3(2, -2, plane), Vec3(0, 3, plane)};
    const ExactPoints points(p);
    ASSERT_TRUE(points.crosses(0, 1, {2, 3, 4}));
    const Vec3 at = points.crossing(0, 1, {2, 3, 4});
    EXPECT_EQ(at, points.crossing(1, 0, {2, 3, 4}));
    EXPECT_EQ(at.z(), plane);
    const Vec3 expected = p[0] + (plane + 1) / 2 * (p[1] - p[0]);
    EXPECT_LT((at - expected).norm(), 1e-14);
  }
}

/// Rounded heights over the plane are noise for a segment that lies in it: the crossing's place isn't.
TEST(ExactPoints, CrossingOfASegmentAllButInThePlaneLiesInTheTriangle) {
  Rng rng(11);
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto vec = [&] { return Vec3(rng.uniform(), rng.uniform(), rng.uniform()); };
    const Vec3 a = vec(), b = vec(), c = vec();
    const auto inPlane = [&](double u, double v) { return Vec3(a + u * (b - a) + v * (c - a)); };
    const std::vector<Vec3> p{inPlane(-9 * rng.uniform(), 9 * rng.uniform()),
                              inPlane(9 * rng.uniform(), -9 * rng.uniform()), a, b, c};
    const ExactPoints points(p);
    if (!points.crosses(0, 1, {2, 3, 4})) continue;
    ++found;
    const Vec3 at = points.crossing(0, 1, {2, 3, 4});
    const Vec3 normal = (b - a).cross(c - a);
    const double area2 = normal.squaredNorm(), size = (p[1] - p[0]).norm();
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      EXPECT_GT((to - from).cross(at - from).dot(normal),
                -1e-12 * size * (to - from).norm() * std::sqrt(area2))
          << i;
  }
  EXPECT_GT(found, 100);
}

TEST(ExactPoints, CrossingOfATriangleOnALineLiesOnIt) {
  // Along the x axis, degenerate; segments through it, touching its end, and along it.
  const std::vector<Vec3> p{Vec3(1, 0, 0),   Vec3(3, 0, 0), Vec3(2, 0, 0),  Vec3(1.5, -1, 0),
                            Vec3(1.5, 3, 0), Vec3(0, 0, 0), Vec3(2.5, 0, 0)};
  const ExactPoints points(p);
  EXPECT_EQ(points.crossing(3, 4, {0, 1, 2}), Vec3(1.5, 0, 0));
  EXPECT_EQ(points.crossing(4, 3, {2, 0, 1}), Vec3(1.5, 0, 0));
  const Vec3 along = points.crossing(5, 6, {0, 1, 2});
  EXPECT_GE(along.x(), 1);
  EXPECT_LE(along.x(), 2.5);
}

}  // namespace
}  // namespace sherd
