#include "cvd/pin_sites.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "cvd/cvd.h"
#include "graph/node_type.h"
#include "support/lloyd_reference.h"
#include "support/said.h"
#include "support/tet_families.h"

namespace sherd {
NodeType pinSitesNode();
namespace {

using reference::Cloud;
using reference::cloud;
using reference::PlainLloyd;

/// A box of 1 × 0.5 × 0.5 m whose embedding is an affine map of its nodes into four dimensions.
struct Body {
  std::shared_ptr<const TetMesh> tets = families::shared(families::box(8, 4, 4, Vec3(1, 0.5, 0.5)));
  Eigen::Matrix<double, 4, 3> map;
  Embedding embedding;

  Body() {
    map << 1, 0, 0, 0, 1, 0.5, 0, -1, 1, 2, 0.3, 0;
    embedding.tets = tets;
    embedding.metric = Embedding::Metric::Interior;
    embedding.coordinates.resize(4, static_cast<Eigen::Index>(tets->nodes.size()));
    for (std::size_t n = 0; n < tets->nodes.size(); ++n)
      embedding.coordinates.col(static_cast<Eigen::Index>(n)) = at(tets->nodes[n]);
    reference::measure(embedding);
  }
  Eigen::Vector4d at(const Vec3& x) const { return map * x + Eigen::Vector4d(3, 0, -1, 0.5); }
};

Sites pinned(const Embedding& embedding, std::vector<Vec3> points, const Exec& exec = {}) {
  auto sites = pinSites(embedding, {.points = std::move(points)}, exec);
  EXPECT_TRUE(sites.ok()) << (sites.ok() ? "" : sites.error().text());
  return sites.ok() ? std::move(*sites) : Sites{};
}

TEST(PinSites, InterpolatesLinearly) {
  const Body body;
  const std::vector<Vec3> points{{0.5, 0.25, 0.25}, {0.013, 0.4, 0.077}, {0.99, 0.49, 0.01},
                                 {0, 0, 0},         {0.3, 0.5, 0.2},     {1, 0.5, 0.5}};
  Said said;
  const Sites sites = pinned(body.embedding, points, said.exec);
  EXPECT_EQ(sites.pinned, 6);
  EXPECT_TRUE(sites.degreeGiven);
  ASSERT_EQ(sites.positions.cols(), 6);
  for (int j = 0; j < 6; ++j)
    EXPECT_LT((sites.positions.col(j) - body.at(points[static_cast<std::size_t>(j)])).norm(), 1e-14) << j;
  EXPECT_FALSE(said.warning(""));
}

TEST(PinSites, OutsideTakesTheNearestNodeAndSaysHowFar) {
  const Body body;
  Said said;
  const Sites sites =
      pinned(body.embedding, {{0.5, 0.25, 0.25}, {1.25, 0.5, 0.5}, {0.5, -0.1, 0.25}}, said.exec);
  EXPECT_EQ(sites.positions.col(1), body.at(Vec3(1, 0.5, 0.5)));
  EXPECT_EQ(sites.positions.col(2), body.at(Vec3(0.5, 0, 0.25)));
  EXPECT_TRUE(
      said.warning("pin 2 at (1.25, 0.5, 0.5) m lies outside the body; the nearest node, 0.25 m away"));
  EXPECT_TRUE(said.warning("pin 3"));
  EXPECT_FALSE(said.warning("pin 1"));
}

TEST(PinSites, WarnsOfPinsAtOnePlace) {
  const Body body;
  Said said;
  const Sites sites =
      pinned(body.embedding, {{0.5, 0.25, 0.25}, {0.1, 0.1, 0.1}, {0.5, 0.25, 0.25}}, said.exec);
  EXPECT_EQ(sites.positions.cols(), 3);
  EXPECT_TRUE(said.warning("pins 1 and 3 are at the same place"));
  EXPECT_EQ(said.lines.size(), 1u);
}

TEST(PinSites, Refuses) {
  const Body body;
  const auto portOf = [&](const Embedding& e, std::vector<Vec3> points) {
    const auto sites = pinSites(e, {.points = std::move(points)}, Exec{});
    return sites.ok() ? std::string("ok") : sites.error().port;
  };
  EXPECT_EQ(portOf(body.embedding, {}), "points");
  EXPECT_EQ(portOf(body.embedding, {{0, NAN, 0}}), "points");
  EXPECT_EQ(portOf(Embedding{}, {{0, 0, 0}}), "embedding");
  Embedding broken = body.embedding;
  broken.coordinates(2, 3) = NAN;
  EXPECT_EQ(portOf(broken, {{0, 0, 0}}), "embedding");
  broken.coordinates = broken.coordinates.leftCols(4).eval();
  EXPECT_EQ(portOf(broken, {{0, 0, 0}}), "embedding");
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto cancelled = pinSites(body.embedding, {.points = {{0, 0, 0}}}, exec);
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().kind, Error::Kind::Cancelled);
}

/// Sites at places near some of a cloud's nodes, the first `pins` of them pinned.
Sites sitesNear(const Cloud& c, const std::vector<int>& nodes, int pins) {
  Sites s;
  s.positions.resize(c.embedding->coordinates.rows(), static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t j = 0; j < nodes.size(); ++j)
    s.positions.col(static_cast<Eigen::Index>(j)) = 0.9 * c.embedding->coordinates.col(nodes[j]);
  s.degreeGiven = true;
  s.pinned = pins;
  return s;
}

Partition partition(const Cloud& c, const CvdParams& params, const Sites& start, const Exec& exec = {}) {
  auto result = cvd(c.embedding, c.weights, &start, params, exec);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return result.ok() ? std::move(*result) : Partition{};
}

void expectNearest(const Cloud& c, const Partition& p) {
  PlainLloyd plain{c.embedding->coordinates, c.weights, p.sites, {}, {}};
  plain.assign();
  EXPECT_EQ(plain.label, p.label);
  EXPECT_EQ(plain.energy(), p.energy);
}

TEST(PinnedCells, PinsKeepTheirBitsAndTheOthersAreCentroids) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Cloud c = cloud(300, 8, seed);
    const Sites start = sitesNear(c, {5, 50, 100, 150, 200, 250, 299}, 3);
    const Partition p = partition(c, {}, start);
    EXPECT_EQ(p.sites.leftCols(3), start.positions.leftCols(3));
    EXPECT_NE(p.sites.rightCols(4), start.positions.rightCols(4));
    expectNearest(c, p);
    PlainLloyd plain{c.embedding->coordinates, c.weights, p.sites, {}, {}};
    plain.assign();
    plain.move();
    EXPECT_LE((plain.sites - p.sites).rightCols(4).colwise().norm().maxCoeff(), 1e-7 * c.embedding->diameter);
    EXPECT_GT((plain.sites - p.sites).leftCols(3).colwise().norm().minCoeff(), 1e-3 * c.embedding->diameter);
  }
}

TEST(PinnedCells, FloodingKeepsThemToo) {
  const Body body;
  const auto shared = std::make_shared<const Embedding>(body.embedding);
  WeightField w{body.tets, {}, std::vector<double>(body.tets->nodes.size(), 1.0), lumpedVolumes(*body.tets)};
  const Sites pins = pinned(body.embedding, {{0.2, 0.2, 0.2}, {0.8, 0.1, 0.4}});
  const auto p = cvd(shared, w, &pins, {.degree = 6, .labels = Labels::Flood}, Exec{});
  ASSERT_TRUE(p.ok());
  EXPECT_EQ(p->sites.leftCols(2), pins.positions);
  EXPECT_EQ(p->siteCount(), 6u);
}

TEST(PinnedCells, GrowthGoesOnFromThemAndEnergyNeverRises) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Cloud c = cloud(250, 6, seed);
    const int count = 1 + static_cast<int>(seed) % 4;
    std::vector<int> nodes;
    for (int j = 0; j < count; ++j) nodes.push_back(j * 61 % 250);
    const Sites pins = sitesNear(c, nodes, count);
    Lloyd lloyd = firstSites(*c.embedding, c.weights, &pins, Exec{});
    for (int n = count; n <= 25; ++n) {
      const Partition p = partition(c, {.degree = n, .seed = seed}, pins);
      ASSERT_EQ(p.siteCount(), static_cast<std::size_t>(n));
      EXPECT_EQ(p.sites.leftCols(count), pins.positions);
      const double grown = lloyd.energy();
      EXPECT_LE(p.energy, grown * (1 + 1e-12)) << n;
      ASSERT_TRUE(growSite(lloyd, *c.embedding, c.weights, Growth::ByVolume, seed, Exec{}).ok());
      EXPECT_LE(lloyd.energy(), grown * (1 + 1e-12)) << n;
    }
  }
}

TEST(PinnedCells, FewerSitesAreGrownAnewFromThePins) {
  const Cloud c = cloud(200, 5, 3);
  const Sites many = sitesNear(c, {0, 20, 40, 60, 80, 100}, 2), pins = sitesNear(c, {0, 20}, 2);
  Said said;
  EXPECT_EQ(partition(c, {.degree = 4}, many, said.exec).sites, partition(c, {.degree = 4}, pins).sites);
  EXPECT_TRUE(said.info("grown anew from those pinned"));
  EXPECT_EQ(partition(c, {.degree = 2}, many).sites, pins.positions);
}

TEST(PinnedCells, ASinglePinStays) {
  const Cloud c = cloud(50, 3, 1);
  const Sites pin = sitesNear(c, {7}, 1);
  EXPECT_EQ(partition(c, {}, pin).sites, pin.positions);
  EXPECT_EQ(partition(c, {.degree = 1}, pin).sites, pin.positions);
}

TEST(PinnedCells, MorePinsThanSitesAreRefusedAndPinsWithoutNodesNamed) {
  const Cloud c = cloud(100, 3, 2);
  Sites pins = sitesNear(c, {1, 2, 3, 4}, 4);
  const auto few = cvd(c.embedding, c.weights, &pins, {.degree = 3}, Exec{});
  ASSERT_FALSE(few.ok());
  EXPECT_EQ(few.error().port, "degree");
  EXPECT_NE(few.error().text().find("4 sites are pinned, but only 3 are wanted"), std::string::npos);
  for (const int wrong : {-1, 5}) {
    pins.pinned = wrong;
    EXPECT_FALSE(cvd(c.embedding, c.weights, &pins, {}, Exec{}).ok());
  }
  Sites twice = sitesNear(c, {1, 30, 30}, 3);
  Said said;
  const Partition p = partition(c, {}, twice, said.exec);
  EXPECT_EQ(p.siteCount(), 3u);
  EXPECT_TRUE(said.warning("pin 3 gets no cell"));
  EXPECT_FALSE(said.warning("pin 2"));
  expectNearest(c, p);
}

TEST(PinnedCells, WithoutPinsNothingChanges) {
  const Cloud c = cloud(300, 7, 6);
  const Sites start = sitesNear(c, {5, 50, 100, 150}, 0);
  PlainLloyd plain{c.embedding->coordinates, c.weights, start.positions, {}, {}};
  plain.assign();
  plain.run({}, c.embedding->diameter);
  EXPECT_EQ(partition(c, {}, start).sites, plain.sites);
}

TEST(PinnedCells, SameBitsForAnyThreadCount) {
  const Cloud c = cloud(2000, 20, 8);
  const Sites pins = sitesNear(c, {3, 600, 1500}, 3);
  const Partition first = partition(c, {.degree = 30}, pins);
  for (const int threads : {1, 2, 4}) {
    setThreadLimit(threads);
    const Partition again = partition(c, {.degree = 30}, pins);
    EXPECT_EQ(again.sites, first.sites);
    EXPECT_EQ(again.label, first.label);
  }
  setThreadLimit(0);
}

TEST(PinSitesNode, ReadsPoints) {
  const NodeType type = pinSitesNode();
  const auto accepts = [&](const char* json) { return type.params.front().accepts(json); };
  EXPECT_TRUE(accepts("[]").ok());
  EXPECT_TRUE(accepts("[[0, 1, 2.5]]").ok());
  for (const char* wrong :
       {"{}", "[0, 1, 2]", "[[0, 1]]", "[[0, 1, \"2\"]]", "[[0, 1, 2, 3]]", "[null]", "nonsense"})
    EXPECT_FALSE(accepts(wrong).ok()) << wrong;
  EXPECT_NE(accepts("[[0, 0, 0], 7]").error().text().find("point 2"), std::string::npos);

  const Body body;
  ParamValues params;
  params["points"] = std::string("[[0.5, 0.25, 0.25], [0.1, 0.2, 0.3]]");
  const Exec exec;
  NodeIo io(exec);
  io.setInput("embedding", Value::of<Embedding>(std::make_shared<const Embedding>(body.embedding)));
  ASSERT_TRUE(type.run(params, io).ok());
  const auto sites = io.output("sites").as<Sites>();
  EXPECT_EQ(sites->pinned, 2);
  EXPECT_LT((sites->positions.col(1) - body.at(Vec3(0.1, 0.2, 0.3))).norm(), 1e-14);
}

}  // namespace
}  // namespace sherd
