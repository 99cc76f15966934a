// From impact to cells on bodies of cubes: what an artist expects of a break, and that metric and physics
// deliver it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "cvd/cvd.h"
#include "embed/embed.h"
#include "geometry/disjoint_sets.h"
#include "predict_degree/predict_degree.h"
#include "simulate/simulate.h"
#include "support/tet_families.h"
#include "weights/weights.h"

namespace sherd {
namespace {

using TetsPtr = std::shared_ptr<const TetMesh>;

std::shared_ptr<const Embedding> embedded(const TetsPtr& tets,
                                          EmbedParams::Metric metric = EmbedParams::Metric::Auto) {
  EmbedParams params;
  params.metric = metric;
  auto result = embed(tets, params, Exec{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::make_shared<const Embedding>(std::move(*result));
}

SimulateOutput dropped(const TetsPtr& tets, double height, double timeStep = SimulateParams{}.timeStep) {
  SimulateParams params;
  params.dropHeight = height;
  params.orientation = Vec3(20, 0, 35);
  params.angularVelocity = Vec3(0.5, 1, 0);
  params.timeStep = timeStep;
  auto result = simulate(tets, params, Exec{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(*result);
}

WeightField weighted(const EnergyField& energy, const ScalarGrid* beta = nullptr) {
  auto result = weights(energy, beta, {}, Exec{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(*result);
}

Sites sitesFor(const WeightField& w, const Embedding& e, double gamma, int degree = 0,
               std::int64_t seed = 1) {
  PredictDegreeParams params;
  params.gamma = gamma;
  params.degree = degree;
  params.seed = seed;
  auto result = predictDegree(w, e, params, Exec{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(*result);
}

Partition cellsFor(const WeightField& w, const std::shared_ptr<const Embedding>& e, const Sites& sites) {
  auto result = cvd(e, w, &sites, {}, Exec{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(*result);
}

/// A γ that the search reaches at about `degree` sites.
double gammaForDegree(const WeightField& w, const Embedding& e, int degree) {
  return sitesFor(w, e, 0, degree).energy * (1 + 1e-9);
}

TetsPtr plank() { return families::shared(families::box(16, 6, 3, Vec3(0.8, 0.3, 0.15))); }

TEST(PhysicsSanity, HigherDropGivesMoreEnergyAndMorePieces) {
  const TetsPtr tets = plank();
  const auto e = embedded(tets);
  double lastEnergy = 0;
  Eigen::Index lastDegree = 0;
  double gamma = 0;
  for (const double height : {0.5, 2.0, 8.0}) {
    const SimulateOutput hit = dropped(tets, height);
    const WeightField w = weighted(hit.energy);
    if (gamma == 0) gamma = gammaForDegree(w, *e, 4);
    const Sites sites = sitesFor(w, *e, gamma);
    EXPECT_GT(totalEnergy(hit.energy), lastEnergy);
    EXPECT_GT(sites.positions.cols(), lastDegree);
    lastEnergy = totalEnergy(hit.energy);
    lastDegree = sites.positions.cols();
  }
}

TEST(PhysicsSanity, TougherMaterialFallsIntoFewerPieces) {
  const TetsPtr tets = plank();
  const auto e = embedded(tets);
  const WeightField w = weighted(dropped(tets, 1).energy);
  const double gamma = gammaForDegree(w, *e, 60);
  const auto weak = sitesFor(w, *e, gamma).positions.cols(),
             tough = sitesFor(w, *e, 10 * gamma).positions.cols(),
             hard = sitesFor(w, *e, 100 * gamma).positions.cols();
  EXPECT_GT(weak, tough);
  EXPECT_GT(tough, hard);
  EXPECT_GE(hard, 1);
  // Beyond the energy of the whole there is nothing to break.
  EXPECT_EQ(sitesFor(w, *e, 2 * sitesFor(w, *e, 0, 1).energy).positions.cols(), 1);
}

TEST(PhysicsSanity, PiecesAreSmallerNearTheImpact) {
  const TetsPtr tets = plank();
  const auto e = embedded(tets);
  const SimulateOutput hit = dropped(tets, 1);
  ASSERT_TRUE(hit.impact.hit);
  const WeightField w = weighted(hit.energy);
  const Partition cells = cellsFor(w, e, sitesFor(w, *e, 0, 24));
  std::vector<double> volume(cells.siteCount(), 0);
  std::vector<Vec3> centre(cells.siteCount(), Vec3::Zero());
  for (std::size_t n = 0; n < tets->nodes.size(); ++n) {
    volume[at(cells.label[n])] += w.volume[n];
    centre[at(cells.label[n])] += w.volume[n] * tets->nodes[n];
  }
  const Vec3 contact = hit.impact.contacts.front().point;
  std::vector<std::pair<double, double>> byDistance;
  for (std::size_t c = 0; c < volume.size(); ++c)
    byDistance.emplace_back((centre[c] / volume[c] - contact).norm(), volume[c]);
  std::sort(byDistance.begin(), byDistance.end());
  double near = 0, far = 0;
  for (std::size_t c = 0; c < 12; ++c) near += byDistance[c].second, far += byDistance[c + 12].second;
  EXPECT_LT(near, 0.7 * far);
}

TEST(PhysicsSanity, TwoSeedsGiveDifferentPiecesOfOneCount) {
  const TetsPtr tets = plank();
  const auto e = embedded(tets);
  const WeightField w = weighted(dropped(tets, 1).energy);
  const Partition a = cellsFor(w, e, sitesFor(w, *e, 0, 12, 1)),
                  b = cellsFor(w, e, sitesFor(w, *e, 0, 12, 2));
  EXPECT_EQ(a.siteCount(), 12u);
  EXPECT_EQ(b.siteCount(), 12u);
  EXPECT_NE(a.sites, b.sites);
}

TEST(PhysicsSanity, AHalvedTimeStepChangesTheEnergyByLessThanTwoPercent) {
  const TetsPtr tets = plank();
  const double whole = totalEnergy(dropped(tets, 1, 1.0 / 120).energy),
               half = totalEnergy(dropped(tets, 1, 1.0 / 240).energy);
  EXPECT_NEAR(half, whole, 0.02 * whole);
  EXPECT_NEAR(half, whole, 1e-4 * whole);  // what conservative advancement reaches
}

TEST(PhysicsSanity, EnergyAndCellsDoNotDependOnNodeNumbersOrPlace) {
  const TetsPtr tets = plank();
  const double energy = totalEnergy(dropped(tets, 1).energy);
  TetMesh turned = families::mapped(*tets, [](const Vec3& p) { return Vec3(p + Vec3(3, 5, -2)); });
  EXPECT_NEAR(totalEnergy(dropped(families::shared(turned), 1).energy), energy, 1e-6 * energy);
  TetMesh renumbered = *tets;
  const auto n = static_cast<Index>(renumbered.nodes.size());
  std::reverse(renumbered.nodes.begin(), renumbered.nodes.end());
  for (Tetra& t : renumbered.tets)
    for (Index& v : t) v = n - 1 - v;
  connectTets(renumbered);
  EXPECT_NEAR(totalEnergy(dropped(families::shared(renumbered), 1).energy), energy, 1e-8 * energy);
}

/// Cells whose nodes are not connected through the body: they would hold parts on both sides of a gap.
int scatteredCells(const Partition& cells) {
  const TetMesh& tets = *cells.embedding->tets;
  DisjointSets sets(tets.nodes.size());
  for (const Tetra& t : tets.tets)
    for (const auto& edge : kTetraEdge) {
      const Index a = t[static_cast<std::size_t>(edge[0])], b = t[static_cast<std::size_t>(edge[1])];
      if (cells.label[at(a)] == cells.label[at(b)]) sets.join(at(a), at(b));
    }
  std::map<Index, std::set<std::size_t>> parts;
  for (std::size_t n = 0; n < tets.nodes.size(); ++n) parts[cells.label[n]].insert(sets.find(n));
  return static_cast<int>(
      std::count_if(parts.begin(), parts.end(), [](const auto& p) { return p.second.size() > 1; }));
}

TEST(PhysicsSanity, InteriorMetricDoesNotCutAcrossAGapAndEuclideanDoes) {
  const TetsPtr tets = families::shared(families::uShape(2, 1, 14, 2, 0.05));
  WeightField w;
  w.tets = tets;
  w.volume = lumpedVolumes(*tets);
  w.weight = w.volume;
  int interior = 0, euclidean = 0;
  for (const int degree : {3, 4, 5, 6})
    for (const std::int64_t seed : {1, 2, 3}) {
      const auto in = embedded(tets, EmbedParams::Metric::Interior),
                 out = embedded(tets, EmbedParams::Metric::Euclidean);
      interior += scatteredCells(cellsFor(w, in, sitesFor(w, *in, 0, degree, seed)));
      euclidean += scatteredCells(cellsFor(w, out, sitesFor(w, *out, 0, degree, seed)));
    }
  EXPECT_EQ(interior, 0);
  EXPECT_GT(euclidean, 5);
}

}  // namespace
}  // namespace sherd
