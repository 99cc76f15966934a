#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/rng.h"
#include "simulate/simulate.h"
#include "simulate/statics.h"
#include "simulate/supernodal_solve.h"
#include "support/elastic_loads.h"

using namespace sherd;
using namespace sherd::families;

namespace {

using Shared = std::shared_ptr<const TetMesh>;
constexpr double kYoung = 5e10;

Statics factored(const Shared& mesh, const StaticsParams& params) {
  Result<Statics> statics = Statics::factor(mesh, params, {});
  EXPECT_TRUE(statics.ok()) << (statics.ok() ? "" : statics.error().text());
  return std::move(statics).value();
}

std::vector<std::vector<Vec3>> anyForces(std::size_t count, std::size_t nodes) {
  Rng rng(41);
  std::vector<std::vector<Vec3>> forces(count, std::vector<Vec3>(nodes));
  for (std::vector<Vec3>& force : forces)
    for (Vec3& f : force) f = Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5) * 1e4;
  return forces;
}

void expectSameBits(const StaticSolution& a, const StaticSolution& b) {
  EXPECT_EQ(a.displacement, b.displacement);
  EXPECT_EQ(a.tetEnergy, b.tetEnergy);
  EXPECT_EQ(a.work, b.work);
}

/// A small dense factor by hand, against substitution column by column.
TEST(SupernodalSolve, SolvesForEveryLaneWhatOneLoadGets) {
  // Two supernodes: columns 0-1 with rows 0, 1, 3; column 2-4 with rows 2, 3, 4.
  const int column[] = {0, 2, 5}, rowBegin[] = {0, 3, 6}, valueBegin[] = {0, 6}, row[] = {0, 1, 3, 2, 3, 4};
  const double value[] = {2, 0.5, -1, 99, 3, 0.25, 4, 1, -2, 99, 1.5, 0.75, 99, 99, 2.5};
  Eigen::MatrixXd l = Eigen::MatrixXd::Zero(5, 5);
  for (int s = 0; s < 2; ++s)
    for (int c = column[s]; c < column[s + 1]; ++c)
      for (int r = rowBegin[s]; r < rowBegin[s + 1]; ++r)
        if (row[r] >= c) l(row[r], c) = value[valueBegin[s] + (c - column[s]) * 3 + r - rowBegin[s]];
  const Eigen::MatrixXd a = l * l.transpose();
  const SupernodalFactor factor{2, column, rowBegin, valueBegin, row, value};
  Rng rng(43);
  std::vector<double> wide(5 * kSolveWidth);
  for (double& x : wide) x = rng.uniform() - 0.5;
  const std::vector<double> right = wide;
  solveSupernodal(factor, wide.data(), kSolveWidth);
  for (std::size_t w = 0; w < kSolveWidth; ++w) {
    std::vector<double> one(5);
    for (std::size_t r = 0; r < 5; ++r) one[r] = right[r * kSolveWidth + w];
    const Eigen::VectorXd b = Eigen::Map<Eigen::VectorXd>(one.data(), 5);
    solveSupernodal(factor, one.data(), 1);
    EXPECT_LT((a * Eigen::Map<Eigen::VectorXd>(one.data(), 5) - b).norm(), 1e-13);
    for (std::size_t r = 0; r < 5; ++r) EXPECT_EQ(one[r], wide[r * kSolveWidth + w]);
  }
}

TEST(ManyLoads, SameBitsWhateverTheirNumberAndThreads) {
  for (const ElementOrder order : {ElementOrder::Linear, ElementOrder::Quadratic}) {
    const Shared mesh = shared(uShape(1, 2, 5, 2, 0.1));
    const Statics statics = factored(mesh, {0.2, order});
    const auto forces = anyForces(2 * kSolveWidth + 3, statics.elements()->nodeCount());
    std::vector<StaticSolution> alone;
    for (const std::vector<Vec3>& force : forces) alone.push_back(statics.solve(force, kYoung));
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{5},
                                    kSolveWidth, kSolveWidth + 1, forces.size()})
      for (const int threads : {1, 2}) {
        setThreadLimit(threads);
        const auto together = statics.solveAll(std::span(forces).first(count), kYoung, {});
        ASSERT_TRUE(together.ok());
        ASSERT_EQ(together->size(), count);
        for (std::size_t i = 0; i < count; ++i) expectSameBits((*together)[i], alone[i]);
      }
    setThreadLimit(0);
  }
}

/// Soft nodes ask for refinement, whose rounds leave out those loads that are done.
TEST(ManyLoads, SameBitsWhereSomeAreRefined) {
  TetMesh partly = uShape(1, 2, 5, 2, 0.1);
  for (std::size_t t = 0; t < partly.tets.size(); ++t) partly.insideFraction[t] = t % 4 == 0 ? 1e-9 : 0.7;
  const Shared mesh = shared(mapped(partly, [](const Vec3& p) { return Vec3(p.x(), p.y(), 1e-3 * p.z()); }));
  const Statics statics = factored(mesh, {0.4999});
  auto forces = anyForces(9, mesh->nodes.size());
  for (std::size_t i = 0; i < forces.size(); i += 2)
    std::fill(forces[i].begin() + 4, forces[i].end(), Vec3::Zero());
  const auto together = statics.solveAll(forces, kYoung, {});
  ASSERT_TRUE(together.ok());
  for (std::size_t i = 0; i < forces.size(); ++i)
    expectSameBits((*together)[i], statics.solve(forces[i], kYoung));
}

TEST(ManyLoads, CancellingIsAnError) {
  const Shared mesh = shared(box(1, 1, 1, Vec3(1, 1, 1)));
  const Statics statics = factored(mesh, {});
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto result = statics.solveAll(anyForces(3, mesh->nodes.size()), kYoung, exec);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, Error::Kind::Cancelled);
}

TEST(ManyLoads, PeakMemoryHoldsTheFactor) {
  const Statics small = factored(shared(box(3, 3, 3, Vec3(1, 1, 1))), {}),
                large = factored(shared(box(8, 8, 8, Vec3(1, 1, 1))), {});
  EXPECT_GT(small.peakBytes(), static_cast<std::size_t>(8 * small.factorSize()));
  EXPECT_GT(large.peakBytes(), static_cast<std::size_t>(8 * large.factorSize()));
  EXPECT_LT(large.peakBytes(), static_cast<std::size_t>(30 * 8 * large.factorSize()));
}

SimulateParams impactOf(int i) {
  SimulateParams params;
  params.orientation = Vec3(25 + 3 * i, 10 - 7 * i, 40 + i);
  params.dropHeight = 0.2 + 0.05 * i;
  return params;
}

TEST(ImpactEnergies, AreThoseOfSimulateToTheBit) {
  const Shared mesh = shared(uShape(1, 2, 6, 2, 0.05));
  for (const ElementOrder order : {ElementOrder::Linear, ElementOrder::Quadratic}) {
    std::vector<Impact> impacts{Impact{}};  // and one that hits nothing
    std::vector<std::vector<double>> expected{std::vector<double>(mesh->nodes.size(), 0.0)};
    for (int i = 0; i < 5; ++i) {
      SimulateParams params = impactOf(i);
      params.elements = order;
      const auto out = simulate(mesh, params, {});
      ASSERT_TRUE(out.ok()) << out.error().text();
      impacts.push_back(out->impact);
      expected.push_back(out->energy.nodeEnergy);
    }
    const auto energies = impactEnergies(mesh, impacts, SimulateParams{}.body, order, true, {});
    ASSERT_TRUE(energies.ok()) << energies.error().text();
    ASSERT_EQ(energies->size(), impacts.size());
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      EXPECT_EQ((*energies)[i].nodeEnergy, expected[i]);
      const double total = std::accumulate(expected[i].begin(), expected[i].end(), 0.0);
      EXPECT_NEAR((*energies)[i].total, total, 1e-12 * total);
    }
  }
}

TEST(ImpactEnergies, AThousandInOneCall) {
  const Shared mesh = shared(box(4, 4, 4, Vec3(0.2, 0.2, 0.2)));
  std::vector<Impact> impacts(1000);
  Rng rng(47);
  for (Impact& impact : impacts) {
    impact.hit = true;
    const Vec3 point(0.2 * rng.uniform(), 0, 0.2 * rng.uniform());
    impact.contacts.push_back({point, Vec3(0, 1 + rng.uniform(), 0), 1e-4, 0.02});
  }
  const auto all = impactEnergies(mesh, impacts, {}, ElementOrder::Linear, true, {});
  ASSERT_TRUE(all.ok()) << all.error().text();
  ASSERT_EQ(all->size(), 1000U);
  for (const std::size_t i : {std::size_t{0}, std::size_t{500}, std::size_t{999}}) {
    const auto one =
        impactEnergies(mesh, std::span(impacts).subspan(i, 1), {}, ElementOrder::Linear, true, {});
    ASSERT_TRUE(one.ok());
    EXPECT_EQ((*all)[i].nodeEnergy, (*one)[0].nodeEnergy);
    EXPECT_GT((*all)[i].total, 0);
  }
}

}  // namespace
