// The metric under a painted stretch.
#include <gtest/gtest.h>

#include "beta/paint_beta.h"
#include "embed/embed.h"
#include "support/broken_box.h"
#include "support/said.h"
#include "support/tet_families.h"

namespace sherd {
namespace {

using P = EmbedParams;
using Mesh = std::shared_ptr<const TetMesh>;

ScalarGrid painted(std::vector<Vec3> points, double radius, double value) {
  PaintBetaParams params;
  params.voxel = 0.01;
  params.strokes = {{.points = std::move(points), .radius = radius, .falloff = 0.3, .value = value}};
  const auto grid = paintBeta({}, params, Exec{});
  EXPECT_TRUE(grid.ok()) << (grid.ok() ? "" : grid.error().text());
  return *grid;
}

Embedding embedded(const Mesh& mesh, const P& params, const ScalarGrid* stretch, const Exec& exec = {}) {
  auto e = embed(mesh, params, exec, {.stretch = stretch});
  EXPECT_TRUE(e.ok()) << (e.ok() ? "" : e.error().text());
  EXPECT_TRUE(e->coordinates.allFinite());
  return std::move(e).value();
}

std::vector<P> choices() {
  std::vector<P> all;
  for (const auto source : {P::Source::Solid, P::Source::Surface})
    for (const auto filter : {P::Filter::Fitted, P::Filter::Diffusion})
      all.push_back({.metric = P::Metric::Interior, .source = source, .filter = filter, .dimensions = 24});
  return all;
}

TEST(Stretch, OfOneChangesNoBit) {
  const ScalarGrid one = ScalarGrid::constant(1);
  const Mesh u = families::shared(families::uShape(2, 3, 7, 2, 0.1));
  const Mesh box = families::shared(families::box(3, 3, 3, Vec3(1, 1, 1)));
  for (const P& params : choices())
    EXPECT_EQ(embedded(u, params, &one).coordinates, embedded(u, params, nullptr).coordinates);
  for (const auto metric : {P::Metric::Auto, P::Metric::Euclidean}) {
    const Embedding e = embedded(box, {.metric = metric}, &one);
    EXPECT_EQ(e.coordinates, embedded(box, {.metric = metric}, nullptr).coordinates);
    EXPECT_EQ(e.metric, Embedding::Metric::Euclidean);
  }
}

TEST(Stretch, TheSameEverywhereIsAScale) {
  const ScalarGrid two = ScalarGrid::constant(2), three = ScalarGrid::constant(3);
  const Mesh u = families::shared(families::uShape(2, 3, 7, 2, 0.1));
  for (const P& params : choices()) {
    const Embedding twice = embedded(u, params, &two), thrice = embedded(u, params, &three);
    for (Eigen::Index n = 1; n < twice.coordinates.cols(); n += 5)
      EXPECT_NEAR((thrice.coordinates.col(n) - thrice.coordinates.col(0)).norm(),
                  1.5 * (twice.coordinates.col(n) - twice.coordinates.col(0)).norm(), 1e-5 * twice.diameter);
  }
}

/// s = 4 in the middle third of a bar: that much longer is the way from end to end.
TEST(Stretch, ABandPullsApartWhatIsBesideIt) {
  const Mesh bar = families::shared(families::box(30, 2, 2, Vec3(3, 0.2, 0.2)));
  const ScalarGrid field = painted({Vec3(1, 0.1, 0.1), Vec3(2, 0.1, 0.1)}, 0.25, 4);
  const Embedding e = embedded(bar, {}, &field);
  std::vector<double> s(3001);
  std::vector<Vec3> line;
  for (int i = 0; i <= 3000; ++i) line.emplace_back(0.001 * i, 0.1, 0.1);
  field.sample(line, s);
  double length = 0;
  for (const double here : s) length += 0.001 * here;
  Eigen::Index left = 0, right = 0;
  for (std::size_t n = 0; n < bar->nodes.size(); ++n) {
    if ((bar->nodes[n] - Vec3(0, 0.1, 0.1)).norm() < 1e-9) left = static_cast<Eigen::Index>(n);
    if ((bar->nodes[n] - Vec3(3, 0.1, 0.1)).norm() < 1e-9) right = static_cast<Eigen::Index>(n);
  }
  EXPECT_GT(length, 7);  // 3 as it is
  EXPECT_NEAR((e.coordinates.col(left) - e.coordinates.col(right)).norm(), length, 0.12 * length)
      << "what is taken for the zigzag of paths is a tenth of their length";
}

TEST(Stretch, AConvexBodyIsEmbeddedThenAndStraightDistancesRefuse) {
  const Mesh box = families::shared(families::box(6, 6, 2, Vec3(0.6, 0.6, 0.2)));
  const ScalarGrid field = painted({Vec3(0.3, 0, 0.1), Vec3(0.3, 0.6, 0.1)}, 0.15, 4);
  EXPECT_EQ(embedded(box, {}, &field).metric, Embedding::Metric::Interior);
  const auto straight = embed(box, {.metric = P::Metric::Euclidean}, Exec{}, {.stretch = &field});
  ASSERT_FALSE(straight.ok());
  EXPECT_EQ(straight.error().port, "metric");
}

TEST(Stretch, OutOfRangeIsRefusedAndAMissIsSaid) {
  const Mesh box = families::shared(families::box(3, 3, 3, Vec3(1, 1, 1)));
  for (const double bad : {0.0, -1.0, 1e-4, 2000.0, double{NAN}, double{INFINITY}}) {
    const ScalarGrid field = ScalarGrid::constant(bad);
    const auto e = embed(box, {}, Exec{}, {.stretch = &field});
    ASSERT_FALSE(e.ok()) << bad;
    EXPECT_EQ(e.error().port, "stretch");
  }
  Said said;
  const ScalarGrid missed = painted({Vec3(5, 5, 5)}, 0.1, 4);
  EXPECT_EQ(embedded(box, {}, &missed, said.exec).metric, Embedding::Metric::Euclidean);
  EXPECT_TRUE(said.warning("strokes miss it; the paint lies from (4.9"));
}

/// Share of the cracks' area that lies within `radius` of the segment from a to b, by their centroids.
double shareNear(const Fragments& f, const Vec3& a, const Vec3& b, double radius) {
  double near = 0, all = 0;
  for (const Piece& piece : f.pieces)
    for (const Triangle& t : piece.crack) {
      const Vec3 p = (f.positions[at(t[0])] + f.positions[at(t[1])] + f.positions[at(t[2])]) / 3;
      const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      const double area = test::areaNormal(f, t).norm();
      all += area;
      if ((p - a - along * (b - a)).norm() < radius) near += area;
    }
  return near / all;
}

TEST(Stretch, DrawsCracksToACurve) {
  const auto surface = std::make_shared<const TriMesh>(test::boxMesh(Vec3::Zero(), Vec3(1, 0.8, 0.1)));
  const Mesh plate = test::gridCage(surface, 14);
  const Vec3 a(0.2, 0.1, 0.05), b(0.8, 0.7, 0.05);
  const double radius = 0.1;
  const ScalarGrid field = painted({a, b}, radius, 6);
  for (const int degree : {6, 14}) {
    const double plain = shareNear(test::broken(plate, degree, {}), a, b, radius);
    const double drawn = shareNear(test::broken(plate, degree, {.stretch = &field}), a, b, radius);
    RecordProperty("plain_" + std::to_string(degree), std::to_string(plain));
    RecordProperty("drawn_" + std::to_string(degree), std::to_string(drawn));
    EXPECT_GT(drawn, 1.5 * plain);
  }
}

}  // namespace
}  // namespace sherd
