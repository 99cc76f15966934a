#include "cvd/cvd.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "graph/node_type.h"
#include "support/lloyd_reference.h"
#include "support/said.h"
#include "support/tet_families.h"

namespace sherd {
NodeType cvdNode();
namespace {

using reference::Cloud;
using reference::cloud;
using reference::PlainLloyd;

Partition partition(const Cloud& c, const CvdParams& params, const Sites* start = nullptr,
                    const Exec& exec = {}) {
  auto result = cvd(c.embedding, c.weights, start, params, exec);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return std::move(result).value();
}

Sites sitesAt(const Cloud& c, const std::vector<int>& nodes) {
  Sites s;
  s.positions.resize(c.embedding->coordinates.rows(), static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t j = 0; j < nodes.size(); ++j)
    s.positions.col(static_cast<Eigen::Index>(j)) = c.embedding->coordinates.col(nodes[j]);
  return s;
}

/// Nodes along a line at the given places.
Cloud line(const std::vector<double>& places) {
  Cloud c;
  c.embedding->coordinates.resize(1, static_cast<Eigen::Index>(places.size()));
  for (std::size_t n = 0; n < places.size(); ++n)
    c.embedding->coordinates(0, static_cast<Eigen::Index>(n)) = places[n];
  c.weights.weight.assign(places.size(), 1.0);
  c.weights.volume.assign(places.size(), 1.0);
  reference::measure(*c.embedding);
  return c;
}

TEST(Cvd, OneSiteIsTheCentroidByVolume) {
  Cloud c = cloud(50, 3, 1);
  const Partition p = partition(c, {.degree = 1});
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(3);
  double total = 0;
  for (int n = 0; n < 50; ++n) {
    mean += c.weights.volume[static_cast<std::size_t>(n)] * c.embedding->coordinates.col(n);
    total += c.weights.volume[static_cast<std::size_t>(n)];
  }
  EXPECT_LT((p.sites.col(0) - mean / total).norm(), 1e-14);
  EXPECT_TRUE(p.converged);
}

TEST(Cvd, TwoClumpsOnALine) {
  const Cloud c = line({0, 1, 2, 10, 11, 12});
  const Partition p = partition(c, {.degree = 2});
  EXPECT_TRUE(p.converged);
  EXPECT_EQ(p.label[0], p.label[2]);
  EXPECT_EQ(p.label[3], p.label[5]);
  EXPECT_NE(p.label[0], p.label[3]);
  EXPECT_NEAR(p.energy, 4, 1e-12);
  EXPECT_NEAR(p.sites.sum(), 12, 1e-12);
}

TEST(Cvd, TiesGoToTheLowerSite) {
  const Cloud c = line({-1, 0, 1});
  const Sites s = sitesAt(c, {2, 0});
  EXPECT_EQ(partition(c, {.maxIterations = 1}, &s).label, (std::vector<Index>{1, 0, 0}));
}

TEST(Cvd, CoincidentSitesAndDuplicateNodesAreLegal) {
  const Cloud c = line({0, 0, 0, 5, 5});
  const Sites s = sitesAt(c, {0, 1, 3, 4});
  const Partition p = partition(c, {}, &s);
  EXPECT_EQ(p.label, (std::vector<Index>{0, 0, 0, 2, 2}));
  EXPECT_EQ(p.energy, 0);
  EXPECT_EQ(p.siteCount(), 4u);
}

TEST(Cvd, WithoutWeightACellTakesVolumesAndWithoutVolumeItStays) {
  Cloud c = line({0, 1, 10, 13});
  c.weights.weight = {1, 3, 0, 0};
  c.weights.volume = {1, 1, 2, 1};
  const Sites s = sitesAt(c, {0, 2});
  Partition p = partition(c, {}, &s);
  EXPECT_NEAR(p.sites(0, 0), 0.75, 1e-15);
  EXPECT_NEAR(p.sites(0, 1), 11, 1e-14);
  c.weights.volume = {1, 1, 0, 0};
  p = partition(c, {}, &s);
  EXPECT_EQ(p.sites(0, 1), 10);
  EXPECT_TRUE(p.converged);
}

TEST(Cvd, MoreSitesThanDistinctNodesWarns) {
  const Cloud c = line({0, 1, 1, 2, 2, 2});
  Said said;
  const Partition p = partition(c, {.degree = 9}, nullptr, said.exec);
  EXPECT_EQ(p.siteCount(), 3u);
  EXPECT_EQ(p.energy, 0);
  EXPECT_TRUE(said.warning("9 sites were asked for")) << said.lines.size();
  Said quiet;
  EXPECT_EQ(partition(c, {.degree = 3}, nullptr, quiet.exec).siteCount(), 3u);
  EXPECT_FALSE(quiet.warning(""));
}

TEST(Cvd, GrowsEvenWithoutAnyEnergy) {
  Cloud c = cloud(80, 5, 3);
  std::fill(c.weights.weight.begin(), c.weights.weight.end(), 0.0);
  const Partition p = partition(c, {.degree = 12});
  EXPECT_EQ(p.siteCount(), 12u);
  EXPECT_EQ(p.energy, 0);
}

TEST(Cvd, FixedPointsAreCentroidsAndLabelsNearest) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Cloud c = cloud(300, 12, seed);
    const Partition p = partition(c, {.degree = 15, .seed = seed});
    ASSERT_TRUE(p.converged);
    PlainLloyd plain{c.embedding->coordinates, c.weights, p.sites, {}, {}};
    plain.assign();
    EXPECT_EQ(plain.label, p.label);
    EXPECT_EQ(plain.energy(), p.energy);
    EXPECT_LE(plain.move(), 1e-7 * c.embedding->diameter);
  }
}

TEST(Cvd, SameBitsAsThePlainReferenceForAnyThreadCount) {
  struct Case {
    int nodes, dimensions, sites;
  };
  for (const Case& k : {Case{1, 1, 1}, Case{40, 1, 7}, Case{1500, 3, 40}, Case{1300, 74, 30},
                        Case{700, 17, 200}, Case{3000, 2, 120}, Case{2501, 5, 300}}) {
    const Cloud c = cloud(k.nodes, k.dimensions, static_cast<unsigned>(k.nodes));
    std::vector<int> nodes;
    for (int j = 0; j < k.sites; ++j) nodes.push_back((j * 7) % k.nodes);
    const Sites start = sitesAt(c, nodes);
    PlainLloyd plain{c.embedding->coordinates, c.weights, start.positions, {}, {}};
    plain.assign();
    const Lloyd::End end = plain.run({}, c.embedding->diameter);
    for (const int threads : {1, 2, 4}) {
      setThreadLimit(threads);
      const Partition p = partition(c, {}, &start);
      if (k.sites > 1) {
        EXPECT_EQ(p.sites, plain.sites) << k.nodes;
        EXPECT_EQ(p.iterations, end.iterations);
        EXPECT_EQ(p.converged, end.converged);
      }
      EXPECT_EQ(p.label, plain.label);
    }
    setThreadLimit(0);
  }
}

TEST(Cvd, GridsFullOfTiesStayExact) {
  // Nodes of a lattice: distances tie all over, and centroids fall on ties.
  Cloud c;
  c.embedding->coordinates.resize(3, 512);
  for (int n = 0; n < 512; ++n) c.embedding->coordinates.col(n) << n % 8, n / 8 % 8, n / 64;
  c.weights.weight.assign(512, 1.0);
  c.weights.volume.assign(512, 1.0);
  reference::measure(*c.embedding);
  const Sites start = sitesAt(c, {0, 7, 63, 511, 448, 73, 100, 300, 301, 302});
  PlainLloyd plain{c.embedding->coordinates, c.weights, start.positions, {}, {}};
  plain.assign();
  plain.run({}, c.embedding->diameter);
  const Partition p = partition(c, {}, &start);
  EXPECT_EQ(p.label, plain.label);
  EXPECT_EQ(p.sites, plain.sites);
}

TEST(Cvd, EnergyNeverRisesWithPassesNorWithSites) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Cloud c = cloud(400, 10, seed);
    const Sites start = sitesAt(c, {0, 1, 2, 3, 4, 5, 6, 7});
    double last = HUGE_VAL;
    for (int passes = 1; passes < 12; ++passes) {
      const double e = partition(c, {.maxIterations = passes}, &start).energy;
      EXPECT_LE(e, last * (1 + 1e-12));
      last = e;
    }
    Lloyd lloyd = firstSites(*c.embedding, c.weights, nullptr, Exec{});
    last = lloyd.energy();
    for (int n = 2; n <= 40; ++n) {
      ASSERT_TRUE(growSite(lloyd, *c.embedding, c.weights, Growth::ByVolume, seed, Exec{}).ok());
      EXPECT_LE(lloyd.energy(), last * (1 + 1e-12)) << n;
      last = lloyd.energy();
      EXPECT_LE(partition(c, {.degree = n, .seed = seed}).energy, last * (1 + 1e-12)) << n;
    }
  }
}

TEST(Cvd, SeedsDecide) {
  const Cloud c = cloud(300, 6, 9);
  const Partition a = partition(c, {.degree = 10, .seed = 1}), b = partition(c, {.degree = 10, .seed = 2});
  EXPECT_NE(a.label, b.label);
  for (const int threads : {1, 2, 4}) {
    setThreadLimit(threads);
    const Partition again = partition(c, {.degree = 10, .seed = 1});
    EXPECT_EQ(a.sites, again.sites);
    EXPECT_EQ(a.label, again.label);
    EXPECT_EQ(a.energy, again.energy);
  }
  setThreadLimit(0);
}

TEST(Cvd, GrowsFromGivenSitesAndAnewForFewer) {
  const Cloud c = cloud(200, 6, 4);
  const Partition five = partition(c, {.degree = 5});
  Sites s;
  s.positions = five.sites;
  const Partition nine = partition(c, {.degree = 9}, &s);
  EXPECT_EQ(nine.siteCount(), 9u);
  EXPECT_LT(nine.energy, five.energy);
  EXPECT_NEAR(nine.energy, partition(c, {.degree = 9}).energy, 0.1 * nine.energy);
  Said said;
  EXPECT_EQ(partition(c, {.degree = 3}, &s, said.exec).sites, partition(c, {.degree = 3}).sites);
  EXPECT_TRUE(said.info("grown anew"));
}

TEST(Cvd, KnowsWhetherTheDegreeWasGiven) {
  const Cloud c = cloud(200, 6, 4);
  Sites s;
  s.positions = partition(c, {.degree = 5}).sites;
  Said said;
  const Partition found = partition(c, {}, &s, said.exec);
  EXPECT_FALSE(found.degreeGiven);
  EXPECT_TRUE(said.info("not below γ = 0"));
  s.gamma = 2;
  EXPECT_FALSE(partition(c, {.degree = 5}, &s).degreeGiven);  // wired to the search's own number
  EXPECT_EQ(partition(c, {.degree = 5}, &s).gamma, 2);
  EXPECT_TRUE(partition(c, {.degree = 6}, &s).degreeGiven);
  EXPECT_EQ(partition(c, {.degree = 6}, &s).gamma, 2) << "as it was asked for, though nothing came of it";
  EXPECT_TRUE(partition(c, {.degree = 5}).degreeGiven);
  EXPECT_EQ(partition(c, {.degree = 5}).gamma, 0);
  s.degreeGiven = true;
  EXPECT_TRUE(partition(c, {}, &s).degreeGiven);
  Partition other = found;
  other.degreeGiven = true;
  Hasher a, b;
  hashValue(a, found);
  hashValue(b, other);
  EXPECT_NE(a.digest().hex(), b.digest().hex());
}

/// A body with its own nodes as embedding.
Cloud bodyCloud(TetMesh mesh) {
  Cloud c;
  const auto tets = families::shared(std::move(mesh));
  c.embedding->tets = tets;
  c.embedding->coordinates.resize(3, static_cast<Eigen::Index>(tets->nodes.size()));
  for (std::size_t n = 0; n < tets->nodes.size(); ++n)
    c.embedding->coordinates.col(static_cast<Eigen::Index>(n)) = tets->nodes[n];
  c.weights.volume = lumpedVolumes(*tets);
  c.weights.weight = c.weights.volume;
  reference::measure(*c.embedding);
  return c;
}

TEST(Flood, AgreesWithExactOnAConvexBody) {
  const Cloud c = bodyCloud(families::box(12, 3, 3, Vec3(4, 1, 1)));
  for (int n = 2; n <= 4; ++n) {
    const Partition exact = partition(c, {.degree = n}),
                    flood = partition(c, {.degree = n, .labels = Labels::Flood});
    EXPECT_EQ(exact.label, flood.label) << n;
    EXPECT_EQ(exact.energy, flood.energy);
  }
}

TEST(Flood, IsNeverBetterAndReachesAllParts) {
  const Cloud c = bodyCloud(families::twoBoxes(3, 2, 0.5));
  const Sites one = sitesAt(c, {0, 1});  // both in the first box: no flood reaches the second
  const Partition p = partition(c, {.labels = Labels::Flood, .maxIterations = 1}, &one);
  for (const Index l : p.label) EXPECT_GE(l, 0);
  for (int n = 2; n <= 20; ++n) {
    const Partition f = partition(c, {.degree = n, .labels = Labels::Flood});
    PlainLloyd plain{c.embedding->coordinates, c.weights, f.sites, {}, {}};
    plain.assign();
    EXPECT_GE(f.energy, plain.energy());
  }
}

TEST(Cvd, ReportsAndRefuses) {
  const Cloud c = cloud(30, 3, 5);
  Sites s = sitesAt(c, {0, 1, 2});
  s.gamma = 1e9;
  Said said;
  EXPECT_EQ(partition(c, {}, &s, said.exec).gamma, 1e9);
  EXPECT_TRUE(said.info("3 sites, E_D = "));
  EXPECT_TRUE(said.info("below γ = 1e+09"));

  auto portOf = [&](const Cloud& cloud, const Sites* start, CvdParams params) {
    const auto r = cvd(cloud.embedding, cloud.weights, start, params, {});
    return r.ok() ? std::string("ok") : r.error().port;
  };
  EXPECT_EQ(portOf(c, nullptr, {}), "degree");
  EXPECT_EQ(portOf(c, nullptr, {.degree = -1}), "degree");
  EXPECT_EQ(portOf(c, &s, {.tolerance = -1}), "tolerance");
  EXPECT_EQ(portOf(c, &s, {.maxIterations = 0}), "max_iterations");
  Sites flat;
  flat.positions = Eigen::MatrixXd::Zero(2, 3);
  EXPECT_EQ(portOf(c, &flat, {}), "sites");
  Cloud bad = cloud(30, 3, 5);
  bad.weights.weight[7] = NAN;
  EXPECT_EQ(portOf(bad, &s, {}), "weights");
  bad.weights.weight.pop_back();
  EXPECT_EQ(portOf(bad, &s, {}), "weights");
  bad = cloud(30, 3, 5);
  bad.embedding->coordinates(1, 1) = HUGE_VAL;
  EXPECT_EQ(portOf(bad, &s, {}), "embedding");
  EXPECT_FALSE(cvd(nullptr, c.weights, &s, {}, {}).ok());

  CancelToken token;
  token.cancel();
  Exec cancelled;
  cancelled.cancel = &token;
  for (const Sites* start : {static_cast<const Sites*>(nullptr), static_cast<const Sites*>(&s)}) {
    const auto r = cvd(c.embedding, c.weights, start, {.degree = 4}, cancelled);
    ASSERT_FALSE(r.ok());
    EXPECT_EQ(r.error().kind, Error::Kind::Cancelled);
  }
}

TEST(CvdNode, PassesOn) {
  const Cloud c = cloud(60, 4, 6);
  const NodeType type = cvdNode();
  ParamValues params;
  for (const ParamInfo& p : type.params) params[p.name] = p.fallback;
  params["degree"] = std::int64_t{7};
  const Exec exec;
  NodeIo io(exec);
  io.setInput("weights", Value::of<WeightField>(std::make_shared<const WeightField>(c.weights)));
  io.setInput("embedding", Value::of<Embedding>(c.embedding));
  ASSERT_TRUE(type.run(params, io).ok());
  const Partition expected = partition(c, {.degree = 7});
  EXPECT_EQ(type.outputs.front().name, "cells");
  EXPECT_EQ(io.output("cells").as<Partition>()->label, expected.label);
  EXPECT_EQ(*io.output("degree").as<std::int64_t>(), 7);
  EXPECT_EQ(*io.output("energy").as<double>(), expected.energy);
}

}  // namespace
}  // namespace sherd
