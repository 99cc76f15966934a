#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "geometry/tet_share.h"
#include "simulate/statics.h"
#include "support/elastic_loads.h"

using namespace sherd;
using namespace sherd::families;

namespace {

constexpr double kYoung = 5e10;

/// A bar in a cage that its faces cut, and in which no node rests on so little that it is held up.
std::shared_ptr<const TetMesh> cagedBar(const PureBending& bar) {
  const Vec3 size(bar.length, bar.height, bar.width), margin(0.03, 0.02, 0.015);
  const TetMesh block = box(10, 4, 3, size + 2 * margin);
  TetMesh cage = mapped(block, [&](const Vec3& p) { return Vec3(p - margin); });
  cage.surface = box(4, 2, 1, size).surface;
  std::vector<Index> all(cage.surface->triangles.size());
  std::iota(all.begin(), all.end(), 0);
  cage.held.clear();
  cage.heldBegin = {0};
  for (std::size_t t = 0; t < cage.tets.size(); ++t) {
    std::array<Vec3, 4> x;
    for (std::size_t c = 0; c < 4; ++c) x[c] = cage.nodes[at(cage.tets[t][c])];
    const bool lastInside = (x[3].array() > 0).all() && (x[3].array() < size.array()).all();
    const TetShare share(x, cage.surface->positions, cage.surface->triangles);
    cage.insideFraction[t] = std::clamp(share.volume(all, lastInside) / tetVolume(cage, t), 0.0, 1.0);
    cage.held.insert(cage.held.end(), all.begin(), all.end());
    cage.heldBegin.push_back(static_cast<Index>(cage.held.size()));
  }
  return shared(std::move(cage));
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
