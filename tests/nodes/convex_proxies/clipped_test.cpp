#include "convex_proxies/clipped.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "nodes/convex_proxies/solids.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

Vec3 direction(const Rng& rng, std::size_t i) {
  const Vec3 d(rng.uniformAt(3 * i) - 0.5, rng.uniformAt(3 * i + 1) - 0.5, rng.uniformAt(3 * i + 2) - 0.5);
  return d.normalized();
}

TEST(ClippedSolid, TheTwoSidesOfAPlaneMakeTheWhole) {
  for (const TriMesh& mesh : {test::angle(), test::channel(), families::torusSurface(1, 0.3, 24, 10)}) {
    ClippedSolid rest(mesh.positions, mesh.triangles);
    const double whole = rest.volume();
    const Rng rng(7);
    for (std::size_t i = 0; i < 12; ++i) {
      const CutPlane plane{boxOf(mesh.positions).centre() + 0.5 * direction(rng, i), direction(rng, i)};
      const ClippedSolid below = rest.clipped(plane), above = rest.clipped(plane.turned());
      EXPECT_NEAR(below.volume() + above.volume(), rest.volume(), 1e-12 * whole) << i;
      rest = below;
    }
    EXPECT_GT(rest.volume(), 0);
  }
}

TEST(ClippedSolid, APlaneThatCutBeforeCutsNothingMore) {
  const TriMesh mesh = test::channel();
  const Rng rng(3);
  ClippedSolid solid(mesh.positions, mesh.triangles);
  std::vector<CutPlane> planes;
  for (std::size_t i = 0; i < 8; ++i) {
    planes.push_back({Vec3(1.5, 0.5, 0.5) + 0.4 * direction(rng, i), direction(rng, i)});
    solid = solid.clipped(planes.back());
  }
  const double volume = solid.volume();
  ASSERT_GT(volume, 0);
  for (const CutPlane& plane : planes) {
    EXPECT_TRUE(solid.within(plane));
    // The same plane through another of its points: equal only up to rounding.
    const Vec3 aside = plane.origin + 0.3 * plane.normal.unitOrthogonal();
    EXPECT_NEAR(solid.clipped({aside, plane.normal}).volume(), volume, 1e-12);
    EXPECT_NEAR(solid.clipped({aside, -plane.normal}).volume(), 0, 1e-12);
  }
}

TEST(ClippedSolid, GrowsWithTheNumberOfPlanesOnly) {
  const TriMesh ball = families::sphereSurface(Vec3::Zero(), 1, 16, 8);
  ClippedSolid solid(ball.positions, ball.triangles);
  const Rng rng(1);
  constexpr std::size_t kPlanes = 200;
  for (std::size_t i = 0; i < kPlanes; ++i)
    solid = solid.clipped({0.5 * direction(rng, i), direction(rng, i)});
  EXPECT_LT(solid.polygons(), 50 * kPlanes);
  EXPECT_GT(solid.volume(), 4.18879 / 8 * 0.98);
  EXPECT_LT(solid.volume(), 4.18879 / 8 * 1.2);
}

TEST(ClippedSolid, NothingIsLeftBeyondTheSolid) {
  const TriMesh mesh = test::angle();
  const ClippedSolid gone =
      ClippedSolid(mesh.positions, mesh.triangles).clipped({Vec3(0, 0, -1), Vec3::UnitZ()});
  EXPECT_TRUE(gone.empty());
  EXPECT_EQ(gone.volume(), 0);
}

}  // namespace
}  // namespace sherd
