// Sheets that bound nothing, on a solid, in it and beside it.
#include <gtest/gtest.h>

#include "damage.h"
#include "geometry/edge_table.h"
#include "geometry/orient.h"
#include "repair/repair.h"

namespace sherd {
namespace {

using families::joined;
using families::reversed;
using test::cube;
using test::repaired;
using test::volumeOf;
using test::welded;

std::size_t parts(const TriMesh& mesh) {
  return surfaceParts(mesh.triangles, buildEdgeTable(mesh.triangles, mesh.positions.size())).size();
}

TriMesh sheet(std::vector<Vec3> corners) {
  TriMesh mesh;
  mesh.positions = std::move(corners);
  for (Index k = 2; k < static_cast<Index>(mesh.positions.size()); ++k)
    mesh.triangles.push_back({0, k - 1, k});
  return mesh;
}

/// A cube of 1 m with a triangle on the middle third of the edge x = y = 1, that reaches out by `height`.
TriMesh withFace(double height) {
  const double third = 1.0 / 3;
  TriMesh mesh = cube(Vec3::Zero(), 1, 3);
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (const Vec3& p : mesh.positions) {
    if (p.x() != 1 || p.y() != 1) continue;
    if (std::abs(p.z() - third) < 0.1) low = p;
    if (std::abs(p.z() - 2 * third) < 0.1) high = p;
  }
  return welded(joined(mesh, sheet({low, high, Vec3(1 + height, 1 + height, 0.5)})));
}

TEST(RepairSheets, ASmallFaceOnAnEdgeIsLeftOut) {
  const TriMesh mesh = withFace(0.02);
  Said said;
  const auto result = repair(mesh, {}, said.exec);
  ASSERT_TRUE(result.ok()) << result.error().text();
  EXPECT_TRUE(said.warning("left out 1 stray sheet of 0.0047")) << result->report.done.front();
  EXPECT_TRUE(said.warning("near (1, 1, 0.33"));
  EXPECT_EQ(result->report.stage, RepairStage::Mended);
  EXPECT_EQ(test::triangleSet(result->mesh), test::triangleSet(cube(Vec3::Zero(), 1, 3)));
}

TEST(RepairSheets, AFinOnAnEdgeIsOneWithTheSolid) {
  for (const bool isInsideOut : {false, true}) {
    TriMesh mesh = withFace(0.5);
    if (isInsideOut) mesh = reversed(mesh);
    Said said;
    const auto result = repair(mesh, {}, said.exec);
    ASSERT_TRUE(result.ok()) << result.error().text();
    EXPECT_TRUE(inspectSurface(result->mesh).sound());
    EXPECT_TRUE(said.warning("made 1 sheet of 0.118 m² that stood on the solid"));
    EXPECT_EQ(parts(result->mesh), 1u);
    // A triangle of 1/3 by √0.5, 0.01 √3 thick.
    EXPECT_NEAR(volumeOf(result->mesh),
                1 + 0.5 / 3 * std::sqrt(0.5) * 0.01 * boxOf(mesh.positions).diagonal(), 3e-4);
  }
}

TEST(RepairSheets, AFinThatTouchesAFaceIsOneWithTheSolid) {
  // In a point, along a line, and a hair off.
  for (const auto& fin : {sheet({{1, 0.5, 0.5}, {2, 0.5, 0.5}, {2, 0.5, 1}}),
                          sheet({{1, 0.5, 0.25}, {1, 0.5, 0.75}, {2, 0.5, 0.5}}),
                          sheet({{1 + 1e-7, 0.5, 0.25}, {1 + 1e-7, 0.5, 0.75}, {2, 0.5, 0.5}})}) {
    const Repaired result = repaired(joined(cube(), fin));
    EXPECT_TRUE(result.report.visible);
    EXPECT_EQ(parts(result.mesh), 1u);
    EXPECT_GT(volumeOf(result.mesh), 1.002);
    EXPECT_LT(volumeOf(result.mesh), 1.007);
  }
}

TEST(RepairSheets, TwoFinsOnOneEdge) {
  const TriMesh fin = sheet({{1, 1, 0}, {1, 1, 1}, {1.5, 1.5, 0.5}}),
                other = sheet({{1, 1, 0}, {1, 1, 1}, {1.2, 1.6, 0.5}});
  const Repaired result = repaired(welded(joined(joined(cube(), fin), other)));
  EXPECT_EQ(parts(result.mesh), 1u);
  EXPECT_GT(volumeOf(result.mesh), 1.01);
}

TEST(RepairSheets, AnInnerWallBoundsNothing) {
  const TriMesh wall = sheet({{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 1}, {0.5, 0, 1}});
  const Repaired result = repaired(joined(cube(), wall));
  EXPECT_FALSE(result.report.visible);
  EXPECT_EQ(result.report.stage, RepairStage::Mended);
  EXPECT_EQ(test::triangleSet(result.mesh), test::triangleSet(cube()));
}

TEST(RepairSheets, AStrayFaceLyingOnAFaceIsLeftOut) {
  const TriMesh face = sheet({{0.5, 1, 0.5}, {0.55, 1, 0.5}, {0.5, 1, 0.55}});
  const Repaired result = repaired(joined(cube(), face));
  EXPECT_DOUBLE_EQ(volumeOf(result.mesh), 1);
}

TEST(RepairSheets, ALeafBesideTheSolidStaysALeaf) {
  const TriMesh leaf = sheet({{1.5, 0.5, 0.5}, {1.51, 0.5, 0.5}, {1.5, 0.51, 0.5}});
  const Repaired result = repaired(joined(cube(), leaf));
  EXPECT_TRUE(result.report.visible);
  EXPECT_EQ(parts(result.mesh), 2u);
}

TEST(RepairSheets, AnOpenTubeOnASolidIsFilledAsEver) {  // it hangs on four edges, and bounds a volume
  const TriMesh mesh = cube(Vec3::Zero(), 1, 3);
  TriMesh tube = cube(Vec3(1.0 / 3, 1, 1.0 / 3), 1.0 / 3);
  std::erase_if(tube.triangles, [&](const Triangle& t) {
    const double y = tube.positions[at(t[0])].y();
    return tube.positions[at(t[1])].y() == y && tube.positions[at(t[2])].y() == y;
  });
  const Repaired result = repaired(joined(mesh, tube));
  EXPECT_NEAR(volumeOf(result.mesh), 1 + 1.0 / 27, 1e-9);
  EXPECT_EQ(parts(result.mesh), 1u);
}

TEST(RepairSheets, MessagesCountAsOneSpeaks) {
  TriMesh mesh = cube();
  mesh.triangles.push_back(mesh.triangles[0]);
  Said said;
  ASSERT_TRUE(repair(mesh, {}, said.exec).ok());
  EXPECT_TRUE(said.info("left out 1 face that was there twice"));
  mesh.triangles.push_back(mesh.triangles[1]);
  ASSERT_TRUE(repair(mesh, {}, said.exec).ok());
  EXPECT_TRUE(said.info("left out 2 faces that were there twice"));
  TriMesh open = cube();
  open.triangles.resize(10);
  ASSERT_TRUE(repair(open, {}, said.exec).ok());
  EXPECT_TRUE(said.warning(" % of the object)"));
  EXPECT_FALSE(said.warning("e+"));
}

TEST(RepairSheets, StrictSaysWhereTwoPartsCross) {
  const RepairParams strict{.mode = RepairParams::Mode::Strict};
  const auto crossing = repair(joined(cube(), cube(Vec3(0.5, 0.25, 0.125))), strict, {});
  ASSERT_FALSE(crossing.ok());
  EXPECT_NE(crossing.error().text().find("1 pair of parts that cross or touch near ("), std::string::npos);
  EXPECT_EQ(crossing.error().text().find("inside out"), std::string::npos);
  TriMesh bad = cube();
  bad.positions[2].x() = std::nan("");
  EXPECT_NE(repair(bad, {}, {}).error().text().find("1 vertex that is not finite: vertex 3, ("),
            std::string::npos);
}

}  // namespace
}  // namespace sherd
