#include "predict_degree/calibrate_toughness.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "cvd/cvd.h"
#include "graph/node_type.h"
#include "predict_degree/predict_degree.h"
#include "support/lloyd_reference.h"
#include "support/said.h"

namespace sherd {
NodeType calibrateToughnessNode();
namespace {

using reference::Cloud;
using reference::cloud;

double calibrate(const Cloud& c, int pieces, std::int64_t seed = 1, const Exec& exec = {}) {
  const auto gamma =
      calibrateToughness(c.weights, *c.embedding, nullptr, {.pieces = pieces, .seed = seed}, exec);
  EXPECT_TRUE(gamma.ok()) << (gamma.ok() ? "" : gamma.error().text());
  return gamma.ok() ? *gamma : NAN;
}

int sitesOf(const Cloud& c, double gamma, std::int64_t seed = 1) {
  const auto sites = predictDegree(c.weights, *c.embedding, {.gamma = gamma, .seed = seed}, Exec{});
  EXPECT_TRUE(sites.ok()) << (sites.ok() ? "" : sites.error().text());
  return static_cast<int>(sites->positions.cols());
}

Error refusal(const Cloud& c, const CalibrateToughnessParams& params, const Exec& exec = {}) {
  const auto gamma = calibrateToughness(c.weights, *c.embedding, nullptr, params, exec);
  EXPECT_FALSE(gamma.ok());
  return gamma.ok() ? Error{} : gamma.error();
}

TEST(CalibrateToughness, TwoNodesByHand) {
  // Two nodes of 2 J, 1 m apart: E_D(1) = 2 · 2 J · (½ m)² = 1 J·m² about their middle.
  Cloud c;
  c.embedding->coordinates = Eigen::RowVector2d(0, 1);
  c.weights.weight = {2, 2};
  c.weights.volume = {1, 1};
  reference::measure(*c.embedding);
  EXPECT_DOUBLE_EQ(calibrate(c, 1), 2);
  EXPECT_DOUBLE_EQ(calibrate(c, 2), 0.5);  // E_D(2) = 0
  EXPECT_EQ(sitesOf(c, 2), 1);
  EXPECT_EQ(sitesOf(c, 0.5), 2);
}

TEST(CalibrateToughness, TheSameHitBreaksIntoExactlySoMany) {
  for (const auto& [nodes, dimensions] : {std::pair(400, 3), std::pair(500, 20)}) {
    const Cloud c = cloud(nodes, dimensions, 7);
    for (const int pieces : {1, 2, 3, 5, 20, 60})
      for (const std::int64_t seed : {1, 2, 99}) {
        Said said;
        const double gamma = calibrate(c, pieces, seed, said.exec);
        EXPECT_EQ(sitesOf(c, gamma, seed), pieces) << "seed " << seed;
        EXPECT_TRUE(
            said.info(pieces == 1 ? "doesn't break it with γ = " : "a hit like this one breaks it into "));
        EXPECT_FALSE(said.warning(""));
      }
  }
}

TEST(CalibrateToughness, IsTheGeometricMeanOfTheEndsAndTheyAreSharp) {
  const Cloud c = cloud(300, 6, 3);
  Lloyd lloyd(*c.embedding, c.weights);  // the search's path
  lloyd.addSite(bodyCentroid(*c.embedding, c.weights), {});
  std::vector<double> path{NAN, lloyd.energy()};
  while (path.size() <= 30) {
    ASSERT_TRUE(growSite(lloyd, *c.embedding, c.weights, Growth::ByEnergy, 1, {}).value());
    path.push_back(lloyd.energy());
  }
  for (const int pieces : {2, 9, 30}) {
    const double below = path[at(pieces)], before = path[at(pieces - 1)];
    EXPECT_NEAR(calibrate(c, pieces), std::sqrt(below * before), 1e-14 * before);
    EXPECT_EQ(sitesOf(c, before), pieces);
    EXPECT_GT(sitesOf(c, below), pieces);
  }
}

TEST(CalibrateToughness, MorePiecesAreLessTough) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Cloud c = cloud(300, 4, seed);
    double last = HUGE_VAL;
    for (int pieces = 1; pieces <= 40; ++pieces) {
      const double gamma = calibrate(c, pieces);
      EXPECT_LT(gamma, last) << pieces;
      last = gamma;
    }
  }
}

TEST(CalibrateToughness, AHarderHitBreaksIntoMoreAndAWeakerOneIntoFewer) {
  const Cloud c = cloud(500, 5, 11);
  const double gamma = calibrate(c, 20);
  int last = 1;
  for (const double factor : {0.2, 0.5, 1.0, 2.0, 5.0}) {
    Cloud other = c;
    for (double& w : other.weights.weight) w *= factor;
    const int sites = sitesOf(other, gamma);
    EXPECT_GT(sites, last) << factor;
    if (factor == 1.0) {
      EXPECT_EQ(sites, 20);
    }
    last = sites;
  }
}

TEST(CalibrateToughness, FollowsUnits) {
  Cloud c = cloud(200, 3, 12);
  const double gamma = calibrate(c, 12);
  c.embedding->coordinates *= 1024;  // powers of two: no rounding
  c.embedding->diameter *= 1024;
  for (double& w : c.weights.weight) w *= 0x1p-40;
  EXPECT_EQ(calibrate(c, 12), gamma * 0x1p-20);
}

TEST(CalibrateToughness, AsManyAsThereAreNodesAndNotOneMore) {
  Cloud c = cloud(20, 3, 8);
  EXPECT_EQ(sitesOf(c, calibrate(c, 20)), 20);
  const Error tooMany = refusal(c, {.pieces = 21});
  EXPECT_EQ(tooMany.port, "pieces");
  EXPECT_NE(tooMany.text().find("only 20 nodes"), std::string::npos) << tooMany.text();
  EXPECT_NE(tooMany.text().find("ask for 20 or fewer"), std::string::npos) << tooMany.text();

  // Nodes in one place count once, and those without weight not at all.
  for (int n = 10; n < 20; ++n) c.embedding->coordinates.col(n) = c.embedding->coordinates.col(n - 10);
  EXPECT_NE(refusal(c, {.pieces = 11}).text().find("only 10 nodes"), std::string::npos);
  for (std::size_t n = 0; n < 20; ++n) c.weights.weight[n] = n % 10 < 3 ? 1 : 0;
  EXPECT_EQ(refusal(c, {.pieces = 10}).port, "pieces");
}

TEST(CalibrateToughness, RefusesWhatHasNoAnswer) {
  Cloud c = cloud(30, 3, 9);
  EXPECT_EQ(refusal(c, {.pieces = 0}).port, "pieces");
  EXPECT_EQ(refusal(c, {.pieces = -3}).port, "pieces");
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  EXPECT_EQ(refusal(c, {}, exec).kind, Error::Kind::Cancelled);
  std::fill(c.weights.weight.begin(), c.weights.weight.end(), 0.0);
  for (const int pieces : {1, 5}) {
    const Error none = refusal(c, {.pieces = pieces});
    EXPECT_EQ(none.port, "weights");
    EXPECT_NE(none.text().find("no energy"), std::string::npos) << none.text();
  }
  c.weights.weight[3] = NAN;
  EXPECT_EQ(refusal(c, {}).port, "weights");
}

TEST(CalibrateToughness, SameBitsForAnyThreadCount) {
  const Cloud c = cloud(3000, 12, 13);
  const double gamma = calibrate(c, 25);
  for (const int threads : {1, 2, 4}) {
    setThreadLimit(threads);
    EXPECT_EQ(calibrate(c, 25), gamma);
  }
  setThreadLimit(0);
}

TEST(CalibrateToughnessNode, PassesOn) {
  const Cloud c = cloud(60, 4, 6);
  const NodeType type = calibrateToughnessNode();
  ParamValues params;
  for (const ParamInfo& p : type.params) params[p.name] = p.fallback;
  params["pieces"] = std::int64_t{7};
  params["seed"] = std::int64_t{5};
  const Exec exec;
  NodeIo io(exec);
  io.setInput("weights", Value::of<WeightField>(std::make_shared<const WeightField>(c.weights)));
  io.setInput("embedding", Value::of<Embedding>(c.embedding));
  ASSERT_TRUE(type.run(params, io).ok());
  EXPECT_EQ(*io.output("gamma").as<double>(), calibrate(c, 7, 5));
}

}  // namespace
}  // namespace sherd
