// Surfaces that touch themselves, as pieces of a fracture may: each part has vertices of its own there.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "support/said.h"
#include "surfaces.h"
#include "tetrahedralize/contacts.h"
#include "tetrahedralize/gaps.h"
#include "tetrahedralize/shells.h"

namespace sherd::test {
namespace {

using Topology = std::vector<std::pair<bool, int>>;

std::size_t contacts(const TriMesh& mesh, double distance = 1e-5) {
  return countContacts(mesh.positions, mesh.triangles, distance);
}

TEST(TetrahedralizeTouching, CountsContacts) {
  const TriMesh one = box(Vec3::Zero(), Vec3::Ones());
  EXPECT_EQ(contacts(one), 0u);
  EXPECT_EQ(contacts(joined(one, box(Vec3::Ones(), Vec3(2, 2, 2)))), 1u);
  EXPECT_EQ(contacts(joined(one, box(Vec3(1, 1, 0), Vec3(2, 2, 1)))), 2u);
  EXPECT_EQ(contacts(joined(one, box(Vec3(1 + 3e-6, 1 + 3e-6, 0), Vec3(2, 2, 1)))), 2u);
  EXPECT_EQ(contacts(joined(one, box(Vec3(1 + 1e-5, 1 + 1e-5, 0), Vec3(2, 2, 1)))), 0u);
  EXPECT_EQ(contacts(one, 1.1), 0u) << "its vertices hang together along its edges";
}

TEST(TetrahedralizeTouching, NearPairsAreAllPairsThatAreNear) {
  std::vector<Vec3> points;
  Rng rng(3);
  for (int k = 0; k < 400; ++k) points.emplace_back(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform());
  std::vector<std::pair<Index, Index>> expected;
  for (Index a = 0; a < 400; ++a)
    for (Index b = a + 1; b < 400; ++b)
      if ((points[at(a)] - points[at(b)]).norm() <= 0.02) expected.emplace_back(a, b);
  EXPECT_EQ(nearPairs(points, 0.02), expected);
  EXPECT_FALSE(expected.empty());
}

TEST(TetrahedralizeTouching, AContactMayJoinBodiesOrMakeAHandleAndNothingElse) {
  const Topology ball{{false, 2}}, two{{false, 2}, {false, 2}}, ring{{false, 0}},
      hollow{{false, 2}, {true, 2}};
  EXPECT_TRUE(enclosesTopology(ball, ball, 0));
  EXPECT_FALSE(enclosesTopology(ball, two, 0));
  EXPECT_TRUE(enclosesTopology(ball, two, 1));
  EXPECT_TRUE(enclosesTopology(ring, ball, 1));
  EXPECT_FALSE(enclosesTopology(ring, ball, 0));
  EXPECT_FALSE(enclosesTopology(two, ball, 3));
  EXPECT_FALSE(enclosesTopology(ball, ring, 3));
  EXPECT_FALSE(enclosesTopology(ball, hollow, 3));
}

TEST(TetrahedralizeTouching, TopologyIsOffByShellsAndHandles) {
  const Topology ball{{false, 2}}, two{{false, 2}, {false, 2}}, rings{{false, -4}},
      hollow{{false, 2}, {true, 0}};
  EXPECT_EQ(topologyDifference(two, two), 0);
  EXPECT_EQ(topologyDifference(ball, two), 1);
  EXPECT_EQ(topologyDifference(rings, two), 4);   // a component too few, three handles too many
  EXPECT_EQ(topologyDifference(two, hollow), 3);  // a component too many, no void, and not its handle
}

TEST(TetrahedralizeTouching, TwoBoxesThatMeetInAPointHaveOneCage) {
  expectGood(cageOf(joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3::Ones(), Vec3(2, 2, 2))), 300), 1, 2);
}

TEST(TetrahedralizeTouching, TwoBoxesThatMeetAlongAnEdgeHaveOneCage) {
  expectGood(cageOf(joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3(1, 1, 0), Vec3(2, 2, 1))), 300), 1, 2);
}

TEST(TetrahedralizeTouching, TwoBoxesThatRepairDrewApartHaveOneCage) {
  const double gap = 1e-6;
  expectGood(
      cageOf(joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3(1 + gap, 1 + gap, 0), Vec3(2, 2, 1))), 300), 1,
      2);
  expectGood(
      cageOf(joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3::Constant(1 + gap), Vec3(2, 2, 2))), 300), 1,
      2);
}

TEST(TetrahedralizeTouching, BodiesTooNearForAnyCageAreNamedAtOnce) {
  Said said;
  const TriMesh mesh =
      joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3(1 + 2e-4, 1 + 2e-4, 0), Vec3(2, 2, 1)));
  const auto cage = tetrahedralize(shared(mesh), {.tets = 300}, said.exec);
  ASSERT_FALSE(cage.ok());
  const std::string text = cage.error().text();
  EXPECT_NE(text.find("closes the gap of 0.000"), std::string::npos) << text;
  EXPECT_NE(text.find("between two bodies: edges of about 0.000"), std::string::npos) << text;
  EXPECT_FALSE(said.info("meshing again"));
}

TEST(TetrahedralizeTouching, BodiesThatAreNearInAPlaceAreKeptApartThere) {
  const double gap = 0.01;
  expectGood(
      cageOf(joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3::Constant(1 + gap), Vec3(2, 2, 2))), 300), 2,
      4);
}

TEST(TetrahedralizeTouching, GapsBetweenBodies) {
  const auto gapsOf = [](double gap, double widest, std::size_t most) {
    const TriMesh mesh = joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3(1 + gap, 0, 0), Vec3(2, 1, 1)));
    return gapsBetweenBodies(mesh.positions, mesh.triangles, *splitShells(mesh.positions, mesh.triangles),
                             1e-6, widest, most, {});
  };
  const BodyGaps found = gapsOf(0.1, 0.2, 5000);
  EXPECT_FALSE(found.isTooMany);
  ASSERT_TRUE(found.narrowest);
  EXPECT_NEAR(found.narrowest->width, 0.1, 1e-12);
  EXPECT_GT(found.gaps.size(), 2 * 100u);  // two faces of 1 m², each by patches of 0.1 m or less
  EXPECT_TRUE(gapsOf(0.1, 0.05, 5000).gaps.empty());
  EXPECT_TRUE(gapsOf(1e-3, 0.2, 5000).isTooMany);
  EXPECT_FALSE(gapsOf(1e-7, 0.2, 5000).narrowest) << "they touch";
}

}  // namespace
}  // namespace sherd::test
