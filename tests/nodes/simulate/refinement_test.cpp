#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "simulate/impact_refinement.h"
#include "simulate/local_refinement.h"
#include "simulate/simulate.h"
#include "support/caged_boxes.h"
#include "support/elastic_loads.h"

using namespace sherd;
using namespace sherd::families;

namespace {

using Shared = std::shared_ptr<const TetMesh>;
constexpr double kYoung = 5e10;
constexpr double kNever = std::numeric_limits<double>::infinity();

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Impact pressedAt(const std::vector<Vec3>& points, double radius, double size = 1) {
  Impact impact;
  impact.hit = true;
  for (const Vec3& p : points) impact.contacts.push_back({p * size, Vec3(0.1, 1, -0.2), 1e-4, radius * size});
  return impact;
}

/// One body, its impact's load and the solution without refinement.
struct Case {
  Shared mesh;
  Impact impact;
  Statics statics;
  std::vector<PointLoad> points;
  std::vector<Vec3> force;
  StaticSolution coarse;

  Case(const Shared& body, Impact hit, double poisson = 0.2)
      : mesh(body), impact(std::move(hit)), statics(factored(body, poisson)) {
    const PatchLoader loader(statics.elements());
    force.assign(statics.elements()->nodeCount(), Vec3::Zero());
    for (const Contact& c : impact.contacts) {
      const auto loads = loader.pointLoads(c.point, c.impulse / c.duration, c.radius);
      EXPECT_TRUE(loads.ok());
      points.insert(points.end(), loads->begin(), loads->end());
    }
    loader.hand(points, force);
    coarse = statics.solve(force, kYoung);
  }
  static Statics factored(const Shared& body, double poisson) {
    Result<Statics> made = Statics::factor(body, {poisson, ElementOrder::Quadratic}, {});
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().text());
    return std::move(made).value();
  }
  StaticSolution refined(const RefinementParams& params, std::size_t* pieces = nullptr) const {
    StaticSolution solution = coarse;
    const auto count = ImpactRefinement(statics, params).refine(impact, force, points, kYoung, solution, {});
    EXPECT_TRUE(count.ok()) << (count.ok() ? "" : count.error().text());
    if (pieces != nullptr) *pieces = *count;
    return solution;
  }
  Vec3 placeOf(const PointLoad& load) const {
    Vec3 p = Vec3::Zero();
    for (std::size_t c = 0; c < 4; ++c)
      p += load.barycentric[static_cast<Eigen::Index>(c)] * mesh->nodes[at(mesh->tets[at(load.tet)][c])];
    return p;
  }
};

const Vec3 kBlock(0.21, 0.2, 0.19);
Shared block(int n) { return shared(jittered(n, kBlock)); }
const Vec3 kBelow(0.1, 0, 0.09), kBeside(0.21, 0.11, 0.1);

TEST(DividedTets, LieInTheirParentsWithoutHangingNodes) {
  const Shared mesh = block(3);
  const auto wanted = [](const Vec3& place, Index) { return 0.01 + 0.5 * (place - kBelow).norm(); };
  const DividedTets d = divideTets(mesh->nodes, mesh->tets, wanted);
  ASSERT_GT(d.tets.size(), 2 * mesh->tets.size());
  EXPECT_TRUE(std::is_sorted(d.parent.begin(), d.parent.end()));
  std::vector<double> volume(mesh->tets.size(), 0.0);
  TetMesh made;
  made.nodes = d.nodes;
  made.tets = d.tets;
  for (std::size_t i = 0; i < d.tets.size(); ++i) {
    EXPECT_GT(tetVolume(made, i), 0);
    volume[at(d.parent[i])] += tetVolume(made, i);
    for (const Index n : d.tets[i])
      EXPECT_GT(barycentricIn(*mesh, d.parent[i], d.nodes[at(n)]).minCoeff(), -1e-12);
    for (const auto& e : kTetraEdge) {
      const Vec3 &a = d.nodes[at(d.tets[i][at(e[0])])], &b = d.nodes[at(d.tets[i][at(e[1])])];
      EXPECT_LE((a - b).norm(), wanted(0.5 * (a + b), 0));
    }
  }
  for (std::size_t t = 0; t < volume.size(); ++t) EXPECT_NEAR(volume[t], tetVolume(*mesh, t), 1e-15);
  // A face without a neighbour lies on the block's boundary.
  connectTets(made);
  for (const Triangle& face : made.boundary) {
    const Vec3 middle = (d.nodes[at(face[0])] + d.nodes[at(face[1])] + d.nodes[at(face[2])]) / 3;
    EXPECT_LT(std::min(middle.minCoeff(), (kBlock - middle).minCoeff()), 1e-12);
  }
}

TEST(DividedTets, AreTheTetrahedraThemselvesWhereTheseAreSmallEnough) {
  const Shared mesh = block(2);
  const DividedTets d = divideTets(mesh->nodes, mesh->tets, [](const Vec3&, Index) { return 1.0; });
  EXPECT_EQ(d.tets, mesh->tets);
  EXPECT_TRUE(d.halved.empty());
}

/// All divided tetrahedra as one mesh, factored as a whole.
void expectTheWholeMeshsAnswer(const Case& c, const RefinementParams& params) {
  const StaticSolution refined = c.refined(params);
  const double largest = params.largestShare * sum(c.coarse.tetEnergy);
  ASSERT_EQ(params.largestShare, kNever) << "contacts alone decide here: " << largest;
  const DividedTets d = divideTets(c.mesh->nodes, c.mesh->tets, [&](const Vec3& place, Index) {
    double wanted = kNever;
    for (const Contact& k : c.impact.contacts)
      wanted =
          std::min(wanted, params.patchEdges * k.radius + std::max((place - k.point).norm() - k.radius, 0.0));
    return wanted;
  });
  const Shared whole = shared(withOwnSurface(d.nodes, d.tets));
  const Statics statics = Case::factored(whole, 0.2);
  std::vector<Vec3> force(statics.elements()->nodeCount(), Vec3::Zero());
  for (const PointLoad& load : c.points) {
    std::size_t best = 0;
    Vec4 share = Vec4::Constant(-kNever);
    for (std::size_t t = 0; t < whole->tets.size(); ++t) {
      const Vec4 b = barycentricIn(*whole, static_cast<Index>(t), c.placeOf(load));
      if (b.minCoeff() > share.minCoeff()) share = b, best = t;
    }
    const auto value = statics.elements()->shapeValues(share);
    const auto own = statics.elements()->nodesOf(best);
    for (std::size_t i = 0; i < own.size(); ++i) force[at(own[i])] += value[i] * load.force;
  }
  const StaticSolution expected = statics.solve(force, kYoung);
  const double energy = sum(expected.tetEnergy);
  EXPECT_NEAR(sum(refined.tetEnergy), energy, 1e-5 * energy);  // kLeastPieceShare is the whole difference
  std::vector<double> perParent(c.mesh->tets.size(), 0.0);
  for (std::size_t i = 0; i < d.parent.size(); ++i) perParent[at(d.parent[i])] += expected.tetEnergy[i];
  for (std::size_t t = 0; t < perParent.size(); ++t)
    EXPECT_NEAR(refined.tetEnergy[t], perParent[t], 1e-5 * energy) << t;
  double largestMotion = 0;
  for (const Vec3& u : expected.displacement) largestMotion = std::max(largestMotion, u.norm());
  for (std::size_t n = 0; n < c.mesh->nodes.size(); ++n)
    EXPECT_LT((refined.displacement[n] - expected.displacement[n]).norm(), 1e-5 * largestMotion) << n;
}

TEST(LocalRefinement, IsTheWholeMeshsAnswer) {
  expectTheWholeMeshsAnswer(Case(block(3), pressedAt({kBelow}, 0.05)), {0.5, kNever});
}
TEST(LocalRefinement, OfTwoContactsIsTheWholeMeshsAnswer) {
  expectTheWholeMeshsAnswer(Case(block(3), pressedAt({kBelow, kBeside}, 0.05)), {0.6, kNever});
}

/// A contact on a block, ever finer, against quadratic elements of a third of the edge everywhere, and the
/// finest at the contact.
TEST(LocalRefinement, RisesToTheEnergyOfAFineMeshFromBelow) {
  const Impact impact = pressedAt({kBelow}, 0.05);
  const Case c(block(2), impact);
  double last = sum(c.coarse.tetEnergy);
  for (const double edges : {2.0, 1.0, 0.5, 0.35}) {
    const double energy = sum(c.refined({edges, kNever}).tetEnergy);
    EXPECT_GE(energy, last * (1 - 2e-6)) << edges;
    last = energy;
  }
  const Case fine(shared(box(6, 6, 6, kBlock)), impact);
  const double reference = sum(fine.refined({0.35, kNever}).tetEnergy);
  EXPECT_LT(sum(c.coarse.tetEnergy), 0.9 * reference);
  EXPECT_LT(last, reference);
  EXPECT_GT(sum(c.refined({}).tetEnergy), 0.96 * reference);
}

TEST(LocalRefinement, WorkIsTwiceTheEnergy) {
  for (const double poisson : {0.2, 0.499}) {
    const Case c(block(2), pressedAt({kBelow, kBeside}, 0.05), poisson);
    const StaticSolution refined = c.refined({});
    EXPECT_NEAR(refined.work, sum(refined.tetEnergy), 1e-10 * refined.work) << poisson;
    EXPECT_GT(refined.work, 1.05 * c.coarse.work);
    EXPECT_LE(refined.residual, 1e-10);
    EXPECT_LT(refined.refinements, 15);
    for (const double e : refined.tetEnergy) EXPECT_GE(e, 0);
  }
}

TEST(LocalRefinement, KnowsNoFrameAndNoUnit) {
  const Shared mesh = block(2);
  const Impact impact = pressedAt({kBelow}, 0.05);
  const double energy = sum(Case(mesh, impact).refined({}).tetEnergy);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const auto moved = [&](const Vec3& p) { return Vec3(turn * p + Vec3(3, -2, 5)); };
  Impact turned = impact;
  turned.contacts[0].point = moved(impact.contacts[0].point);
  turned.contacts[0].impulse = turn * impact.contacts[0].impulse;
  EXPECT_NEAR(sum(Case(shared(mapped(*mesh, moved)), turned).refined({}).tetEnergy), energy, 1e-9 * energy);
  // In millimetres: f² / (E L).
  const Shared large = shared(mapped(*mesh, [](const Vec3& p) { return Vec3(1000 * p); }));
  EXPECT_NEAR(1000 * sum(Case(large, pressedAt({kBelow}, 0.05, 1000)).refined({}).tetEnergy), energy,
              1e-9 * energy);
}

TEST(LocalRefinement, LeavesAFineMeshAlone) {
  const Case c(block(6), pressedAt({kBelow}, 0.2));
  std::size_t pieces = 1;
  const StaticSolution same = c.refined({0.5, 0.02}, &pieces);
  EXPECT_EQ(pieces, 0U);
  EXPECT_EQ(same.tetEnergy, c.coarse.tetEnergy);
}

TEST(LocalRefinement, IsTheSameForAnyNumberOfThreads) {
  const Case c(shared(cagedBox(5, 4, 4, kBlock, Vec3(0.031, 0.022, 0.027))), pressedAt({kBelow}, 0.05));
  const int threads = threadLimit();
  setThreadLimit(1);
  const StaticSolution one = c.refined({});
  setThreadLimit(4);
  const StaticSolution four = c.refined({});
  setThreadLimit(threads);
  EXPECT_EQ(one.tetEnergy, four.tetEnergy);
  EXPECT_EQ(one.work, four.work);
}

/// Pieces of cut tetrahedra: what they hold adds up, and they bend like the body inside them.
TEST(LocalRefinement, CountsThePartOfEachPieceInsideTheSurface) {
  const Impact impact = pressedAt({kBelow}, 0.05);
  const Case c(shared(cagedBox(4, 4, 4, kBlock, Vec3(0.031, 0.022, 0.027))), impact);
  const DividedTets d = divideTets(c.mesh->nodes, c.mesh->tets, [](const Vec3&, Index) { return 0.05; });
  const RefinedRegion region(*c.statics.elements(), d);
  const std::vector<double> share = stiffnessShares(*c.statics.elements());
  const SurfaceTree tree(c.mesh->surface->positions, c.mesh->surface->triangles);
  const PieceRules rules = pieceRules(region, *c.mesh, share, tree, {});
  std::vector<double> held(share.size(), 0.0);
  for (std::size_t i = 0; i < region.size(); ++i)
    held[at(region.parent(i))] += rules.share[i] * tetVolume(region.elements().mesh(), i);
  for (std::size_t t = 0; t < share.size(); ++t)
    EXPECT_NEAR(held[t] / tetVolume(*c.mesh, t), region.covers(t) ? share[t] : 0, 2e-6) << t;
  // The same body without a cage.
  const double reference = sum(Case(shared(box(5, 5, 5, kBlock)), impact).refined({}).tetEnergy);
  EXPECT_LT(sum(c.coarse.tetEnergy), 0.95 * reference);
  EXPECT_NEAR(sum(c.refined({}).tetEnergy), reference, 0.05 * reference);
}

TEST(LocalRefinement, CancellingIsAnError) {
  const Case c(block(2), pressedAt({kBelow}, 0.05));
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  StaticSolution solution = c.coarse;
  const auto done = ImpactRefinement(c.statics).refine(c.impact, c.force, c.points, kYoung, solution, exec);
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(done.error().kind, Error::Kind::Cancelled);
}

/// The parameter: quadratic elements follow it, linear ones never do.
TEST(Simulate, RefinesQuadraticElementsOnly) {
  const Shared mesh = shared(uShape(1, 2, 6, 2, 0.05));
  const auto energies = [&](ElementOrder order, bool refine) {
    SimulateParams params;
    params.orientation = Vec3(25, 10, 40);
    params.elements = order;
    params.refine = refine;
    const auto out = simulate(mesh, params, {});
    EXPECT_TRUE(out.ok()) << (out.ok() ? "" : out.error().text());
    return out->energy.tetEnergy;
  };
  EXPECT_EQ(energies(ElementOrder::Linear, true), energies(ElementOrder::Linear, false));
  EXPECT_GT(sum(energies(ElementOrder::Quadratic, true)),
            1.02 * sum(energies(ElementOrder::Quadratic, false)));
}

}  // namespace
