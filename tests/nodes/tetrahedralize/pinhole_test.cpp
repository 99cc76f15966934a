// Holes and notches that are smaller than the cage's edges: not worth a thousand tetrahedra, nor a refusal.
#include <gtest/gtest.h>

#include "support/said.h"
#include "support/tet_families.h"
#include "surfaces.h"

namespace sherd::test {
namespace {

/// A square plate, 1 m wide and 0.1 m thick, with a square hole through its middle.
TriMesh plateWithHole(double width) {
  const TetMesh ring = families::fromCubes(
      families::cubesOf(3, 3, 1, [](int i, int j, int) { return i != 1 || j != 1; }), Vec3(1, 1, 0.1));
  TriMesh mesh = *ring.surface;
  for (Vec3& p : mesh.positions)
    for (int k = 0; k < 2; ++k)
      p[k] = p[k] < 1.5 ? (p[k] < 0.5 ? 0 : 0.5 * (1 - width)) : (p[k] > 2.5 ? 1 : 0.5 * (1 + width));
  return mesh;
}

TEST(Pinhole, IsBridgedWithAWarning) {
  Said said;
  const auto cage = tetrahedralize(shared(plateWithHole(2e-3)), {.tets = 400}, said.exec);
  ASSERT_TRUE(cage.ok()) << cage.error().text();
  EXPECT_EQ(defectOf(*cage), "");
  EXPECT_EQ(cageTopology(*cage), std::make_pair(1, 2));
  EXPECT_TRUE(said.warning(
      "the cage has 1 component, 0 voids, 0 handles where the surface has 1 component, 0 voids, 1 handle"));
  EXPECT_TRUE(said.info("the tetrahedra around the model close the gap of about 0.00"));
  EXPECT_TRUE(said.info("would keep it open (the cage has 1 component"));
}

TEST(Pinhole, AHoleAsWideAsEdgesStaysOpen) {
  Said said;
  const auto cage = tetrahedralize(shared(plateWithHole(0.3)), {.tets = 400}, said.exec);
  expectGood(cage, 1, 0);
  EXPECT_FALSE(said.warning("handle"));
}

}  // namespace
}  // namespace sherd::test
