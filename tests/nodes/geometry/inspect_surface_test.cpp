#include "geometry/inspect_surface.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/parallel.h"
#include "base/rng.h"
#include "geometry/exact_points.h"
#include "geometry/self_intersections.h"
#include "geometry/weld.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

using families::boxSurface;
using families::joined;
using families::sphereSurface;
using families::torusSurface;

TriMesh cube(const Vec3& low = Vec3::Zero(), double size = 1) {
  return boxSurface(low, low + Vec3::Constant(size), 1, 1, 1);
}

TriMesh tetrahedron() {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// A closed band of n quads, twisted by half a turn.
TriMesh moebiusStrip(int n) {
  TriMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    const Vec3 out(std::cos(a), 0, std::sin(a));
    const Vec3 across = 0.3 * (std::cos(a / 2) * out + std::sin(a / 2) * Vec3(0, 1, 0));
    mesh.positions.push_back(out - across);
    mesh.positions.push_back(out + across);
  }
  for (int i = 0; i < n; ++i) {
    const Index a = 2 * i, b = a + 1;
    const Index c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({a, d, c});
  }
  return mesh;
}

std::size_t crossings(const TriMesh& mesh) {
  return findSelfIntersections(mesh.positions, mesh.triangles, {}).pairs;
}

TEST(InspectSurface, NothingIsNoSolid) {
  const SurfaceReport report = inspectSurface({});
  EXPECT_TRUE(report.empty);
  EXPECT_FALSE(report.sound());
  EXPECT_NE(refusal(report, "a.obj")->text().find("a.obj holds no triangles"), std::string::npos);
}

TEST(InspectSurface, SoundSurfacesAreSound) {
  for (const TriMesh& mesh : {tetrahedron(), cube(), torusSurface(2, 0.5, 24, 12),
                              sphereSurface(Vec3::Zero(), 1, 16, 8), joined(cube(), cube(Vec3(2, 0, 0))),
                              joined(cube(), families::reversed(cube(Vec3::Constant(0.25), 0.5)))}) {
    const SurfaceReport report = inspectSurface(mesh);
    EXPECT_TRUE(report.sound());
    EXPECT_FALSE(refusal(report, "a.obj"));
  }
}

TEST(InspectSurface, FindsNanAndInfinity) {
  TriMesh mesh = tetrahedron();
  mesh.positions[1].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.positions[3].z() = std::numeric_limits<double>::infinity();
  const SurfaceReport report = inspectSurface(mesh);
  EXPECT_EQ(report.nonFinite.count, 2u);
  EXPECT_NE(refusal(report, "a.obj")->text().find("2 vertices that are not finite"), std::string::npos);
}

TEST(InspectSurface, CountsOpenEdgesAndPlacesThemInTheFile) {
  TriMesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  mesh.frame = {.metresPerUnit = 0.5, .up = FileFrame::Up::Z};
  const SurfaceReport report = inspectSurface(mesh);
  EXPECT_EQ(report.openEdges.count, 3u);
  EXPECT_TRUE(report.openEdges.place.isApprox(mesh.frame.toFile(Vec3(0.5, 0.5, 0))));
  const std::string text = refusal(report, "a.obj")->text();
  EXPECT_NE(text.find("3 open edges (the first near (1, -0, 1))"), std::string::npos) << text;
  EXPECT_NE(text.find("fill the holes"), std::string::npos);
}

TEST(InspectSurface, FindsEdgesAndVerticesWherePartsTouch) {
  TriMesh edge = joined(cube(), cube(Vec3(1, 1, 0)));
  weld(edge);
  const SurfaceReport atEdge = inspectSurface(edge);
  EXPECT_EQ(atEdge.nonManifoldEdges.count, 1u);
  EXPECT_EQ(atEdge.nonManifoldVertices.count, 0u) << "the fans at its ends hang together at the edge";
  EXPECT_EQ(atEdge.openEdges.count, 0u);
  TriMesh vertex = joined(cube(), cube(Vec3(1, 1, 1)));
  weld(vertex);
  const SurfaceReport atVertex = inspectSurface(vertex);
  EXPECT_EQ(atVertex.nonManifoldVertices.count, 1u);
  EXPECT_EQ(atVertex.nonManifoldVertices.place, Vec3(1, 1, 1));
  EXPECT_EQ(atVertex.selfIntersections.count, 0u) << "meeting in a shared corner is not crossing";
}

TEST(InspectSurface, FindsIncoherentOrientation) {
  TriMesh mesh = cube();
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const SurfaceReport report = inspectSurface(mesh);
  EXPECT_EQ(report.incoherentEdges.count, 3u);
  EXPECT_EQ(report.nonOrientable.count, 0u);
}

TEST(InspectSurface, FindsOneSidedParts) {
  const SurfaceReport report = inspectSurface(moebiusStrip(15));
  EXPECT_EQ(report.nonOrientable.count, 1u);
  EXPECT_EQ(report.openEdges.count, 30u);
  EXPECT_EQ(report.nonManifoldVertices.count, 0u);
}

TEST(InspectSurface, FindsZeroAreaAndDuplicates) {
  TriMesh mesh = tetrahedron();
  mesh.positions.emplace_back(0.5, 0.5, 0);  // on the edge 1–2, with a sliver between it and the edge
  mesh.triangles[3] = {1, 4, 3};
  mesh.triangles.push_back({4, 2, 3});
  mesh.triangles.push_back({1, 2, 4});
  const SurfaceReport report = inspectSurface(mesh);
  EXPECT_EQ(report.zeroArea.count, 1u);
  EXPECT_EQ(report.openEdges.count, 0u);
  EXPECT_EQ(report.selfIntersections.count, 2u) << "the sliver's neighbours lie on the edge that it spans";
  mesh = tetrahedron();
  mesh.triangles.push_back({2, 3, 1});
  EXPECT_EQ(inspectSurface(mesh).duplicateTriangles.count, 1u);
}

TEST(InspectSurface, ZeroAreaIsExact) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0},      {1, 1, 1},     {2, 2, 2}, {2, 2, std::nextafter(2.0, 3.0)},
                    {1e-160, 0, 0}, {0, 1e-160, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 4, 5}};
  EXPECT_EQ(zeroAreaTriangles(mesh.positions, mesh.triangles), std::vector<Index>{0});
}

TEST(InspectSurface, FindsInvertedAndFlatParts) {
  EXPECT_EQ(inspectSurface(families::reversed(cube())).inverted.count, 1u);
  EXPECT_EQ(inspectSurface(joined(cube(), cube(Vec3::Constant(0.25), 0.5))).inverted.count, 1u)
      << "a void's wall";
  TriMesh flat = tetrahedron();
  flat.positions[3] = Vec3(0.25, 0.25, 0);
  EXPECT_EQ(inspectSurface(flat).noVolume.count, 1u);
}

TEST(SelfIntersections, EachWayTwoTrianglesCanMeet) {
  TriMesh pair;
  pair.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5, 0.5, -1}, {0.5, 0.5, 1}, {3, 3, 0}};
  pair.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(crossings(pair), 1u) << "no shared corner";
  pair.positions[3] = Vec3(0.5, 0.5, 0);
  EXPECT_EQ(crossings(pair), 1u) << "touching with a corner";
  pair.positions[3] = Vec3(0.5, 0.5, 1e-300);
  pair.positions[5].z() = 1;
  EXPECT_EQ(crossings(pair), 0u) << "apart by less than rounding";
  pair.triangles[1] = {0, 3, 4};
  pair.positions[3] = Vec3(1, 1, -1), pair.positions[4] = Vec3(1, 1, 1);
  EXPECT_EQ(crossings(pair), 1u) << "one shared corner";
  pair.positions[3] = Vec3(-1, -1, -1);
  pair.positions[4] = Vec3(-1, -1, 1);
  EXPECT_EQ(crossings(pair), 0u);
  pair.triangles[1] = {1, 0, 3};
  pair.positions[3] = Vec3(0.1, 1, 0);
  EXPECT_EQ(crossings(pair), 1u) << "a shared edge, folded together";
  pair.positions[3] = Vec3(0.1, 1, 1e-300);
  EXPECT_EQ(crossings(pair), 0u);
  pair.positions[3] = Vec3(0.1, -1, 0);
  EXPECT_EQ(crossings(pair), 0u) << "flat, side by side";
}

TEST(SelfIntersections, CrossingPartsAreFoundAndPlaced) {
  const SurfaceReport report = inspectSurface(joined(cube(), cube(Vec3(0.5, 0.25, 0.125))));
  EXPECT_GT(report.selfIntersections.count, 4u);
  EXPECT_FALSE(report.selfIntersections.more);
  EXPECT_NE(refusal(report, "a.obj")->text().find("pairs of intersecting triangles"), std::string::npos);
}

TEST(SelfIntersections, CountingStopsWithoutQuadraticTime) {
  TriMesh mesh;  // a fan of triangles through one line
  for (int i = 0; i < 3000; ++i) {
    const auto v = static_cast<Index>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {Vec3(-1, i, -1), Vec3(1, 5000 - i, -1), Vec3(0, i, 3 + i)});
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  const SelfIntersections found = findSelfIntersections(mesh.positions, mesh.triangles, {}, 10);
  EXPECT_TRUE(found.more);
  EXPECT_GE(found.pairs, 10u);
  EXPECT_LE(found.pairs, 30u);
}

/// Triangles in general position meet where an edge of one crosses the other.
bool edgesCross(const ExactPoints& points, const Triangle& s, const Triangle& t) {
  for (std::size_t c = 0; c < 3; ++c)
    if (points.crosses(s[c], s[(c + 1) % 3], t) || points.crosses(t[c], t[(c + 1) % 3], s)) return true;
  return false;
}

TEST(SelfIntersections, SeededSoupsAgreeWithAllPairsForAnyThreadCount) {
  Rng rng(11);
  const auto random = [&] { return Vec3(rng.uniform(), rng.uniform(), rng.uniform()); };
  TriMesh mesh;
  for (Index i = 0; i < 1200; ++i) {
    const Vec3 base = 4 * random();
    for (int c = 0; c < 3; ++c) mesh.positions.push_back(base + random());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const ExactPoints points(mesh.positions);
  std::size_t pairs = 0;
  for (std::size_t s = 0; s < mesh.triangles.size(); ++s)
    for (std::size_t t = s + 1; t < mesh.triangles.size(); ++t)
      pairs += edgesCross(points, mesh.triangles[s], mesh.triangles[t]);
  const SelfIntersections all = findSelfIntersections(mesh.positions, mesh.triangles, {}, 1u << 30);
  EXPECT_GT(pairs, 100u);
  EXPECT_EQ(all.pairs, pairs);
  const int limit = threadLimit();
  setThreadLimit(1);
  const SelfIntersections one = findSelfIntersections(mesh.positions, mesh.triangles, {}, 1u << 30);
  setThreadLimit(limit);
  EXPECT_EQ(one.pairs, all.pairs);
  EXPECT_EQ(one.first, all.first);
}

}  // namespace
}  // namespace sherd
