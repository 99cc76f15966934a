#include "geometry/orient.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "geometry/inspect_surface.h"
#include "geometry/solid.h"
#include "geometry/weld.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

using families::boxSurface;
using families::joined;
using families::reversed;
using families::sphereSurface;

TriMesh cube(double low, double high) {
  return boxSurface(Vec3::Constant(low), Vec3::Constant(high), 1, 1, 1);
}

double volumeOf(const TriMesh& mesh) { return solidVolume(mesh.positions, mesh.triangles); }

TEST(Weld, JoinsEqualPositionsAndNothingElse) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}, {-0.0, -0.0, 0}, {1, 0, 0}, {0, 0, 1e-300}};
  mesh.triangles = {{0, 2, 3}, {4, 5, 6}, {0, 4, 3}};
  mesh.materials = {"a", "b", "c"};
  mesh.materialOf = {0, 1, 2};
  mesh.uvSets = {{"uv", {}}};
  for (int k = 0; k < 9; ++k) mesh.uvSets[0].uv.emplace_back(k, -k);
  const WeldCounts counts = weld(mesh);
  EXPECT_EQ(counts.joined, 2u);
  EXPECT_EQ(counts.collapsedTriangles, 1u);
  EXPECT_EQ(counts.unusedVertices, 1u);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-300}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
  EXPECT_EQ(mesh.materialOf, (std::vector<Index>{0, 1}));
  ASSERT_EQ(mesh.uvSets[0].uv.size(), 6u);
  EXPECT_EQ(mesh.uvSets[0].uv[5], Vec2(5, -5));
}

TEST(Weld, LeavesVerticesThatOnlyACollapsedTriangleUsedOut) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {5, 5, 5}};
  mesh.triangles = {{3, 4, 0}, {0, 1, 2}};
  EXPECT_EQ(weld(mesh).collapsedTriangles, 1u);
  EXPECT_EQ(mesh.positions.size(), 3u);
}

TEST(Orient, LeavesWhatIsRightAlone) {
  TriMesh mesh = joined(cube(0, 1), reversed(cube(0.25, 0.75)));
  const std::vector<Triangle> before = mesh.triangles;
  const Turned turned = orient(mesh);
  EXPECT_EQ(turned.triangles + turned.shells + turned.voids, 0u);
  EXPECT_EQ(mesh.triangles, before);
}

TEST(Orient, TurnsWhatIsInsideOut) {
  TriMesh one = reversed(cube(0, 1));
  EXPECT_EQ(orient(one).shells, 1u);
  EXPECT_DOUBLE_EQ(volumeOf(one), 1);
  TriMesh ofTwo = joined(cube(0, 1), reversed(cube(2, 4)));
  const Turned turned = orient(ofTwo);
  EXPECT_EQ(turned.shells, 1u);
  EXPECT_EQ(turned.triangles, 0u);
  EXPECT_DOUBLE_EQ(volumeOf(ofTwo), 9);
}

TEST(Orient, WallsOfVoidsFaceTheVoid) {
  TriMesh mesh =
      joined(joined(cube(0, 4), cube(1, 3)), reversed(cube(1.5, 2.5)));  // a void, and a core within it
  const Turned turned = orient(mesh);
  EXPECT_EQ(turned.voids, 1u);
  EXPECT_EQ(turned.shells, 1u);
  EXPECT_DOUBLE_EQ(volumeOf(mesh), 64 - 8 + 1);
  EXPECT_TRUE(inspectSurface(mesh).sound());
}

TEST(Orient, TurnsTheFewerOfIncoherentTriangles) {
  TriMesh mesh = sphereSurface(Vec3::Zero(), 1, 12, 8);
  const TriMesh whole = mesh;
  Rng rng(3);
  std::size_t wrong = 0;
  for (Triangle& t : mesh.triangles)
    if (rng.uniform() < 0.2) std::swap(t[1], t[2]), ++wrong;
  EXPECT_EQ(orient(mesh).triangles, wrong);
  EXPECT_DOUBLE_EQ(volumeOf(mesh), volumeOf(whole));
  EXPECT_TRUE(inspectSurface(mesh).sound());
}

TEST(Orient, AttributesFollowTheirCorners) {
  TriMesh mesh = reversed(cube(0, 1));
  const auto attributeOf = [&](std::size_t corner) {
    return mesh.positions[at(mesh.triangles[corner / 3][corner % 3])];
  };
  mesh.uvSets = {{"uv", {}}};
  mesh.colorSets = {{"colour", {}}};
  for (std::size_t k = 0; k < mesh.cornerCount(); ++k) {
    const Vec3 p = attributeOf(k);
    mesh.uvSets[0].uv.emplace_back(p.x(), p.y());
    mesh.colorSets[0].rgba.emplace_back(p.x(), p.y(), p.z(), 1);
    mesh.normals.push_back((p - Vec3::Constant(0.5)).normalized());
  }
  orient(mesh);
  for (std::size_t k = 0; k < mesh.cornerCount(); ++k) {
    const Vec3 p = attributeOf(k);
    EXPECT_EQ(mesh.uvSets[0].uv[k], Vec2(p.x(), p.y()));
    EXPECT_EQ(mesh.colorSets[0].rgba[k], Vec4(p.x(), p.y(), p.z(), 1));
    EXPECT_GT(mesh.normals[k].dot(p - Vec3::Constant(0.5)), 0) << "outward normals were right and stay";
  }
  mesh = reversed(mesh);
  for (std::size_t k = 0; k < mesh.cornerCount(); ++k)
    mesh.normals[k] = -(attributeOf(k) - Vec3::Constant(0.5)).normalized();
  orient(mesh);
  for (std::size_t k = 0; k < mesh.cornerCount(); ++k)
    EXPECT_GT(mesh.normals[k].dot(attributeOf(k) - Vec3::Constant(0.5)), 0) << "inward ones are turned too";
}

TEST(Orient, LeavesTheSidesOfOpenSurfacesButMakesThemCoherent) {
  TriMesh mesh = reversed(cube(0, 1));
  mesh.triangles.pop_back();
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  const Turned turned = orient(mesh);
  EXPECT_EQ(turned.triangles, 1u);
  EXPECT_EQ(turned.shells, 0u);
  EXPECT_EQ(inspectSurface(mesh).incoherentEdges.count, 0u);
}

}  // namespace
}  // namespace sherd
