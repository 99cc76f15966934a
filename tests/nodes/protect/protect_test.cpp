#include "protect/protect.h"

#include <gtest/gtest.h>

#include <set>

#include "base/parallel.h"
#include "beta/paint_beta.h"
#include "support/broken_box.h"
#include "support/said.h"
#include "support/tet_families.h"

namespace sherd {
namespace {

using Mesh = std::shared_ptr<const TetMesh>;

ScalarGrid painted(const std::vector<Stroke>& strokes) {
  PaintBetaParams params;
  params.background = 0;
  params.voxel = 0.01;
  params.strokes = strokes;
  const auto grid = paintBeta({}, params, Exec{});
  EXPECT_TRUE(grid.ok()) << (grid.ok() ? "" : grid.error().text());
  return *grid;
}

Stroke dab(const Vec3& place, double radius, double value = 1) {
  return {.points = {place}, .radius = radius, .falloff = 0.2, .value = value, .blend = Blend::Replace};
}

Embedding embedded(const Mesh& mesh) {
  auto e = embed(mesh, {}, Exec{});
  EXPECT_TRUE(e.ok());
  return std::move(e).value();
}

Embedding kept(const Embedding& e, const ScalarGrid& field, const Exec& exec = {}) {
  auto result = protect(e, field, {}, exec);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(result).value();
}

Mesh box() { return families::shared(families::box(10, 10, 10, Vec3(1, 1, 1))); }

TEST(Protect, ARegionHasOnePlaceItsMeanAndNothingElseMoves) {
  const Mesh mesh = box();
  const Embedding before = embedded(mesh);
  Said said;
  const Embedding after =
      kept(before, painted({dab(Vec3(0.3, 0.3, 0.3), 0.2), dab(Vec3(0.8, 0.8, 0.8), 0.12)}), said.exec);
  EXPECT_TRUE(said.info("2 regions protected, "));
  std::set<std::array<double, 3>> places;
  std::size_t moved = 0;
  for (Eigen::Index n = 0; n < after.coordinates.cols(); ++n) {
    if (after.coordinates.col(n) == before.coordinates.col(n)) continue;
    const Vec3 p = after.coordinates.col(n);
    places.insert({p[0], p[1], p[2]});
    ++moved;
    const Vec3& at = mesh->nodes[static_cast<std::size_t>(n)];
    // A node moves only with a tetrahedron that the field reaches into.
    EXPECT_LT(std::min((at - Vec3(0.3, 0.3, 0.3)).norm() - 0.2, (at - Vec3(0.8, 0.8, 0.8)).norm() - 0.12),
              0.18);
  }
  EXPECT_EQ(places.size(), 2u);
  EXPECT_GT(moved, 60u);
  // Symmetric about the dab's centre, which is a node.
  const Vec3 centre = Vec3(0.3, 0.3, 0.3) - Vec3(0.5, 0.5, 0.5);
  EXPECT_LT((Vec3::Map(places.begin()->data()) - centre).norm(), 1e-12);
  EXPECT_EQ(after.tets, mesh);
  EXPECT_EQ(after.metric, before.metric);
  EXPECT_NEAR(after.diameter, before.diameter, 1e-12);
}

TEST(Protect, RegionsThatShareANodeAreOne) {
  const Mesh mesh = box();
  Said said;
  kept(embedded(mesh), painted({dab(Vec3(0.35, 0.5, 0.5), 0.1), dab(Vec3(0.6, 0.5, 0.5), 0.1)}), said.exec);
  EXPECT_TRUE(said.info("1 region protected"));
}

/// A dab on the surface that is smaller than a tetrahedron, far from all nodes, edges' and surface's
/// vertices.
TEST(Protect, SeesPaintBetweenTheVerticesOfALargeTriangle) {
  const auto surface = std::make_shared<const TriMesh>(test::boxMesh(Vec3::Zero(), Vec3(1, 1, 1)));
  const Mesh mesh = test::gridCage(surface, 4);
  const ScalarGrid field = painted({dab(Vec3(0.37, 0.21, 0), 0.06)});
  std::vector<double> atNodes(mesh->nodes.size());
  field.sample(mesh->nodes, atNodes);
  EXPECT_EQ(*std::max_element(atNodes.begin(), atNodes.end()), 0);
  Said said;
  const Embedding after = kept(embedded(mesh), field, said.exec);
  EXPECT_TRUE(said.info("1 region protected"));
  // The large triangles themselves are in many other tetrahedra, which stay.
  const Eigen::MatrixXd& x = after.coordinates;
  std::size_t moved = 0;
  for (std::size_t n = 0; n < mesh->nodes.size(); ++n)
    moved += (x.col(static_cast<Eigen::Index>(n)) - (mesh->nodes[n] - Vec3(0.5, 0.5, 0.5))).norm() > 1e-9;
  EXPECT_GE(moved, 4u);
  EXPECT_LE(moved, 24u);
}

TEST(Protect, NothingAndEverythingAreSaid) {
  const Mesh mesh = box();
  const Embedding before = embedded(mesh);
  Said none, all, weak;
  EXPECT_EQ(kept(before, ScalarGrid::constant(0.25), none.exec).coordinates, before.coordinates);
  EXPECT_TRUE(
      none.warning("nothing is protected: the field stays below 0.5 on the whole body (0.25 at most)"));
  const Embedding away = kept(before, painted({dab(Vec3(0.5, 0.5, 0.5), 0.3, 0.4)}), weak.exec);
  EXPECT_EQ(away.coordinates, before.coordinates);
  EXPECT_EQ(away.diameter, before.diameter);
  EXPECT_TRUE(weak.warning("(0.4 at most)"));
  EXPECT_FALSE(weak.warning("the paint lies"));
  Said beside;
  EXPECT_EQ(kept(before, painted({dab(Vec3(5, 5, 5), 0.3)}), beside.exec).coordinates, before.coordinates);
  EXPECT_TRUE(beside.warning("(0 at most); the paint lies from (4.7"));
  const Embedding one = kept(before, ScalarGrid::constant(1), all.exec);
  EXPECT_TRUE(all.warning("all of the body is protected"));
  for (Eigen::Index n = 1; n < one.coordinates.cols(); ++n)
    ASSERT_EQ(one.coordinates.col(n), one.coordinates.col(0));
}

/// Area of the cracks that reach into what the field protects, m².
double harmTo(const Fragments& f, const ScalarGrid& field) {
  constexpr int kParts = 8;
  std::vector<Vec3> points;
  std::vector<double> areas;
  for (const Piece& piece : f.pieces)
    for (const Triangle& t : piece.crack) {
      areas.push_back(test::areaNormal(f, t).norm());
      const Vec3 &a = f.positions[at(t[0])], &b = f.positions[at(t[1])], &c = f.positions[at(t[2])];
      for (int i = 0; i <= kParts; ++i)
        for (int j = 0; i + j <= kParts; ++j)
          points.push_back((i * a + j * b + (kParts - i - j) * c) / kParts);
    }
  std::vector<double> values(points.size());
  field.sample(points, values);
  const std::size_t each = areas.empty() ? 1 : points.size() / areas.size();
  double harm = 0;
  for (std::size_t t = 0; t < areas.size(); ++t)
    if (*std::max_element(&values[t * each], &values[t * each] + each) >= 0.5) harm += areas[t];
  return harm;
}

class ProtectCells : public testing::TestWithParam<std::tuple<bool, CellMode>> {};

TEST_P(ProtectCells, NoCrackPassesThrough) {
  const auto [interior, cells] = GetParam();
  const auto surface = std::make_shared<const TriMesh>(test::boxMesh(Vec3::Zero(), Vec3(1, 0.8, 0.6)));
  const Mesh mesh = test::gridCage(surface, 12);
  // A face of the body, and a blob within.
  const ScalarGrid field = painted({dab(Vec3(0.4, 0.8, 0.3), 0.2), dab(Vec3(0.75, 0.3, 0.3), 0.12)});
  auto e =
      embed(mesh, {.metric = interior ? EmbedParams::Metric::Interior : EmbedParams::Metric::Auto}, Exec{});
  ASSERT_TRUE(e.ok());
  const auto plain = std::make_shared<const Embedding>(std::move(e).value());
  const auto safe = std::make_shared<const Embedding>(kept(*plain, field));
  const TessellateParams mode{.cells = cells};
  const Fragments broken = test::broken(plain, 150, mode), whole = test::broken(safe, 150, mode);
  EXPECT_GT(harmTo(broken, field), 0.1);
  EXPECT_EQ(harmTo(whole, field), 0);
  EXPECT_GT(whole.pieces.size(), 100u);
}

INSTANTIATE_TEST_SUITE_P(Cases, ProtectCells,
                         testing::Combine(testing::Bool(),
                                          testing::Values(CellMode::Exact, CellMode::Canonical)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param) ? "Interior" : "Straight") +
                                  (std::get<1>(info.param) == CellMode::Exact ? "Exact" : "Canonical");
                         });

TEST(Protect, SameBitsForAnyThreadCount) {
  const Mesh mesh = box();
  const Embedding before = embedded(mesh);
  const ScalarGrid field = painted({dab(Vec3(0.3, 0.3, 0), 0.2)});
  setThreadLimit(1);
  const Embedding one = kept(before, field);
  for (const int threads : {2, 4}) {
    setThreadLimit(threads);
    EXPECT_EQ(kept(before, field).coordinates, one.coordinates);
  }
  setThreadLimit(0);
}

TEST(Protect, Refuses) {
  const Mesh mesh = box();
  const Embedding e = embedded(mesh);
  const auto portOf = [&](const Embedding& embedding, const ScalarGrid& field, double threshold) {
    const auto r = protect(embedding, field, {.threshold = threshold}, Exec{});
    return r.ok() ? std::string("ok") : r.error().port;
  };
  EXPECT_EQ(portOf({}, ScalarGrid::constant(0), 0.5), "embedding");
  Embedding small = e;
  small.coordinates = e.coordinates.leftCols(3);
  EXPECT_EQ(portOf(small, ScalarGrid::constant(0), 0.5), "embedding");
  EXPECT_EQ(portOf(e, ScalarGrid::constant(NAN), 0.5), "field");
  EXPECT_EQ(portOf(e, ScalarGrid::constant(0), NAN), "threshold");
  EXPECT_EQ(portOf(e, ScalarGrid::constant(0), 0.5), "ok");
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto r = protect(e, painted({dab(Vec3(0.5, 0.5, 0), 0.2)}), {}, exec);
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sherd
