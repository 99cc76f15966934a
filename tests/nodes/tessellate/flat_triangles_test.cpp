// Cracks along lines of the surface's own grid, where rounding decides on which side of them they run.
#include <gtest/gtest.h>

#include "base/exec.h"
#include "support/fracture_check.h"
#include "support/nearest_cells.h"
#include "support/surface_families.h"
#include "tessellate/tessellate.h"

namespace sherd::test {
namespace {

/// A wall of quads 0.105 m high, whose sites' borders lie on every second of their lines.
Fragments brokenCourses(const Vec3& place, CellMode mode) {
  const TriMesh wall =
      families::boxSurface(place + Vec3(-0.42, 0, -0.05), place + Vec3(0.42, 0.84, 0.05), 8, 8, 1);
  const auto cage = families::cagedInBlock(wall, 7);
  std::vector<Vec3> sites;
  for (int i = 0; i < 4; ++i) sites.push_back(place + Vec3(0, 0.105 + 0.21 * i, 0));
  for (int i = 0; i < 4; ++i) sites.push_back(place + Vec3(0.31, 0.1 + 0.2 * i, -0.003));
  const auto pieces = tessellate(euclideanCells(cage, sites), {.cells = mode}, Exec{});
  EXPECT_TRUE(pieces.ok()) << pieces.error().text();
  return pieces.ok() ? *pieces : Fragments{};
}

TEST(FlatTriangles, CracksAlongTheSurfacesOwnLinesLeaveNone) {
  for (const Vec3& place : {Vec3(0, 0, 0), Vec3(0.1, 0.3, -0.7), Vec3(13.7, -2.3, 5.1)}) {
    const Fragments pieces = brokenCourses(place, CellMode::Exact);
    const FractureCheck check = checkFracture(pieces, {.points = 100, .selfIntersections = true});
    EXPECT_TRUE(check.good()) << check.text();
    EXPECT_EQ(check.flat, 0u);
    EXPECT_EQ(check.selfIntersecting, 0u);
    EXPECT_EQ(pieces.counts.forcedTriangles, 0u);
  }
}

}  // namespace
}  // namespace sherd::test
