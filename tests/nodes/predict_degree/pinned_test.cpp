// The search for the degree, and toughness by example, around sites that are pinned by hand.
#include <gtest/gtest.h>

#include "cvd/cvd.h"
#include "graph/node_type.h"
#include "predict_degree/calibrate_toughness.h"
#include "predict_degree/predict_degree.h"
#include "support/lloyd_reference.h"
#include "support/said.h"

namespace sherd {
NodeType predictDegreeNode();
namespace {

using reference::Cloud;
using reference::cloud;

Sites pinsAt(const Cloud& c, const std::vector<int>& nodes) {
  Sites pins;
  pins.positions.resize(c.embedding->coordinates.rows(), static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t j = 0; j < nodes.size(); ++j)
    pins.positions.col(static_cast<Eigen::Index>(j)) = 0.95 * c.embedding->coordinates.col(nodes[j]);
  pins.degreeGiven = true;
  pins.pinned = pins.positions.cols();
  return pins;
}

Sites search(const Cloud& c, const Sites* pins, const PredictDegreeParams& params, const Exec& exec = {}) {
  auto result = predictDegree(c.weights, *c.embedding, pins, params, exec);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return result.ok() ? std::move(*result) : Sites{};
}

TEST(PinnedSearch, PinsComeFirstAndCount) {
  const Cloud c = cloud(300, 6, 2);
  const Sites pins = pinsAt(c, {10, 120, 240});
  const double whole = search(c, nullptr, {.degree = 1}).energy;
  for (const double gamma : {whole / 3, whole / 10, whole / 30}) {
    const Sites s = search(c, &pins, {.gamma = gamma});
    EXPECT_EQ(s.pinned, 3);
    EXPECT_GE(s.positions.cols(), 3);
    EXPECT_EQ(s.positions.leftCols(3), pins.positions);
    EXPECT_LT(s.energy, gamma);
  }
  const Sites given = search(c, &pins, {.degree = 9});
  EXPECT_EQ(given.positions.cols(), 9);
  EXPECT_EQ(given.positions.leftCols(3), pins.positions);
  EXPECT_EQ(search(c, &pins, {.degree = 3}).positions, pins.positions);
}

TEST(PinnedSearch, FindsTheFirstBelowGammaAndNeverRises) {
  const Cloud c = cloud(300, 8, 4);
  const Sites pins = pinsAt(c, {10, 150});
  Lloyd lloyd = firstSites(*c.embedding, c.weights, &pins, Exec{});
  std::vector<double> energy{HUGE_VAL, HUGE_VAL, lloyd.energy()};
  for (int n = 3; n <= 20; ++n) {
    ASSERT_TRUE(growSite(lloyd, *c.embedding, c.weights, Growth::ByEnergy, 1, Exec{}).ok());
    energy.push_back(lloyd.energy());
    EXPECT_LE(energy[at(n)], energy[at(n) - 1] * (1 + 1e-12));
  }
  const double whole = search(c, nullptr, {.degree = 1}).energy;
  for (const std::size_t n : {5u, 12u, 20u}) {
    const double gamma = 0.5 * (energy[n] + energy[n - 1]);
    ASSERT_LT(gamma, whole);
    EXPECT_EQ(static_cast<std::size_t>(search(c, &pins, {.gamma = gamma}).positions.cols()), n);
  }
}

TEST(PinnedSearch, AWeakHitBreaksNothingInSpiteOfPins) {
  const Cloud c = cloud(200, 5, 3);
  const Sites pins = pinsAt(c, {1, 2, 3});
  const Sites whole = search(c, nullptr, {.degree = 1});
  Said said;
  const Sites s = search(c, &pins, {.gamma = whole.energy * 1.001}, said.exec);
  EXPECT_EQ(s.positions, whole.positions);
  EXPECT_EQ(s.pinned, 0);
  EXPECT_TRUE(said.info("does not break"));
  EXPECT_GE(search(c, &pins, {.gamma = whole.energy}).positions.cols(), 3);
}

TEST(PinnedSearch, CvdGoesOnFromIt) {
  const Cloud c = cloud(300, 5, 5);
  const Sites pins = pinsAt(c, {30, 60});
  const Sites s = search(c, &pins, {.degree = 12, .seed = 4});
  const auto warm = cvd(c.embedding, c.weights, &s, {}, {});
  const auto cold = cvd(c.embedding, c.weights, &pins, {.degree = 12, .seed = 4}, {});
  ASSERT_TRUE(warm.ok() && cold.ok());
  EXPECT_EQ(warm->sites.leftCols(2), pins.positions);
  EXPECT_EQ(warm->sites, cold->sites);
  EXPECT_EQ(warm->label, cold->label);
}

TEST(PinnedSearch, Refuses) {
  const Cloud c = cloud(60, 4, 6);
  const Sites pins = pinsAt(c, {1, 2, 3, 4});
  const auto portOf = [&](const Sites& p, const PredictDegreeParams& params) {
    const auto r = predictDegree(c.weights, *c.embedding, &p, params, {});
    return r.ok() ? std::string("ok") : r.error().port;
  };
  EXPECT_EQ(portOf(pins, {.degree = 4}), "ok");
  EXPECT_EQ(portOf(pins, {.degree = 3}), "degree");
  EXPECT_EQ(portOf(pins, {.gamma = 0, .maxDegree = 3}), "max_degree");
  EXPECT_EQ(portOf(search(c, nullptr, {.degree = 5}), {}), "pinned");  // none of these is
  Sites other = pins;
  other.positions.conservativeResize(3, Eigen::NoChange);
  EXPECT_EQ(portOf(other, {}), "pinned");
  other = pins;
  other.positions(0, 0) = NAN;
  EXPECT_EQ(portOf(other, {}), "pinned");
  other = pins;
  other.pinned = 5;
  EXPECT_EQ(portOf(other, {}), "pinned");
}

TEST(PinnedToughness, TheSameHitBreaksIntoExactlySoManyAroundThePins) {
  const Cloud c = cloud(400, 6, 9);
  for (const std::vector<int>& nodes : {std::vector{50}, std::vector{50, 200, 350}}) {
    const Sites pins = pinsAt(c, nodes);
    for (const int pieces : {1, 8, 30}) {
      const auto gamma = calibrateToughness(c.weights, *c.embedding, &pins, {.pieces = pieces}, Exec{});
      ASSERT_TRUE(gamma.ok()) << gamma.error().text();
      EXPECT_EQ(search(c, &pins, {.gamma = *gamma}).positions.cols(), pieces);
    }
  }
  const Sites three = pinsAt(c, {50, 200, 350});
  const auto two = calibrateToughness(c.weights, *c.embedding, &three, {.pieces = 2}, Exec{});
  ASSERT_FALSE(two.ok());
  EXPECT_EQ(two.error().port, "pieces");
  const Sites none = search(c, nullptr, {.degree = 3});
  EXPECT_EQ(calibrateToughness(c.weights, *c.embedding, &none, {}, Exec{}).error().port, "pinned");
}

TEST(PinnedSearchNode, PassesOn) {
  const Cloud c = cloud(60, 4, 6);
  const Sites pins = pinsAt(c, {5, 25});
  const NodeType type = predictDegreeNode();
  ParamValues params;
  for (const ParamInfo& p : type.params) params[p.name] = p.fallback;
  params["degree"] = std::int64_t{6};
  const Exec exec;
  NodeIo io(exec);
  io.setInput("weights", Value::of<WeightField>(std::make_shared<const WeightField>(c.weights)));
  io.setInput("embedding", Value::of<Embedding>(c.embedding));
  io.setInput("pinned", Value::of<Sites>(std::make_shared<const Sites>(pins)));
  ASSERT_TRUE(type.run(params, io).ok());
  EXPECT_EQ(io.output("sites").as<Sites>()->positions, search(c, &pins, {.degree = 6}).positions);
}

}  // namespace
}  // namespace sherd
