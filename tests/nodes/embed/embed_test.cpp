#include "embed/embed.h"

#include <gtest/gtest.h>

#include <random>

#include "base/parallel.h"
#include "geometry/tet_edges.h"
#include "graph/node_type.h"
#include "predict_degree/predict_degree.h"
#include "support/said.h"
#include "support/tet_families.h"

namespace sherd {
NodeType embedNode();
namespace {

using P = EmbedParams;
using Mesh = std::shared_ptr<const TetMesh>;

Embedding embedded(const Mesh& mesh, const P& params = {}, const Exec& exec = {}) {
  auto result = embed(mesh, params, exec);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  EXPECT_TRUE(result->coordinates.allFinite());
  return std::move(result).value();
}

double distance(const Embedding& e, Index a, Index b) {
  return (e.coordinates.col(a) - e.coordinates.col(b)).norm();
}

Index nodeAt(const TetMesh& mesh, const Vec3& p) {
  Index best = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if ((mesh.nodes[n] - p).norm() < (mesh.nodes[at(best)] - p).norm()) best = static_cast<Index>(n);
  return best;
}

/// All choices of the interior metric.
std::vector<P> interiorChoices() {
  std::vector<P> all;
  for (const auto source : {P::Source::Solid, P::Source::Surface, P::Source::Fine})
    for (const auto filter : {P::Filter::Fitted, P::Filter::Diffusion})
      for (const auto extension : {P::Extension::MeanValue, P::Extension::Harmonic})
        all.push_back({.metric = P::Metric::Interior,
                       .source = source,
                       .filter = filter,
                       .extension = extension,
                       .dimensions = 24});
  return all;
}

TEST(Embed, AConvexBodyIsNotEmbedded) {
  const Mesh box = families::shared(families::box(4, 3, 2, Vec3(4, 3, 2)));
  Said said;
  const Embedding e = embedded(box, {}, said.exec);
  EXPECT_EQ(e.metric, Embedding::Metric::Euclidean);
  EXPECT_TRUE(said.info("no embedding is computed"));
  for (std::size_t n = 0; n < box->nodes.size(); ++n)
    EXPECT_LT((e.coordinates.col(static_cast<Eigen::Index>(n)) - (box->nodes[n] - Vec3(2, 1.5, 1))).norm(),
              1e-14);
  EXPECT_NEAR(e.diameter, Vec3(4, 3, 2).norm(), 1e-14);
}

TEST(Embed, AConcaveBodyIsUnlessTold) {
  const Mesh u = families::shared(families::uShape(2, 2, 6, 2, 0.1));
  Said said;
  EXPECT_EQ(embedded(u, {}, said.exec).metric, Embedding::Metric::Interior);
  EXPECT_TRUE(said.info("interior distances in"));
  Said quiet;
  EXPECT_EQ(embedded(u, {.metric = P::Metric::Euclidean}, quiet.exec).coordinates.rows(), 3);
  EXPECT_TRUE(quiet.lines.empty());
  // A dent of 1e-4 of the volume is one.
  TetMesh dented = families::box(4, 4, 4, Vec3(1, 1, 1));
  auto surface = std::make_shared<TriMesh>(*dented.surface);
  for (Vec3& p : surface->positions)
    if (p == Vec3(0.5, 0.5, 1)) p.z() -= 0.005;
  dented.surface = surface;
  EXPECT_EQ(embedded(families::shared(dented)).metric, Embedding::Metric::Interior);
}

TEST(Embed, TheWayAcrossAGapLeadsAround) {
  const Mesh u = families::shared(families::uShape(3, 4, 12, 3, 0.1));
  const Index left = nodeAt(*u, Vec3(0.3, 1.2, 0)), right = nodeAt(*u, Vec3(0.7, 1.2, 0));
  const double gap = (u->nodes[at(left)] - u->nodes[at(right)]).norm();  // 0.4; the way around is 2.2
  for (const P& params : interiorChoices()) {
    const double across = distance(embedded(u, params), left, right);
    EXPECT_GT(across, 3 * gap);
    EXPECT_LT(across, 8 * gap);
  }
  EXPECT_NEAR(distance(embedded(u, {.metric = P::Metric::Euclidean}), left, right), gap, 1e-12);
}

/// Ways in the U's plane: straight where the inner corners let them, otherwise over one or both of these.
TEST(Embed, MatchesGeodesicsOfAU) {
  const Mesh u = families::shared(families::uShape(3, 4, 12, 3, 0.1));
  auto geodesic = [](Vec3 a, Vec3 b) {
    const double depth = a.z() - b.z();
    if (a.x() > b.x()) std::swap(a, b);
    const Vec2 left(0.3, 0.3), right(0.7, 0.3), from = a.head<2>(), to = b.head<2>();
    auto above = [](const Vec2& p, const Vec2& q, const Vec2& c) {  // is the line p–q above c?
      return (q - p).x() * (c - p).y() - (q - p).y() * (c - p).x() < -1e-12;
    };
    auto open = [&](const Vec2& p, const Vec2& q) {
      return !(p.x() < 0.3 + 1e-9 && q.x() > 0.3 + 1e-9 && above(p, q, left)) &&
             !(p.x() < 0.7 - 1e-9 && q.x() > 0.7 - 1e-9 && above(p, q, right));
    };
    const double over = (left - from).norm(), under = (to - right).norm();
    double length = over + 0.4 + under;
    if (open(from, right)) length = std::min(length, (right - from).norm() + under);
    if (open(left, to)) length = std::min(length, over + (to - left).norm());
    if (open(from, to)) length = (to - from).norm();
    return std::hypot(length, depth);
  };
  auto stress = [&](const Embedding& e) {
    double error = 0, size = 0;
    for (std::size_t a = 0; a < u->nodes.size(); ++a)
      for (std::size_t b = a + 1; b < u->nodes.size(); ++b) {
        const double d = geodesic(u->nodes[a], u->nodes[b]);
        error += std::pow(distance(e, static_cast<Index>(a), static_cast<Index>(b)) - d, 2);
        size += d * d;
      }
    return std::sqrt(error / size);
  };
  const double straight = stress(embedded(u, {.metric = P::Metric::Euclidean}));
  const double fitted = stress(embedded(u));
  const double paper = stress(embedded(u, {.source = P::Source::Surface, .filter = P::Filter::Diffusion}));
  RecordProperty("straight", std::to_string(straight));
  RecordProperty("fitted", std::to_string(fitted));
  RecordProperty("diffusion", std::to_string(paper));
  EXPECT_LT(fitted, 0.16);
  EXPECT_LT(fitted, 0.5 * straight);
  EXPECT_LT(fitted, paper);
}

/// Where the surface is the mesh's own border there is nothing to choose between.
TEST(Embed, TheFineSurfaceIsTheCagesWhereTheyAreOne) {
  const Mesh u = families::shared(families::uShape(2, 3, 7, 2, 0.1));
  for (const auto extension : {P::Extension::MeanValue, P::Extension::Harmonic}) {
    P params{.metric = P::Metric::Interior, .source = P::Source::Surface, .extension = extension};
    const Embedding cage = embedded(u, params);
    params.source = P::Source::Fine;
    const Embedding fine = embedded(u, params);
    for (Index n = 1; n < static_cast<Index>(u->nodes.size()); n += 3)
      EXPECT_NEAR(distance(fine, 0, n), distance(cage, 0, n), 1e-6 * cage.diameter);
  }
}

TEST(Embed, MovesWithTheBodyAndGrowsWithIt) {
  const TetMesh u = families::mapped(families::uShape(2, 3, 7, 2, 0.1),
                                     [](const Vec3& p) { return Vec3(p.x(), 1.13 * p.y(), 1.31 * p.z()); });
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mesh still = families::shared(u);
  const Mesh moved =
      families::shared(families::mapped(u, [&](const Vec3& p) -> Vec3 { return turn * p + Vec3(5, -3, 2); }));
  const Mesh grown = families::shared(families::mapped(u, [](const Vec3& p) -> Vec3 { return 1000.0 * p; }));
  for (const P& params : interiorChoices()) {
    const Embedding a = embedded(still, params), b = embedded(moved, params), c = embedded(grown, params);
    for (Index n = 1; n < static_cast<Index>(u.nodes.size()); n += 5) {
      EXPECT_NEAR(distance(b, 0, n), distance(a, 0, n), 1e-6 * a.diameter);
      EXPECT_NEAR(distance(c, 0, n), 1000 * distance(a, 0, n), 1e-3 * a.diameter);
    }
  }
}

TEST(Embed, DiffusionMatchesEdgeLengthsInTheLeastSquaresSense) {
  const Mesh u = families::shared(families::uShape(2, 3, 7, 2, 0.1));
  for (const auto source : {P::Source::Solid, P::Source::Surface, P::Source::Fine}) {
    const Embedding e = embedded(u, {.source = source, .filter = P::Filter::Diffusion});
    double product = 0, square = 0;
    for (const auto& [a, b] : tetEdges(u->tets)) {
      product += distance(e, a, b) * (u->nodes[at(a)] - u->nodes[at(b)]).norm();
      square += std::pow(distance(e, a, b), 2);
    }
    EXPECT_NEAR(product / square, 1, 1e-12);
  }
}

TEST(Embed, GammaHasOneMeaningForBothMetrics) {
  const Mesh box = families::shared(families::box(9, 6, 6, Vec3(1.5, 1, 1)));
  WeightField w{box, {}, lumpedVolumes(*box), lumpedVolumes(*box)};
  const Embedding straight = embedded(box), inside = embedded(box, {.metric = P::Metric::Interior});
  const auto whole = predictDegree(w, straight, {.degree = 1}, {});
  ASSERT_TRUE(whole.ok());
  for (const double share : {8.0, 15.0, 25.0}) {
    const PredictDegreeParams params{.gamma = whole->energy / share};
    const auto a = predictDegree(w, straight, params, {}), b = predictDegree(w, inside, params, {});
    ASSERT_TRUE(a.ok() && b.ok());
    const auto n = static_cast<double>(a->positions.cols());
    EXPECT_NEAR(static_cast<double>(b->positions.cols()), n, 0.15 * n);
  }
}

TEST(Embed, PartsStandApart) {
  const Mesh two = families::shared(families::twoBoxes(3, 2, 0.1));
  for (const P& params : interiorChoices()) {
    const Embedding e = embedded(two, params);
    const double size = boxOf(two->nodes).diagonal();
    for (std::size_t a = 0; a < two->nodes.size(); a += 3)
      for (std::size_t b = 0; b < two->nodes.size(); b += 3) {
        const bool same = (two->nodes[a].x() < 0.4) == (two->nodes[b].x() < 0.4);
        const double d = distance(e, static_cast<Index>(a), static_cast<Index>(b));
        if (same)
          EXPECT_LT(d, 2 * size);
        else
          EXPECT_GE(d, 2 * size);
      }
  }
}

TEST(Embed, AVoidsShellHangsTogetherWithTheOuterOne) {
  const Mesh hollow = families::shared(families::hollowBox(6, 2, 0.1));
  Said said;
  const Embedding e = embedded(hollow, {.source = P::Source::Surface}, said.exec);
  EXPECT_TRUE(said.info("void"));
  const double wall = distance(e, nodeAt(*hollow, Vec3(0, 0.3, 0.3)), nodeAt(*hollow, Vec3(0.2, 0.3, 0.3)));
  EXPECT_GT(wall, 0.1);
  EXPECT_LT(wall, 0.4);
}

TEST(Embed, SmallestBodies) {
  const Mesh one = families::shared(families::withOwnSurface(
      {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, {Tetra{0, 1, 2, 3}}));
  for (const P& params : interiorChoices()) EXPECT_GT(embedded(one, params).diameter, 0.3);
  EXPECT_EQ(embedded(one).metric, Embedding::Metric::Euclidean);
}

TEST(Embed, ARestShapeThatIsTheBodyChangesNoBit) {
  for (const Mesh& mesh : {families::shared(families::box(4, 3, 2, Vec3(4, 3, 2))),
                           families::shared(families::uShape(2, 3, 7, 2, 0.1))}) {
    const RestShape same{mesh, mesh->nodes};
    for (P params : interiorChoices())
      for (const auto metric : {P::Metric::Auto, P::Metric::Interior, P::Metric::Euclidean}) {
        params.metric = metric;
        const auto with = embed(mesh, params, {}, {.rest = &same});
        ASSERT_TRUE(with.ok());
        const Embedding without = embedded(mesh, params);
        EXPECT_EQ(with->coordinates, without.coordinates);
        EXPECT_EQ(with->diameter, without.diameter);
      }
  }
}

TEST(Embed, StraightDistancesAreThoseOfTheRestShape) {
  const Mesh box = families::shared(families::box(4, 3, 2, Vec3(4, 3, 2)));
  RestShape rest{box, box->nodes};
  for (Vec3& p : rest.positions)
    p = Vec3(p.y() + std::sin(p.z()), -2 * p.x(), p.z() * p.z());  // inside out, too
  Said said;
  const auto e = embed(box, {}, said.exec, {.rest = &rest});
  ASSERT_TRUE(e.ok());
  EXPECT_EQ(e->metric, Embedding::Metric::Euclidean) << "the body as it is is convex";
  EXPECT_FALSE(said.warning("inside out"));
  for (Index n = 1; n < static_cast<Index>(box->nodes.size()); ++n)
    EXPECT_NEAR(distance(*e, 0, n), (rest.positions[at(n)] - rest.positions[0]).norm(), 1e-13);
}

/// Bent with distances inside: as the bent body itself has them.
TEST(Embed, InteriorDistancesAreThoseOfTheRestShape) {
  const TetMesh u = families::uShape(2, 3, 7, 2, 0.1);
  const auto bend = [](const Vec3& p) { return Vec3(1.5 * p.x() + 0.1 * p.y(), p.y(), 0.7 * p.z()); };
  const Mesh straight = families::shared(u), bent = families::shared(families::mapped(u, bend));
  const RestShape rest{straight, bent->nodes};
  for (const P& params : interiorChoices()) {
    if (params.source == P::Source::Fine) continue;  // refused, below
    const auto a = embed(straight, params, {}, {.rest = &rest});
    ASSERT_TRUE(a.ok());
    const Embedding b = embedded(bent, params);
    for (Index n = 1; n < static_cast<Index>(u.nodes.size()); n += 5)
      EXPECT_NEAR(distance(*a, 0, n), distance(b, 0, n), 1e-9 * b.diameter);
  }
}

TEST(Embed, RestShapesHaveNoFineSurface) {
  const Mesh mesh = families::shared(families::uShape(2, 3, 7, 2, 0.1));
  RestShape rest{mesh, mesh->nodes};
  const P fine{.source = P::Source::Fine};
  EXPECT_TRUE(embed(mesh, fine, {}, {.rest = &rest}).ok());  // as it is
  for (Vec3& p : rest.positions) p.x() *= 2;
  const auto refused = embed(mesh, fine, {}, {.rest = &rest});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().text().find("choose source: solid or surface"), std::string::npos);
}

TEST(Embed, TetrahedraInsideOutCountAsTheirMirrorImages) {
  const TetMesh u = families::uShape(2, 3, 7, 2, 0.1);
  const Mesh mesh = families::shared(u);
  RestShape mirrored{mesh, u.nodes};
  for (Vec3& p : mirrored.positions) p.x() = -p.x();
  for (const P& params : interiorChoices()) {
    if (params.source == P::Source::Fine) continue;
    Said said;
    const auto a = embed(mesh, params, said.exec, {.rest = &mirrored});
    ASSERT_TRUE(a.ok()) << a.error().text();
    EXPECT_TRUE(said.warning(std::to_string(u.tets.size()) + " of " + std::to_string(u.tets.size())));
    const Embedding b = embedded(mesh, params);
    for (Index n = 1; n < static_cast<Index>(u.nodes.size()); n += 5)
      EXPECT_NEAR(distance(*a, 0, n), distance(b, 0, n), 1e-6 * b.diameter);
  }
}

TEST(Embed, SameBitsForAnyThreadCount) {
  const Mesh u = families::shared(families::uShape(3, 3, 9, 3, 0.1));
  for (const P& params : interiorChoices()) {
    setThreadLimit(1);
    const Embedding one = embedded(u, params);
    for (const int threads : {2, 4}) {
      setThreadLimit(threads);
      EXPECT_EQ(embedded(u, params).coordinates, one.coordinates);
    }
  }
  setThreadLimit(0);
}

TEST(Embed, Refuses) {
  const Mesh box = families::shared(families::box(2, 2, 2, Vec3(1, 1, 1)));
  auto portOf = [](const Mesh& mesh, const P& params) {
    const auto r = embed(mesh, params, {});
    return r.ok() ? std::string("ok") : r.error().port;
  };
  EXPECT_EQ(portOf(nullptr, {}), "tets");
  EXPECT_EQ(portOf(families::shared({}), {}), "tets");
  TetMesh broken = *box;
  broken.nodes[3].y() = NAN;
  EXPECT_EQ(portOf(families::shared(broken), {}), "tets");
  EXPECT_EQ(portOf(box, {.dimensions = 0}), "dimensions");
  EXPECT_EQ(portOf(box, {.tolerance = 1}), "tolerance");
  EXPECT_EQ(portOf(box, {.time = 0}), "time");
  EXPECT_EQ(portOf(box, {}), "ok");
  const Mesh other = families::shared(families::box(2, 2, 1, Vec3(1, 1, 1)));
  const RestShape ofOther{other, other->nodes};
  RestShape nowhere{box, box->nodes};
  nowhere.positions[2].x() = NAN;
  for (const RestShape* rest : std::initializer_list<const RestShape*>{&ofOther, &nowhere}) {
    const auto refused = embed(box, {}, {}, {.rest = rest});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().port, "rest");
  }
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto r = embed(box, {.metric = P::Metric::Interior}, exec);
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().kind, Error::Kind::Cancelled);
}

TEST(EmbedNode, PassesOn) {
  const Mesh box = families::shared(families::box(2, 2, 2, Vec3(1, 1, 1)));
  const NodeType type = embedNode();
  ParamValues params;
  for (const ParamInfo& p : type.params) params[p.name] = p.fallback;
  const Exec exec;
  NodeIo io(exec);
  io.setInput("tets", Value::of<TetMesh>(box));
  ASSERT_TRUE(type.run(params, io).ok());
  EXPECT_EQ(io.output("embedding").as<Embedding>()->coordinates, embedded(box).coordinates);
}

}  // namespace
}  // namespace sherd
