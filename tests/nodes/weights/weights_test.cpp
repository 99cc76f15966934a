#include "weights/weights.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "graph/node_type.h"
#include "support/tet_families.h"

namespace sherd {
NodeType weightsNode();
namespace {

EnergyField randomEnergy(TetMesh mesh, unsigned seed, double unit = 1) {
  std::mt19937 random(seed);
  EnergyField field;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    field.nodeEnergy.push_back(unit * std::uniform_real_distribution<>(0.01, 1)(random));
  field.tets = families::shared(std::move(mesh));
  return field;
}

double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

WeightField weighed(const EnergyField& e, double alpha, const ScalarGrid* beta = nullptr) {
  auto result = weights(e, beta, {alpha}, {});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(result).value();
}

TEST(Weights, AlphaOneIsTheEnergyItself) {
  const EnergyField e = randomEnergy(families::box(3, 2, 2, Vec3(1, 2, 1)), 1);
  const WeightField w = weighed(e, 1);
  for (std::size_t n = 0; n < e.nodeEnergy.size(); ++n)
    EXPECT_NEAR(w.weight[n], e.nodeEnergy[n], 1e-13 * e.nodeEnergy[n]);
  EXPECT_EQ(w.tets, e.tets);
}

TEST(Weights, AlphaZeroIsTheVolumeEvenWhereThereIsNoEnergy) {
  EnergyField e = randomEnergy(families::box(3, 2, 2, Vec3(1, 2, 1)), 2);
  e.nodeEnergy[4] = 0;  // 0⁰ = 1
  const WeightField w = weighed(e, 0);
  const double perVolume = sum(e.nodeEnergy) / sum(w.volume);
  for (std::size_t n = 0; n < w.weight.size(); ++n)
    EXPECT_NEAR(w.weight[n], perVolume * w.volume[n], 1e-12 * w.weight[n]);
}

TEST(Weights, EveryAlphaKeepsTheAmountOfEnergyInEveryUnit) {
  for (const double unit : {1e-300, 1e-9, 1.0, 1e290})
    for (const double alpha : {0.0, 0.5, 1.0, 2.0, 4.0}) {
      const EnergyField e = randomEnergy(families::box(3, 2, 2, Vec3(1e-3, 2e-3, 1e-3)), 3, unit);
      EXPECT_NEAR(sum(weighed(e, alpha).weight) / sum(e.nodeEnergy), 1, 1e-12) << unit << " " << alpha;
    }
}

TEST(Weights, AlphaTwoFavoursDensity) {
  EnergyField e = randomEnergy(families::box(2, 2, 2, Vec3(1, 1, 1)), 4);
  const WeightField w = weighed(e, 2);
  double factor = 0;
  for (std::size_t n = 0; n < w.weight.size(); ++n) {
    const double density = e.nodeEnergy[n] / w.volume[n];
    const double here = w.weight[n] / (w.volume[n] * density * density);
    if (n == 0) factor = here;
    EXPECT_NEAR(here, factor, 1e-12 * factor);
  }
}

TEST(Weights, NoEnergyIsLegal) {
  EnergyField e = randomEnergy(families::box(1, 1, 1, Vec3(1, 1, 1)), 5);
  std::fill(e.nodeEnergy.begin(), e.nodeEnergy.end(), 0.0);
  for (const double alpha : {0.0, 1.0}) EXPECT_EQ(sum(weighed(e, alpha).weight), 0);
}

TEST(Weights, NodesOutsideTheSurfaceWeighNothing) {
  TetMesh mesh = families::twoBoxes(1, 1, 1.0);
  for (std::size_t t = 0; t < 6; ++t) mesh.insideFraction[t] = 0;  // the first box
  EnergyField e = randomEnergy(std::move(mesh), 6);
  for (std::size_t n = 0; n < 8; ++n) e.nodeEnergy[n] = 0;
  for (const double alpha : {0.0, 1.0, 3.0}) {
    const WeightField w = weighed(e, alpha);
    for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(w.weight[n], 0);
    EXPECT_NEAR(sum(w.weight), sum(e.nodeEnergy), 1e-12);
  }
}

TEST(Weights, ConstantBetaMultipliesAfterTheRescaling) {
  const EnergyField e = randomEnergy(families::box(2, 2, 2, Vec3(1, 1, 1)), 7);
  const ScalarGrid four = ScalarGrid::constant(4);
  const WeightField plain = weighed(e, 2), fragile = weighed(e, 2, &four);
  for (std::size_t n = 0; n < plain.weight.size(); ++n) EXPECT_EQ(fragile.weight[n], 4 * plain.weight[n]);
}

TEST(Weights, RefusesWhatIsNoAmountAndNamesThePlace) {
  EnergyField e = randomEnergy(families::box(2, 1, 1, Vec3(2, 1, 1)), 8);
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), HUGE_VAL}) {
    EnergyField broken = e;
    broken.nodeEnergy[3] = bad;
    const auto result = weights(broken, nullptr, {}, {});
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().what.find("node 3"), std::string::npos) << result.error().what;
    EXPECT_EQ(result.error().port, "energy");

    const ScalarGrid beta = ScalarGrid::constant(bad);
    const auto painted = weights(e, &beta, {}, {});
    ASSERT_FALSE(painted.ok());
    EXPECT_EQ(painted.error().port, "beta");
    EXPECT_NE(painted.error().what.find("node 0 (0, 0, 0)"), std::string::npos) << painted.error().what;
  }
  EnergyField shorter = e;
  shorter.nodeEnergy.pop_back();
  EXPECT_FALSE(weights(shorter, nullptr, {}, {}).ok());
  EXPECT_FALSE(weights({}, nullptr, {}, {}).ok());
  EXPECT_FALSE(weights(e, nullptr, {-0.1}, {}).ok());
  EXPECT_FALSE(weights(e, nullptr, {4.1}, {}).ok());
  EXPECT_TRUE(weights(e, nullptr, {4}, {}).ok());
}

TEST(WeightsNode, PassesOn) {
  const EnergyField e = randomEnergy(families::box(2, 1, 1, Vec3(2, 1, 1)), 9);
  const NodeType type = weightsNode();
  const Exec exec;
  NodeIo io(exec);
  io.setInput("energy", Value::of<EnergyField>(std::make_shared<const EnergyField>(e)));
  ASSERT_TRUE(type.run({{"alpha", 0.5}}, io).ok());
  const auto out = io.output("weights").as<WeightField>();
  ASSERT_TRUE(out);
  EXPECT_EQ(out->weight, weighed(e, 0.5).weight);
}

}  // namespace
}  // namespace sherd
