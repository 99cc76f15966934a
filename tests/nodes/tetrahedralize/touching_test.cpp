// Surfaces that touch themselves, as pieces of a fracture may: each part has vertices of its own there.
#include <gtest/gtest.h>

#include "surfaces.h"
#include "tetrahedralize/shells.h"

namespace sherd::test {
namespace {

using Topology = std::vector<std::pair<bool, int>>;

TEST(TetrahedralizeTouching, CountsContacts) {
  EXPECT_EQ(countContacts(box(Vec3::Zero(), Vec3::Ones()).positions), 0u);
  EXPECT_EQ(
      countContacts(joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3::Ones(), Vec3(2, 2, 2))).positions), 1u);
  EXPECT_EQ(
      countContacts(joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3(1, 1, 0), Vec3(2, 2, 1))).positions),
      2u);
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

}  // namespace
}  // namespace sherd::test
