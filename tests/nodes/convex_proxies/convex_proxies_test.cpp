#include "convex_proxies/convex_proxies.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "convex_proxies/overlaps.h"
#include "nodes/convex_proxies/solids.h"
#include "support/said.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

Proxies proxiesOf(const Fragments& f, const ConvexProxiesParams& params) {
  const auto proxies = convexProxies(f, params, Exec{});
  EXPECT_TRUE(proxies.ok()) << (proxies.ok() ? "" : proxies.error().text());
  return proxies.ok() ? *proxies : Proxies{};
}

PieceProxy proxyOf(TriMesh mesh, const ConvexProxiesParams& params) {
  Proxies proxies = proxiesOf(test::whole(std::move(mesh)), params);
  return proxies.pieces.empty() ? PieceProxy{} : proxies.pieces.front();
}

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
Point point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Vertices of `points` that lie outside of the hull, exactly.
std::size_t outside(const ConvexHull& hull, const std::vector<Vec3>& points) {
  std::size_t count = 0;
  for (const Vec3& p : points)
    count += std::any_of(hull.triangles.begin(), hull.triangles.end(), [&](const Triangle& t) {
      return CGAL::orientation(point(hull.positions[at(t[0])]), point(hull.positions[at(t[1])]),
                               point(hull.positions[at(t[2])]), point(p)) == CGAL::POSITIVE;
    });
  return count;
}

/// How far a point lies outside of the nearest hull, m.
double distanceTo(const std::vector<ConvexHull>& hulls, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const ConvexHull& hull : hulls) {
    double farthest = -std::numeric_limits<double>::infinity();
    for (const Triangle& t : hull.triangles) {
      const Vec3& a = hull.positions[at(t[0])];
      const Vec3 n = (hull.positions[at(t[1])] - a).cross(hull.positions[at(t[2])] - a);
      if (n.norm() > 1e-9) farthest = std::max(farthest, n.normalized().dot(p - a));
    }
    best = std::min(best, farthest);
  }
  return best;
}

/// A sphere with random bumps and dents.
TriMesh boulder(std::uint64_t seed) {
  TriMesh mesh = families::sphereSurface(Vec3::Zero(), 1, 16, 9);
  Rng rng(seed);
  for (Vec3& p : mesh.positions) p *= 0.5 + rng.uniform();
  return mesh;
}

TEST(ConvexProxies, ATetrahedronAndACubeAreTheirOwnHulls) {
  TriMesh tet;
  tet.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  tet.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const PieceProxy small = proxyOf(tet, {});
  ASSERT_EQ(small.hulls.size(), 1u);
  EXPECT_EQ(small.hulls[0].triangles.size(), 4u);
  EXPECT_NEAR(small.volume, 1.0 / 6, 1e-16);
  EXPECT_NEAR(small.error, 0, 1e-14);

  const PieceProxy cube = proxyOf(families::boxSurface(Vec3::Zero(), Vec3::Ones(), 3, 3, 3), {});
  ASSERT_EQ(cube.hulls.size(), 1u);
  EXPECT_EQ(cube.hulls[0].positions.size(), 8u);
  EXPECT_EQ(cube.hulls[0].triangles.size(), 12u);
  EXPECT_NEAR(cube.error, 0, 1e-14);
  EXPECT_EQ(cube.overlap, 0);
  EXPECT_EQ(cube.name, "piece_0001");
  EXPECT_NEAR(cube.mass, Material{}.density, 1e-9);
  EXPECT_LT((cube.centreOfMass - Vec3(0.5, 0.5, 0.5)).norm(), 1e-12);
}

TEST(ConvexProxies, RoundingIsNoVolumeToTellOf) {
  const auto saidOf = [](const TriMesh& mesh, const ConvexProxiesParams& params) {
    Said said;
    EXPECT_TRUE(convexProxies(test::whole(mesh), params, said.exec).ok());
    return said.lines.empty() ? std::string() : said.lines.back().second;
  };
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  TriMesh cube = families::boxSurface(Vec3::Zero(), Vec3::Ones(), 3, 3, 3);
  for (Vec3& p : cube.positions) p = turn * p;
  EXPECT_EQ(saidOf(cube, {}), "1 hull for 1 piece; as much volume as the pieces");
  EXPECT_EQ(saidOf(test::angle(), {.maxHulls = 1}),
            "1 hull for 1 piece; 16.7 % more volume than the pieces, 16.7 % more at most (piece_0001)");
}

TEST(ConvexProxies, AFlatPieceHasAPolygonForAHullAndSaysSo) {
  TriMesh flat;
  flat.positions = {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  flat.triangles = {{0, 1, 2}, {0, 2, 1}};
  Said said;
  const auto proxies = convexProxies(test::whole(flat), {}, said.exec);
  ASSERT_TRUE(proxies.ok()) << proxies.error().text();
  ASSERT_EQ(proxies->pieces[0].hulls.size(), 1u);
  EXPECT_EQ(proxies->pieces[0].hulls[0].triangles.size(), 2u);
  EXPECT_EQ(proxies->pieces[0].volume, 0);
  EXPECT_EQ(proxies->pieces[0].error, 0);
  EXPECT_TRUE(said.warning("piece_0001 is flat"));
}

TEST(ConvexProxies, AnAngleIsTwoBoxesAndAChannelThree) {
  const PieceProxy one = proxyOf(test::angle(), {.maxHulls = 1});
  EXPECT_EQ(one.hulls.size(), 1u);
  EXPECT_NEAR(one.error, 0.5 / 3, 1e-12);
  const PieceProxy two = proxyOf(test::angle(), {.maxHulls = 16, .tolerance = 1e-9});
  EXPECT_EQ(two.hulls.size(), 2u);
  EXPECT_NEAR(two.error, 0, 1e-12);
  for (const ConvexHull& hull : two.hulls) EXPECT_EQ(hull.positions.size(), 8u);

  const PieceProxy three = proxyOf(test::channel(), {.maxHulls = 16, .tolerance = 1e-9});
  EXPECT_EQ(three.hulls.size(), 3u);
  EXPECT_NEAR(three.error, 0, 1e-12);
}

TEST(ConvexProxies, ItDoesNotMatterHowTheAngleIsTurned) {
  const Mat3 turn = (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::AngleAxisd(2, Vec3::UnitX()))
                        .toRotationMatrix();
  TriMesh angle = test::angle();
  for (Vec3& p : angle.positions) p = turn * p + Vec3(100, -50, 3);
  const PieceProxy two = proxyOf(angle, {.maxHulls = 16, .tolerance = 1e-9});
  EXPECT_EQ(two.hulls.size(), 2u);
  EXPECT_NEAR(two.error, 0, 1e-10);
}

TEST(ConvexProxies, ToleranceAndCountEndTheCutting) {
  const TriMesh ring = families::torusSurface(1, 0.3, 24, 10);
  double last = std::numeric_limits<double>::infinity();
  for (const int most : {1, 2, 4, 16}) {
    const PieceProxy p = proxyOf(ring, {.maxHulls = most, .tolerance = 0});
    EXPECT_EQ(p.hulls.size(), static_cast<std::size_t>(most));
    EXPECT_GE(p.error, 0);
    EXPECT_LE(p.error, last * (1 + 1e-9));
    last = p.error;
  }
  EXPECT_LT(last, 0.45);
  const PieceProxy enough = proxyOf(ring, {.maxHulls = 64, .tolerance = 0.4});
  EXPECT_LE(enough.error, 0.4);
  EXPECT_LE(enough.hulls.size(), 16u);
}

TEST(ConvexProxies, AVoidIsNoPartOfTheVolume) {
  const TriMesh hollow =
      families::joined(families::sphereSurface(Vec3::Zero(), 1, 16, 8),
                       families::reversed(families::sphereSurface(Vec3::Zero(), 0.8, 16, 8)));
  const PieceProxy one = proxyOf(hollow, {.maxHulls = 1});
  EXPECT_NEAR(one.error, 0.512 / 0.488, 0.01);
  const PieceProxy many = proxyOf(hollow, {.maxHulls = 32, .tolerance = 0});
  EXPECT_LT(many.error, 0.5 * one.error);
}

TEST(ConvexProxies, RandomBodiesAreHeldByConvexHullsThatDoNotOverlap) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TriMesh mesh = boulder(seed);
    const PieceProxy one = proxyOf(mesh, {.maxHulls = 1});
    ASSERT_EQ(one.hulls.size(), 1u);
    EXPECT_EQ(outside(one.hulls[0], mesh.positions), 0u);
    const PieceProxy many = proxyOf(mesh, {.maxHulls = 10, .tolerance = 0.01});
    EXPECT_LE(many.hulls.size(), 10u);
    EXPECT_LT(many.error, one.error);
    double sum = 0;
    for (std::size_t h = 0; h < many.hulls.size(); ++h) {
      EXPECT_EQ(outside(many.hulls[h], many.hulls[h].positions), 0u) << "not convex";
      sum += many.hulls[h].volume;
      for (std::size_t k = h + 1; k < many.hulls.size(); ++k)
        EXPECT_LT(sharedVolume(many.hulls[h], many.hulls[k]), 1e-12);
    }
    EXPECT_DOUBLE_EQ(sum, many.volume);
    EXPECT_GE(sum, many.pieceVolume);
    for (const Vec3& p : mesh.positions) EXPECT_LT(distanceTo(many.hulls, p), 1e-12);
  }
}

TEST(ConvexProxies, OverlapsOfKnownSolids) {
  const auto box = [](const Vec3& low, const Vec3& high) {
    PieceProxy p = proxyOf(families::boxSurface(low, high, 1, 1, 1), {});
    return p.hulls.front();
  };
  const ConvexHull cube = box(Vec3::Zero(), Vec3::Ones());
  EXPECT_NEAR(sharedVolume(cube, box(Vec3(0.5, 0.5, 0.5), Vec3(2, 2, 2))), 0.125, 1e-15);
  EXPECT_NEAR(sharedVolume(cube, box(Vec3(0.25, 0.25, 0.25), Vec3(0.5, 0.5, 0.5))), 1.0 / 64, 1e-15);
  EXPECT_NEAR(sharedVolume(cube, cube), 1, 1e-15);
  EXPECT_EQ(sharedVolume(cube, box(Vec3(1, 0, 0), Vec3(2, 1, 1))), 0);
  EXPECT_EQ(sharedVolume(cube, box(Vec3(3, 0, 0), Vec3(4, 1, 1))), 0);

  // The hull of an angle reaches into the box that fills its corner, by half of that; its two boxes don't.
  std::vector<PieceProxy> pieces(2);
  pieces[0] = proxyOf(test::angle(), {.maxHulls = 1});
  pieces[1].hulls = {box(Vec3(1, 1, 0), Vec3(2, 2, 1))};
  measureOverlaps(pieces, Exec{});
  EXPECT_NEAR(pieces[0].overlap, 0.5, 1e-14);
  EXPECT_EQ(pieces[0].overlap, pieces[1].overlap);
  pieces[0] = proxyOf(test::angle(), {});
  measureOverlaps(pieces, Exec{});
  EXPECT_NEAR(pieces[0].overlap, 0, 1e-14);
}

TEST(ConvexProxies, SlicesOfABoxDoNotOverlap) {
  const Proxies proxies = proxiesOf(test::slicedBox(5), {});
  ASSERT_EQ(proxies.pieces.size(), 5u);
  for (const PieceProxy& p : proxies.pieces) {
    EXPECT_EQ(p.hulls.size(), 1u);
    EXPECT_NEAR(p.error, 0, 1e-13);
    EXPECT_NEAR(p.overlap, 0, 1e-13);
  }
}

TEST(ConvexProxies, SameBitsForAnyNumberOfThreads) {
  const Fragments f = test::slices(families::sphereSurface(Vec3::Zero(), 1, 24, 12), {-0.51, 0.03, 0.47});
  Digest digests[2];
  for (const int threads : {1, 2}) {
    setThreadLimit(threads);
    Hasher hasher;
    hashValue(hasher, proxiesOf(f, {}));
    digests[threads - 1] = hasher.digest();
  }
  setThreadLimit(0);
  EXPECT_EQ(digests[0], digests[1]);
}

TEST(ConvexProxies, SaysWhatIsWrong) {
  EXPECT_FALSE(convexProxies(Fragments{}, {}, Exec{}).ok());
  const Fragments f = test::slicedBox(2);
  const auto none = convexProxies(f, {.maxHulls = 0}, Exec{});
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().port, "max_hulls");
  const auto negative = convexProxies(f, {.tolerance = -1}, Exec{});
  ASSERT_FALSE(negative.ok());
  EXPECT_EQ(negative.error().port, "tolerance");
  CancelToken cancel;
  cancel.cancel();
  Exec exec;
  exec.cancel = &cancel;
  const auto cancelled = convexProxies(f, {}, exec);
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sherd
