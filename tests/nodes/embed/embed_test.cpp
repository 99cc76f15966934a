#include "embed/embed.h"

#include <gtest/gtest.h>

#include <random>

#include "base/parallel.h"
#include "geometry/tet_edges.h"
#include "graph/node_type.h"
#include "predict_degree/predict_degree.h"
#include "support/plan_geodesics.h"
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
    for (const auto filter : {P::Filter::Unfolded, P::Filter::Fitted, P::Filter::Diffusion})
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
/// Root mean square error of distances over that of shortest ways, after the best scaling.
double stressOf(const Embedding& e, const families::PlanGeodesics& ways) {
  const std::vector<Vec3>& nodes = e.tets->nodes;
  std::vector<std::vector<double>> reach;
  for (const Vec3& p : nodes) reach.push_back(ways.reach(p));
  double product = 0, square = 0, size = 0;
  for (std::size_t a = 0; a < nodes.size(); a += 2)
    for (std::size_t b = a + 1; b < nodes.size(); b += 3) {
      const double length = ways.length(nodes[a], reach[a], nodes[b], reach[b]);
      const double d = distance(e, static_cast<Index>(a), static_cast<Index>(b));
      product += d * length;
      square += d * d;
      size += length * length;
    }
  return std::sqrt(std::max(0.0, 1 - product * product / (square * size)));
}

TEST(PlanGeodesics, OfAUAndARing) {
  const families::PlanGeodesics u({{"#.#", "#.#", "###"}, 1});
  const auto between = [](const families::PlanGeodesics& ways, const Vec3& a, const Vec3& b) {
    return ways.length(a, ways.reach(a), b, ways.reach(b));
  };
  EXPECT_DOUBLE_EQ(between(u, {0, 0, 0}, {3, 0, 1}), std::hypot(3, 1));  // along the bridge
  EXPECT_DOUBLE_EQ(between(u, {1, 3, 0}, {2, 3, 0}), 2 + 1 + 2);         // down, over, up
  EXPECT_DOUBLE_EQ(between(u, {0, 3, 0}, {3, 3, 1}), std::hypot(2 * std::sqrt(5) + 1, 1));
  EXPECT_DOUBLE_EQ(between(u, {0, 3, 0}, {1, 0, 0}), std::sqrt(10));
  const families::PlanGeodesics ring({{"###", "#.#", "###"}, 1});
  EXPECT_DOUBLE_EQ(between(ring, {1, 1, 0}, {2, 2, 0}), 2);  // along the hole's border
  EXPECT_DOUBLE_EQ(between(ring, {0, 1.5, 0}, {3, 1.5, 0}), 1 + 2 * std::hypot(1, 0.5));
}

TEST(Embed, UnfoldedMatchesShortestWaysInside) {
  struct Case {
    families::Plan plan;
    double most;  ///< stress; no flat space holds a ring's distances
  };
  for (const auto& [plan, most] :
       {Case{families::refined({{"#..", "#..", "###"}, 1}, 3), 0.035},
        Case{families::refined({{"#.#", "#.#", "#.#", "###"}, 1}, 3), 0.04},
        Case{families::refined({{"####", "#..#", "#..#", "####"}, 1}, 2), 0.09},
        Case{{{"#######", "......#", "#####.#", "#...#.#", "#.###.#", "#.....#", "#######"}, 1}, 0.05}}) {
    const Mesh mesh = families::shared(plan.mesh());
    const families::PlanGeodesics ways(plan);
    const double unfolded = stressOf(embedded(mesh), ways);
    EXPECT_LT(unfolded, most) << plan.rows[0];
    EXPECT_LT(unfolded, 0.85 * stressOf(embedded(mesh, {.metric = P::Metric::Euclidean}), ways));
    EXPECT_LT(unfolded, stressOf(embedded(mesh, {.filter = P::Filter::Diffusion}), ways));
    EXPECT_LT(unfolded, 1.1 * stressOf(embedded(mesh, {.filter = P::Filter::Fitted}), ways));
  }
}

/// A bent plate has the distances of the flat one.
TEST(Embed, BendingAPlateChangesNoDistance) {
  const auto plate = [](double bend) {
    return families::shared(families::mapped(families::box(24, 8, 1, Vec3(3, 1, 0.06)), [=](const Vec3& p) {
      if (bend == 0) return p;
      const double angle = bend * (p.x() / 3 - 0.5), radius = 3 / bend + 0.03 - p.z();
      return Vec3(radius * std::sin(angle), p.y(), -radius * std::cos(angle));
    }));
  };
  const Mesh flat = plate(0), bent = plate(3.5);
  const Embedding e = embedded(bent, {.metric = P::Metric::Interior});
  double error = 0, straight = 0, size = 0;
  for (std::size_t a = 0; a < flat->nodes.size(); a += 7)
    for (std::size_t b = a + 1; b < flat->nodes.size(); b += 5) {
      const double d = (flat->nodes[a] - flat->nodes[b]).norm();
      error += std::pow(distance(e, static_cast<Index>(a), static_cast<Index>(b)) - d, 2);
      straight += std::pow((bent->nodes[a] - bent->nodes[b]).norm() - d, 2);
      size += d * d;
    }
  EXPECT_LT(std::sqrt(error / size), 0.06);
  EXPECT_GT(std::sqrt(straight / size), 0.2);
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
