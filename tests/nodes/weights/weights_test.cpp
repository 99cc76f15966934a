#include "weights/weights.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "beta/paint_beta.h"
#include "graph/node_type.h"
#include "support/said.h"
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

/// What is warned of where a dab is painted beside, on or in a box.
std::string warnedOf(const Vec3& box, const Vec3& dab, double radius, double voxel) {
  PaintBetaParams params;
  params.voxel = voxel;
  params.strokes = {{.points = {dab}, .radius = radius, .falloff = 0, .value = 4}};
  const auto beta = paintBeta({}, params, Exec{});
  EXPECT_TRUE(beta.ok());
  EXPECT_FALSE(beta->isConstant());
  const EnergyField e = randomEnergy(families::box(4, 4, 4, box), 11);
  Said said;
  const auto painted = weights(e, &*beta, {}, said.exec);
  EXPECT_TRUE(painted.ok());
  const bool changes = painted.ok() && painted->weight != weighed(e, 1).weight;
  EXPECT_EQ(changes, said.lines.empty()) << "what does nothing is said, and nothing else";
  if (said.lines.empty()) return {};
  EXPECT_EQ(said.lines[0].first, LogLevel::Warning);
  return said.lines[0].second;
}

TEST(Weights, PaintThatMissesTheBodyIsWarnedOfWithBothPlaces) {
  const std::string beside = warnedOf(Vec3(1, 1, 1), Vec3(5, 5, 5), 0.1, 0.01);
  EXPECT_EQ(beside.find("the painted β misses the body, which has 1 everywhere: the paint lies from (4.9"),
            0u)
      << beside;
  EXPECT_TRUE(beside.ends_with(" m, the body from (0, 0, 0) to (1, 1, 1) m")) << beside;
  const std::string millimetres = warnedOf(Vec3(1, 1, 1), Vec3(700, 700, 700), 100, 10);
  EXPECT_NE(millimetres.find("times as large, and divided by 1000 would lie on it: another unit?"),
            std::string::npos)
      << millimetres;
  const std::string small = warnedOf(Vec3(100, 100, 100), Vec3(0.1, 0.2, 0.3), 0.01, 0.002);
  EXPECT_NE(small.find("finer than the tetrahedra"), std::string::npos) << small;
  EXPECT_NE(small.find("or in another unit: it is 0.000"), std::string::npos) << small;
  const std::string thin = warnedOf(Vec3(1, 1, 1), Vec3(0.1, 0.12, 0.11), 0.08, 0.005);
  EXPECT_TRUE(thin.ends_with("finer than the tetrahedra, and fall between their nodes")) << thin;
  const std::string turned = warnedOf(Vec3(2, 1, 0.2), Vec3(1, -0.1, 0.5), 0.05, 0.01);
  EXPECT_NE(turned.find("with y and z exchanged it would lie on it: another axis up?"), std::string::npos)
      << turned;
}

TEST(Weights, PaintThatMeetsTheBodyIsNotWarnedOf) {
  EXPECT_EQ(warnedOf(Vec3(1, 1, 1), Vec3(1, 1, 1), 0.3, 0.02), "");
  EXPECT_EQ(warnedOf(Vec3(1, 1, 1), Vec3(0, 0.5, 0.5), 0.1, 0.02), "") << "one node of many";
  EXPECT_EQ(warnedOf(Vec3(1, 1, 1), Vec3(0.5, 0.5, 0.5), 3, 0.1), "") << "all of it";
  const EnergyField e = randomEnergy(families::box(2, 2, 2, Vec3(1, 1, 1)), 12);
  for (const double value : {1.0, 4.0}) {
    const ScalarGrid constant = ScalarGrid::constant(value);
    Said said;
    EXPECT_TRUE(weights(e, &constant, {}, said.exec).ok());
    EXPECT_TRUE(weights(e, nullptr, {}, said.exec).ok());
    EXPECT_TRUE(said.lines.empty());
  }
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
