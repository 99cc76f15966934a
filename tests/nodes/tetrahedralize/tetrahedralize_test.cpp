#include "tetrahedralize/tetrahedralize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "surfaces.h"

namespace sherd::test {
namespace {

std::string errorOf(TriMesh mesh, const TetrahedralizeParams& params = {.tets = 400}) {
  const auto result = tetrahedralize(shared(std::move(mesh)), params, {});
  return result.ok() ? "" : result.error().text();
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Tetrahedralize, RefusesWhatEnclosesNothing) {
  EXPECT_TRUE(has(errorOf({}), "no triangles"));
  EXPECT_FALSE(tetrahedralize(nullptr, {}, {}).ok());

  TriMesh open = box(Vec3::Zero(), Vec3::Ones());
  open.triangles.pop_back();
  EXPECT_TRUE(has(errorOf(open), "open at the edge near ("));

  TriMesh turned = box(Vec3::Zero(), Vec3::Ones());
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_TRUE(has(errorOf(turned), "oriented against each other"));

  EXPECT_TRUE(has(errorOf(insideOut(box(Vec3::Zero(), Vec3::Ones()))), "inside out"));
  EXPECT_TRUE(has(errorOf(box(Vec3::Zero(), Vec3(1, 1, 0))), "no volume"));

  TriMesh bad = box(Vec3::Zero(), Vec3::Ones());
  bad.positions[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(errorOf(bad), "vertex 4 is not a finite number"));
}

TEST(Tetrahedralize, RefusesNonManifolds) {
  // Two boxes that share a corner vertex, and two that share an edge.
  TriMesh corner = joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3::Ones(), Vec3(2, 2, 2)));
  const auto weld = [](TriMesh& mesh) {
    for (Triangle& t : mesh.triangles)
      for (Index& v : t)
        for (Index u = 0; u < v; ++u)
          if (mesh.positions[at(u)] == mesh.positions[at(v)]) v = u;
  };
  weld(corner);
  EXPECT_TRUE(has(errorOf(corner), "touch in one vertex at (1, 1, 1) m"));
  TriMesh edge = joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3(1, 1, 0), Vec3(2, 2, 1)));
  weld(edge);
  EXPECT_TRUE(has(errorOf(edge), "4 triangles meet at the edge near (1, 1, 0.5) m"));
}

TEST(Tetrahedralize, EnclosesACube) { expectGood(cageOf(box(Vec3(1, 2, 3), Vec3(2, 3, 4)), 500), 1, 2); }

TEST(Tetrahedralize, HitsTheCount) {
  const auto cage = cageOf(sphere(Vec3::Zero(), 1), 1500);
  expectGood(cage, 1, 2);
  EXPECT_NEAR(static_cast<double>(cage->tets.size()), 1500, 225);
  EXPECT_LT(cage->quality.cageVolume, 1.5 * cage->quality.surfaceVolume);
}

TEST(Tetrahedralize, HitsTheEdgeLength) {
  const auto cage = tetrahedralize(shared(sphere(Vec3::Zero(), 1)), {.edgeLength = 0.4}, {});
  expectGood(cage, 1, 2);
  double sum = 0, count = 0;
  for (const Tetra& t : cage->tets)
    for (const auto& e : kTetraEdge) {
      sum += (cage->nodes[at(t[static_cast<std::size_t>(e[0])])] -
              cage->nodes[at(t[static_cast<std::size_t>(e[1])])])
                 .norm();
      ++count;
    }
  EXPECT_NEAR(sum / count, 0.4, 0.06);
}

TEST(Tetrahedralize, RefusesAnEdgeLengthThatWouldFillTheMemory) {
  TetrahedralizeParams params;
  params.edgeLength = 1e-9;
  const auto result =
      tetrahedralize(std::make_shared<const TriMesh>(box(Vec3::Zero(), Vec3(1, 1, 1))), params, Exec{});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "edge_length");
  EXPECT_NE(result.error().text().find("at least"), std::string::npos) << result.error().text();
}

TEST(Tetrahedralize, KeepsAHandle) { expectGood(cageOf(torus(1, 0.4), 600), 1, 0); }

TEST(Tetrahedralize, KeepsAVoid) {
  expectGood(cageOf(joined(sphere(Vec3::Zero(), 1), insideOut(sphere(Vec3(0.1, 0, 0), 0.45))), 800), 1, 4);
}

TEST(Tetrahedralize, KeepsComponentsApart) {
  expectGood(cageOf(joined(sphere(Vec3::Zero(), 1, 12), sphere(Vec3(2.6, 0, 0), 1, 12)), 300), 2, 4);
}

TEST(Tetrahedralize, HoldsAThinPlate) { expectGood(cageOf(box(Vec3::Zero(), Vec3(1, 1, 0.01)), 500), 1, 2); }

TEST(Tetrahedralize, HoldsANeedle) {  // in seconds
  const auto cage = cageOf(box(Vec3::Zero(), Vec3(1, 0.002, 0.002)), 1000);
  expectGood(cage, 1, 2);
}

TEST(Tetrahedralize, NamesTheEdgesThatWouldKeepAGapOpen) {
  EXPECT_TRUE(has(errorOf(slitBlock(0.001)), "edges of about 0.001 m there would keep it open"));
}

TEST(Tetrahedralize, FillsWhatIsThinnerThanItsEdgesSee) {
  TriMesh mesh;  // a tetrahedron a hundredth as thick as long
  mesh.positions = {Vec3(2.89, 6.34, 8.81), Vec3(1.95, 0, 0), Vec3(4.84, 6.32, 10.38), Vec3(0, 7.9, 12.13)};
  for (const auto& face : kTetraFace) mesh.triangles.push_back({face[0], face[1], face[2]});
  for (const int tets : {60, 78, 100}) {
    const auto cage = cageOf(mesh, tets);
    ASSERT_TRUE(cage.ok()) << cage.error().text();
    EXPECT_EQ(defectOf(*cage), "");
    EXPECT_EQ(cageTopology(*cage), std::make_pair(1, 2));
  }
}

TEST(Tetrahedralize, KeepsASlitOpen) {
  const auto cage = cageOf(slitBlock(0.3), 300);
  expectGood(cage, 1, 2);
  // The boundary closed over the slit would hold this point.
  EXPECT_FALSE(holds(*cage, Vec3(0.5, 0.7, 0.25)));
}

TEST(Tetrahedralize, NamesAGapTooNarrow) {
  const std::string error = errorOf(slitBlock(0.001));
  EXPECT_TRUE(has(error, "the gap of 0.001 m near (0.5, ")) << error;
  EXPECT_TRUE(has(error, "widen the gap")) << error;
  EXPECT_TRUE(has(error, "Repair with the mode `rebuild`")) << error;
}

TEST(Tetrahedralize, PlacesAreThoseOfTheFile) {
  TriMesh mesh = slitBlock(0.001);
  mesh.frame = {.metresPerUnit = 0.01, .up = FileFrame::Up::Z};
  const std::string error = errorOf(mesh);
  EXPECT_TRUE(has(error, "the gap of 0.001 m near (50, -")) << error;
}

TEST(Tetrahedralize, IsDeterministic) {
  const TriMesh mesh = slitBlock(0.3);
  setThreadLimit(1);
  const auto first = cageOf(mesh);
  setThreadLimit(0);
  const auto second = cageOf(mesh);
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(first->nodes, second->nodes);
  EXPECT_EQ(first->tets, second->tets);
  EXPECT_EQ(first->held, second->held);
  EXPECT_EQ(first->insideFraction, second->insideFraction);
}

TEST(Tetrahedralize, DoesNotDependOnUnitOrPlace) {
  const TriMesh mesh = torus(1, 0.4);
  const auto metres = cageOf(mesh);
  const auto millimetres = cageOf(mapped(mesh, [](const Vec3& p) { return Vec3(1000 * p); }));
  const auto elsewhere = cageOf(mapped(mesh, [](const Vec3& p) { return Vec3(p + Vec3(64, -128, 32)); }));
  ASSERT_TRUE(metres.ok() && millimetres.ok() && elsewhere.ok());
  EXPECT_EQ(metres->tets, millimetres->tets);
  EXPECT_EQ(metres->tets, elsewhere->tets);
  for (std::size_t n = 0; n < metres->nodes.size(); ++n)
    EXPECT_NEAR((1000 * metres->nodes[n] - millimetres->nodes[n]).norm(), 0, 1e-6);
}

TEST(Tetrahedralize, FractionsAreThoseOfAHalfSpace) {
  // Far from edges a box's face is a plane: a tetrahedron that only it cuts has the closed form's fraction.
  const auto cage = cageOf(box(Vec3::Zero(), Vec3::Ones()), 1500);
  ASSERT_TRUE(cage.ok());
  std::size_t checked = 0;
  for (std::size_t t = 0; t < cage->tets.size(); ++t) {
    std::vector<double> above, below;  // distances of the corners from the plane x = 1
    bool clear = true;
    for (const Index n : cage->tets[t]) {
      const Vec3& p = cage->nodes[at(n)];
      (p.x() > 1 ? above : below).push_back(std::abs(p.x() - 1));
      clear = clear && p.x() > 0 && p.y() > 0 && p.y() < 1 && p.z() > 0 && p.z() < 1;
    }
    if (!clear || above.size() != 1) continue;
    double outside = 1;
    for (const double b : below) outside *= above[0] / (above[0] + b);
    EXPECT_NEAR(cage->insideFraction[t], 1 - outside, 1e-12);
    ++checked;
  }
  EXPECT_GT(checked, 10u);
}

}  // namespace
}  // namespace sherd::test
