#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "simulate/statics.h"
#include "support/caged_boxes.h"
#include "support/elastic_loads.h"

using namespace sherd;
using namespace sherd::families;

namespace {

constexpr double kYoung = 5e10;

Vec3 sizeOf(const PureBending& bar) { return Vec3(bar.length, bar.height, bar.width); }

/// A bar in a cage that its faces cut, and in which no node rests on so little that it is held up.
std::shared_ptr<const TetMesh> cagedBar(const PureBending& bar) {
  return shared(cagedBox(10, 4, 3, sizeOf(bar), Vec3(0.03, 0.02, 0.015)));
}

/// Saint-Venant's, quadratic in space.
std::vector<Vec3> bent(const PureBending& bar, double poisson, const std::vector<Vec3>& nodes) {
  std::vector<Vec3> u;
  for (const Vec3& p : nodes) {
    const double x = p.x(), y = p.y() - bar.height / 2, z = p.z() - bar.width / 2;
    u.push_back(bar.curvature * Vec3(x * y, -0.5 * (x * x + poisson * (y * y - z * z)), -poisson * y * z));
  }
  return u;
}

TEST(CutElements, BendLikeTheBodyInsideThem) {
  const PureBending bar;
  const auto cage = cagedBar(bar);
  for (const double poisson : {0.0, 0.3}) {
    const Result<Statics> statics = Statics::factor(cage, {poisson, ElementOrder::Quadratic}, {});
    ASSERT_TRUE(statics.ok()) << statics.error().text();
    const std::vector<Vec3> u = bent(bar, poisson, statics->elements()->positions(cage->nodes));
    const std::vector<double> energy = statics->tetEnergies(u, kYoung);
    const double exact = bar.energy(kYoung);
    EXPECT_NEAR(std::accumulate(energy.begin(), energy.end(), 0.0), exact, 1e-10 * exact);
    // And what is found for the forces that it takes.
    const StaticSolution found = statics->solve(statics->internalForce(u, kYoung), kYoung);
    EXPECT_NEAR(found.work, exact, 1e-9 * exact);
    for (std::size_t t = 0; t < energy.size(); ++t)
      EXPECT_NEAR(found.tetEnergy[t], energy[t], 1e-8 * exact) << t;
  }
}

/// What holds up nodes that nothing of the body reaches to is glued to it, and must not stiffen it.
TEST(CutElements, BendInAWideCageToo) {
  const PureBending bar;
  const auto cage = shared(cagedBox(12, 9, 9, sizeOf(bar), Vec3(0.3, 0.6, 0.5)));
  const Result<Statics> statics = Statics::factor(cage, {0.3, ElementOrder::Quadratic}, {});
  ASSERT_TRUE(statics.ok()) << statics.error().text();
  const std::vector<Vec3> u = bent(bar, 0.3, statics->elements()->positions(cage->nodes));
  const double exact = bar.energy(kYoung);
  const std::vector<Vec3> force = statics->internalForce(u, kYoung);
  const std::vector<double> energy = statics->tetEnergies(u, kYoung);
  double around = 0;
  for (std::size_t t = 0; t < energy.size(); ++t)
    if (cage->insideFraction[t] == 0) around += energy[t];
  EXPECT_LT(around, 0.04 * exact);
  EXPECT_NEAR(statics->solve(force, kYoung).work, exact, 0.04 * exact);
}

/// Linear elements: the volume inside is all that counts.
TEST(CutElements, StretchLikeTheBodyInsideThem) {
  const PureBending bar;
  const auto cage = cagedBar(bar);
  for (const ElementOrder order : {ElementOrder::Linear, ElementOrder::Quadratic}) {
    const Result<Statics> statics = Statics::factor(cage, {0.3, order}, {});
    ASSERT_TRUE(statics.ok()) << statics.error().text();
    std::vector<Vec3> u;
    for (const Vec3& p : statics->elements()->positions(cage->nodes))
      u.push_back(1e-4 * Vec3(p.x(), -0.3 * p.y(), -0.3 * p.z()));
    const std::vector<double> energy = statics->tetEnergies(u, kYoung);
    const double exact = 0.5 * kYoung * 1e-8 * bar.length * bar.height * bar.width;
    EXPECT_NEAR(std::accumulate(energy.begin(), energy.end(), 0.0), exact, 1e-10 * exact);
  }
}

}  // namespace
