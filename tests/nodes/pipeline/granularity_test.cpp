// What α and γ do, measured: whether the pieces' sizes follow the energy, and how many there are.
#include <gtest/gtest.h>

#include <numeric>

#include "cvd/cvd.h"
#include "embed/embed.h"
#include "predict_degree/calibrate_toughness.h"
#include "predict_degree/predict_degree.h"
#include "simulate/simulate.h"
#include "support/tet_families.h"
#include "weights/weights.h"

namespace sherd {
namespace {

/// Each value's place among all, ties in their middle.
std::vector<double> ranksOf(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(begin + end - 1);
  }
  return ranks;
}

/// Spearman's rank correlation, in [−1, 1].
double rankCorrelation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranksOf(a), y = ranksOf(b);
  const double mean = 0.5 * static_cast<double>(a.size() - 1);
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean) * (y[i] - mean);
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
  }
  return xy / std::sqrt(xx * yy);
}

TEST(Granularity, RankCorrelationOfKnownSamples) {
  EXPECT_NEAR(rankCorrelation({1, 2, 3, 4}, {10, 20, 25, 1000}), 1, 1e-15);
  EXPECT_NEAR(rankCorrelation({1, 2, 3, 4}, {5, 3, 2, -7}), -1, 1e-15);
  EXPECT_NEAR(rankCorrelation({1, 2, 3, 4}, {2, 1, 1, 2}), 0, 1e-15);
}

/// A wall that a ball has hit, off its middle.
struct HitWall {
  std::shared_ptr<const TetMesh> tets = families::shared(families::box(24, 20, 3, Vec3(1.02, 0.84, 0.12)));
  std::shared_ptr<const Embedding> embedding;
  EnergyField energy;

  HitWall() {
    auto metric = embed(tets, {}, Exec{});
    EXPECT_TRUE(metric.ok());
    embedding = std::make_shared<const Embedding>(std::move(*metric));
    SimulateParams params;
    params.scene = RigidScene::Ball;
    params.standing = true;
    params.ballRadius = 0.05;
    params.ballSpeed = 20;
    params.ballDirection = Vec3(0, 0, -1);
    params.ballTarget = Vec3(0.35, 0.6, 0.5);
    auto hit = simulate(tets, params, Exec{});
    EXPECT_TRUE(hit.ok()) << (hit.ok() ? "" : hit.error().text());
    energy = std::move(hit->energy);
  }
  WeightField weighted(double alpha) const {
    auto field = weights(energy, nullptr, {.alpha = alpha}, Exec{});
    EXPECT_TRUE(field.ok());
    return std::move(*field);
  }
  std::size_t sitesBelow(const WeightField& w, double gamma) const {
    const auto sites = predictDegree(w, *embedding, {.gamma = gamma}, Exec{});
    EXPECT_TRUE(sites.ok());
    return static_cast<std::size_t>(sites->positions.cols());
  }
  /// Of the pieces' volumes and the density of energy in them. Without those at the wall's outline, which are
  /// a little smaller than others in any such diagram and lie where there is little energy.
  double sizeAgainstEnergy(double alpha, std::size_t degree, std::int64_t seed) const {
    const WeightField w = weighted(alpha);
    const auto cells = cvd(embedding, w, nullptr, {.degree = static_cast<int>(degree), .seed = seed}, Exec{});
    EXPECT_TRUE(cells.ok());
    std::vector<double> volume(degree, 0), stored(degree, 0), volumes, densities;
    std::vector<char> atOutline(degree, 0);
    for (std::size_t n = 0; n < w.volume.size(); ++n) {
      const std::size_t cell = at(cells->label[n]);
      const Vec3& x = tets->nodes[n];
      volume[cell] += w.volume[n];
      stored[cell] += energy.nodeEnergy[n];
      atOutline[cell] |= x.x() < 1e-6 || x.x() > 1.02 - 1e-6 || x.y() < 1e-6 || x.y() > 0.84 - 1e-6;
    }
    for (std::size_t c = 0; c < degree; ++c)
      if (!atOutline[c]) volumes.push_back(volume[c]), densities.push_back(stored[c] / volume[c]);
    EXPECT_GT(volumes.size(), degree / 3);
    return rankCorrelation(volumes, densities);
  }
};

TEST(Granularity, SizesFollowTheEnergyByAlpha) {
  const HitWall wall;
  constexpr int kSeeds = 8;
  const auto mean = [&](double alpha) {
    double sum = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) sum += wall.sizeAgainstEnergy(alpha, 80, seed);
    return sum / kSeeds;
  };
  const double none = mean(0), half = mean(0.5), full = mean(1);
  RecordProperty("alpha_0", std::to_string(none));
  RecordProperty("alpha_0.5", std::to_string(half));
  RecordProperty("alpha_1", std::to_string(full));
  EXPECT_LT(std::abs(none), 0.2) << none;
  EXPECT_LT(half, none - 0.1) << half;
  EXPECT_LT(full, -0.6) << full;
}

TEST(Granularity, TenAndAHundredTimesTheToughnessGiveFallingCounts) {
  const HitWall wall;
  const WeightField w = wall.weighted(1);
  const auto gamma = calibrateToughness(w, *wall.embedding, nullptr, {.pieces = 100}, Exec{});
  ASSERT_TRUE(gamma.ok());
  const std::size_t fragile = wall.sitesBelow(w, *gamma), tough = wall.sitesBelow(w, 10 * *gamma),
                    toughest = wall.sitesBelow(w, 100 * *gamma);
  EXPECT_EQ(fragile, 100u);
  EXPECT_LT(tough, fragile / 3);
  EXPECT_LT(toughest, tough);
  EXPECT_EQ(wall.sitesBelow(w, 1e4 * *gamma), 1u);
}

}  // namespace
}  // namespace sherd
