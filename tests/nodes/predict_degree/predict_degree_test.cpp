#include "predict_degree/predict_degree.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/rng.h"
#include "cvd/cvd.h"
#include "graph/node_type.h"
#include "support/lloyd_reference.h"
#include "support/said.h"

namespace sherd {
NodeType predictDegreeNode();
namespace {

using reference::Cloud;
using reference::cloud;

Sites search(const Cloud& c, const PredictDegreeParams& params, const Exec& exec = {}) {
  auto result = predictDegree(c.weights, *c.embedding, params, exec);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(result).value();
}

TEST(PredictDegree, AWeakHitBreaksNothingAndSaysSo) {
  const Cloud c = cloud(100, 5, 1);
  const double whole = search(c, {.degree = 1}).energy;
  Said said;
  const Sites s = search(c, {.gamma = whole * 1.001}, said.exec);
  EXPECT_EQ(s.positions.cols(), 1);
  EXPECT_EQ(s.energy, whole);
  EXPECT_TRUE(said.info("does not break: E_D = "));
  EXPECT_EQ(search(c, {.gamma = whole}).positions.cols(), 2);  // below, not at
}

/// E_D at N = 1, 2, … on the search's path.
std::vector<double> path(const Cloud& c, std::size_t most, std::int64_t seed = 1) {
  Lloyd lloyd(*c.embedding, c.weights);
  lloyd.addSite(bodyCentroid(*c.embedding, c.weights), {});
  std::vector<double> energy{lloyd.energy()};
  while (energy.size() < most && growSite(lloyd, *c.embedding, c.weights, Growth::ByEnergy, seed, {}).value())
    energy.push_back(lloyd.energy());
  return energy;
}

TEST(PredictDegree, FindsTheFirstOnItsPathBelowGamma) {
  const Cloud c = cloud(400, 8, 2);
  const std::vector<double> energy = path(c, 30);
  ASSERT_EQ(energy.size(), 30u);
  for (const std::size_t n : {2u, 7u, 19u, 30u}) {
    ASSERT_LT(energy[n - 1], energy[n - 2]);
    Said said;
    const Sites s = search(c, {.gamma = 0.5 * (energy[n - 1] + energy[n - 2])}, said.exec);
    EXPECT_EQ(static_cast<std::size_t>(s.positions.cols()), n);
    EXPECT_LE(s.energy, energy[n - 1]);  // that of the iteration's end
    EXPECT_GT(s.energy, 0.9 * energy[n - 1]);
    EXPECT_EQ(s.energy, search(c, {.degree = static_cast<int>(n)}).energy);
    EXPECT_TRUE(said.info("< γ"));
    EXPECT_FALSE(said.warning(""));
  }
}

TEST(PredictDegree, EnergyNeverRisesInAThousandRandomCases) {
  const Rng rng(11);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto draw = [&](std::uint64_t k, std::uint64_t below) {
      return static_cast<unsigned>(rng.uniformAt(3 * i + k) * static_cast<double>(below));
    };
    const Cloud c = cloud(static_cast<int>(10 + draw(0, 90)), static_cast<int>(1 + draw(1, 12)),
                          static_cast<unsigned>(i));
    const std::vector<double> energy = path(c, 2 + draw(2, 25), static_cast<std::int64_t>(i));
    for (std::size_t n = 1; n < energy.size(); ++n)
      ASSERT_LE(energy[n], energy[n - 1] * (1 + 1e-14)) << "case " << i << ", N = " << n + 1;
  }
}

TEST(PredictDegree, ToughnessLowersTheCount) {
  const Cloud c = cloud(600, 3, 3);
  const double whole = search(c, {.degree = 1}).energy;
  const auto few = search(c, {.gamma = whole / 2}).positions.cols();
  const auto more = search(c, {.gamma = whole / 20}).positions.cols();
  const auto most = search(c, {.gamma = whole / 200}).positions.cols();
  EXPECT_LT(few, more);
  EXPECT_LT(more, most);
}

TEST(PredictDegree, CvdGoesOnFromHereAndFromTheNumberAlone) {
  const Cloud c = cloud(500, 12, 4);
  const double whole = search(c, {.degree = 1}).energy;
  const Sites s = search(c, {.gamma = whole / 8, .seed = 5});
  const auto degree = static_cast<int>(s.positions.cols());
  const auto warm = cvd(c.embedding, c.weights, &s, {.degree = degree}, {});
  const auto cold = cvd(c.embedding, c.weights, nullptr, {.degree = degree, .seed = 5}, {});
  ASSERT_TRUE(warm.ok() && cold.ok());
  EXPECT_EQ(warm->sites, cold->sites);
  EXPECT_EQ(warm->label, cold->label);
  EXPECT_LE(warm->energy, s.energy);
  EXPECT_NEAR(warm->energy, s.energy, 1e-6 * s.energy);
  EXPECT_EQ(warm->gamma, s.gamma);
  EXPECT_LE(warm->iterations, 3);
}

/// The search with nothing left out, to the same bits.
TEST(PredictDegree, SameBitsAsThePlainSearchForAnyThreadCount) {
  for (const auto& [nodes, dimensions, degree] : {std::array{300, 3, 60}, std::array{900, 40, 40}}) {
    const Cloud c = cloud(nodes, dimensions, 6);
    reference::PlainLloyd plain{
        c.embedding->coordinates, c.weights, bodyCentroid(*c.embedding, c.weights), {}, {}};
    plain.assign();
    const Rng random(3, 0x73697465);
    while (plain.sites.cols() < degree) {
      double total = 0, sum = 0;
      for (std::size_t n = 0; n < at(nodes); ++n) total += c.weights.weight[n] * plain.distance2[n];
      const double target = total * random.uniformAt(static_cast<std::uint64_t>(plain.sites.cols()));
      Eigen::Index drawn = 0;
      for (;; ++drawn)
        if ((sum += c.weights.weight[at(static_cast<Index>(drawn))] *
                    plain.distance2[at(static_cast<Index>(drawn))]) > target)
          break;
      plain.sites.conservativeResize(Eigen::NoChange, plain.sites.cols() + 1);
      plain.sites.rightCols(1) = c.embedding->coordinates.col(drawn);
      plain.assign();
      plain.run({.maxIterations = kGrowthPasses}, c.embedding->diameter);
    }
    plain.run({}, c.embedding->diameter);
    for (const int threads : {1, 2, 4}) {
      setThreadLimit(threads);
      const Sites s = search(c, {.degree = degree, .seed = 3});
      EXPECT_EQ(s.positions, plain.sites);
      EXPECT_EQ(s.energy, plain.energy());
    }
    setThreadLimit(0);
  }
}

TEST(PredictDegree, SeedsDecide) {
  const Cloud c = cloud(300, 6, 7);
  EXPECT_EQ(search(c, {.degree = 9, .seed = 1}).positions, search(c, {.degree = 9, .seed = 1}).positions);
  EXPECT_NE(search(c, {.degree = 9, .seed = 1}).positions, search(c, {.degree = 9, .seed = 2}).positions);
}

TEST(PredictDegree, EndsWhereThereAreNoMoreNodesOrSitesAllowed) {
  Cloud c = cloud(20, 3, 8);
  for (int n = 10; n < 20; ++n) c.embedding->coordinates.col(n) = c.embedding->coordinates.col(n - 10);
  Said said;
  EXPECT_EQ(search(c, {.degree = 15}, said.exec).positions.cols(), 10);
  EXPECT_TRUE(said.warning("15 sites were asked for"));
  Said zero;
  EXPECT_EQ(search(c, {.gamma = 0}, zero.exec).positions.cols(), 10);
  EXPECT_TRUE(zero.warning("is not reached: every node that weighs"));
  Said most;
  EXPECT_EQ(search(c, {.gamma = 0, .maxDegree = 4}, most.exec).positions.cols(), 4);
  EXPECT_TRUE(most.warning("max_degree = 4"));
  for (std::size_t n = 0; n < 20; ++n) c.weights.weight[n] = n % 10 < 3 ? 1 : 0;
  EXPECT_LE(search(c, {.gamma = 0}).positions.cols(), 4);
}

TEST(PredictDegree, TellsAGivenDegreeFromAGammaOfZero) {
  const Cloud c = cloud(20, 3, 8);
  const Sites zero = search(c, {.gamma = 0, .maxDegree = 4}), given = search(c, {.gamma = 1, .degree = 4});
  EXPECT_FALSE(zero.degreeGiven);
  EXPECT_EQ(zero.gamma, 0);
  EXPECT_TRUE(given.degreeGiven);
  EXPECT_EQ(given.gamma, 1) << "as the user had it";
  EXPECT_FALSE(search(c, {.gamma = 1}).degreeGiven);
  Sites other = given;
  other.degreeGiven = false;
  Hasher a, b;
  hashValue(a, given);
  hashValue(b, other);
  EXPECT_NE(a.digest().hex(), b.digest().hex());
}

TEST(PredictDegree, Refuses) {
  const Cloud c = cloud(20, 3, 9);
  auto portOf = [&](const PredictDegreeParams& p) {
    const auto r = predictDegree(c.weights, *c.embedding, p, {});
    return r.ok() ? std::string("ok") : r.error().port;
  };
  EXPECT_EQ(portOf({.gamma = -1}), "gamma");
  EXPECT_EQ(portOf({.gamma = NAN}), "gamma");
  EXPECT_EQ(portOf({.degree = -1}), "degree");
  EXPECT_EQ(portOf({.maxDegree = 0}), "max_degree");
  EXPECT_EQ(portOf({.gamma = 1}), "ok");
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto r = predictDegree(c.weights, *c.embedding, {.degree = 5}, exec);
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().kind, Error::Kind::Cancelled);
}

TEST(PredictDegreeNode, PassesOn) {
  const Cloud c = cloud(60, 4, 6);
  const NodeType type = predictDegreeNode();
  ParamValues params;
  for (const ParamInfo& p : type.params) params[p.name] = p.fallback;
  params["gamma"] = search(c, {.degree = 1}).energy / 5;
  const Exec exec;
  NodeIo io(exec);
  io.setInput("weights", Value::of<WeightField>(std::make_shared<const WeightField>(c.weights)));
  io.setInput("embedding", Value::of<Embedding>(c.embedding));
  ASSERT_TRUE(type.run(params, io).ok());
  EXPECT_EQ(type.outputs.front().name, "degree");
  const auto sites = io.output("sites").as<Sites>();
  EXPECT_GT(sites->positions.cols(), 2);
  EXPECT_EQ(*io.output("degree").as<std::int64_t>(), sites->positions.cols());
  EXPECT_EQ(*io.output("energy").as<double>(), sites->energy);
}

}  // namespace
}  // namespace sherd
