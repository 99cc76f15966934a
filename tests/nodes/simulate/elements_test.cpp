#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "base/rng.h"
#include "simulate/nested_dissection.h"
#include "simulate/patch_load.h"
#include "simulate/statics.h"
#include "support/elastic_loads.h"

using namespace sherd;
using namespace sherd::families;

namespace {

using Shared = std::shared_ptr<const TetMesh>;
constexpr double kYoung = 5e10;
constexpr ElementOrder kOrders[] = {ElementOrder::Linear, ElementOrder::Quadratic};

Statics factored(const Shared& mesh, const StaticsParams& params) {
  Result<Statics> statics = Statics::factor(mesh, params, {});
  EXPECT_TRUE(statics.ok()) << (statics.ok() ? "" : statics.error().text());
  return std::move(statics).value();
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// A point of a tetrahedron.
Vec3 pointOf(const TetMesh& mesh, std::size_t t, const Vec4& barycentric) {
  Vec3 x = Vec3::Zero();
  for (std::size_t c = 0; c < 4; ++c)
    x += barycentric[static_cast<Eigen::Index>(c)] * mesh.nodes[at(mesh.tets[t][c])];
  return x;
}

double quadratic(const Vec3& x) { return 1 - 2 * x.x() + x.y() * x.z() + 3 * x.x() * x.x() - x.z() * x.z(); }

TEST(Elements, InterpolateWhatTheyClaimTo) {
  const Shared mesh = shared(jittered(2, Vec3(1, 2, 0.5)));
  Rng rng(3);
  for (const ElementOrder order : kOrders) {
    const Elements elements(mesh, order);
    const std::vector<Vec3> x = elements.positions(mesh->nodes);
    ASSERT_EQ(x.size(), elements.nodeCount());
    for (std::size_t t = 0; t < mesh->tets.size(); ++t) {
      Vec4 b(rng.uniform(), rng.uniform(), rng.uniform(), rng.uniform());
      b /= b.sum();
      const auto value = elements.shapeValues(b);
      Vec3 place = Vec3::Zero();
      double one = 0, field = 0;
      for (std::size_t i = 0; i < elements.perTet(); ++i) {
        const Vec3& node = x[at(elements.nodesOf(t)[i])];
        place += value[i] * node;
        one += value[i];
        field += value[i] * quadratic(node);
      }
      EXPECT_NEAR(one, 1, 1e-14);
      EXPECT_LT((place - pointOf(*mesh, t, b)).norm(), 1e-14);
      if (order == ElementOrder::Quadratic) {
        EXPECT_NEAR(field, quadratic(pointOf(*mesh, t, b)), 1e-13);
      }
    }
  }
}

/// Gradients by differences, at random points that are not those of the rule: means over the rule must be
/// exact for what is linear in the element.
TEST(Elements, GradientsAreThoseOfTheShapeFunctions) {
  const Shared mesh = shared(jittered(1, Vec3(1, 2, 0.5)));
  const Elements elements(mesh, ElementOrder::Quadratic);
  const std::vector<Vec3> x = elements.positions(mesh->nodes);
  for (std::size_t t = 0; t < mesh->tets.size(); ++t) {
    const ElementGradients g(Element(mesh->nodes, mesh->tets[t]), ElementOrder::Quadratic);
    for (std::size_t q = 0; q < 4; ++q) {
      Vec3 gradient = Vec3::Zero(), mean = Vec3::Zero();
      for (std::size_t i = 0; i < 10; ++i) {
        gradient += quadratic(x[at(elements.nodesOf(t)[i])]) * g.at(q, i);
        mean += quadratic(x[at(elements.nodesOf(t)[i])]) * g.mean(i);
      }
      Vec4 b = Vec4::Constant(0.13819660112501051518);
      b[static_cast<Eigen::Index>(q)] = 0.58541019662496845446;
      const auto exact = [](const Vec3& p) { return Vec3(-2 + 6 * p.x(), p.z(), p.y() - 2 * p.z()); };
      EXPECT_LT((gradient - exact(pointOf(*mesh, t, b))).norm(), 1e-12);
      EXPECT_LT((mean - exact(pointOf(*mesh, t, Vec4::Constant(0.25)))).norm(), 1e-12);
    }
  }
}

TEST(Elements, MassIsThatOfTheProductsOfShapeFunctions) {
  const Elements elements(shared(box(1, 1, 1, Vec3(1, 1, 1))), ElementOrder::Quadratic);
  const Eigen::MatrixXd mass = elementMass(ElementOrder::Quadratic);
  EXPECT_NEAR(mass.sum(), 1, 1e-14);
  EXPECT_EQ(mass, mass.transpose());
  // Every product is a quartic: midpoints of a fine lattice come close, and independently of any formula.
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(10, 10);
  constexpr int kCells = 24;
  int points = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; i + j < kCells; ++j)
      for (int k = 0; i + j + k < kCells; ++k) {
        const Vec4 b = Vec4(i + 0.25, j + 0.25, k + 0.25, kCells - 1 - i - j - k + 0.25) / kCells;
        const auto value = elements.shapeValues(b);
        const Eigen::Map<const Eigen::VectorXd> v(value.data(), 10);
        found += v * v.transpose();
        ++points;
      }
  EXPECT_LT((found / points - mass).cwiseAbs().maxCoeff(), 3e-3);
}

Mat3 someStrain() {
  Mat3 strain;
  strain << 3, 1, -2, 1, -4, 0.5, -2, 0.5, 2;
  return 1e-5 * strain;
}

TEST(PatchTest, ConstantStrainIsExactForEveryElementAndPoissonsRatio) {
  const Shared mesh = shared(jittered(2, Vec3(1, 2, 0.5)));
  const Mat3 strain = someStrain();
  for (const ElementOrder order : kOrders)
    for (const double poisson : {-0.5, 0.0, 0.2, 0.45, 0.4999}) {
      const Statics statics = factored(mesh, {poisson, order});
      const Mat3 stress = kYoung * Element::stress(strain, Lame(poisson));
      const std::vector<Vec3> force = tractionOn(*statics.elements(), [&](const Vec3&) { return stress; });
      const StaticSolution solution = statics.solve(force, kYoung);
      const double exact = 0.5 * stress.cwiseProduct(strain).sum();  // of 1 m³
      EXPECT_NEAR(sum(solution.tetEnergy), exact, 1e-9 * exact) << poisson;
      EXPECT_NEAR(solution.work, exact, 1e-9 * exact) << poisson;
      for (std::size_t t = 0; t < mesh->tets.size(); ++t)
        EXPECT_NEAR(solution.tetEnergy[t], exact * tetVolume(*mesh, t), 1e-8 * exact);
    }
}

/// A bar pushed at one end and otherwise free: its displacement is quadratic, so that quadratic elements have
/// it exactly, and its energy U = F² L / (6 E A) with ν = 0. Linear ones are of second order.
TEST(KnownAnswer, BarPushedAtOneEnd) {
  const double length = 2, width = 0.5, push = 1e6;
  const double exact = push * push * length / (6 * kYoung * width * width);
  const auto errorOf = [&](ElementOrder order, int n) {
    const Statics statics = factored(shared(box(n, 1, 1, Vec3(length, width, width))), {0, order});
    const std::vector<Vec3> force = tractionOn(*statics.elements(), [&](const Vec3& x) {
      Mat3 stress = Mat3::Zero();
      if (x.x() < 1e-9) stress(0, 0) = -push / (width * width);
      return stress;
    });
    return std::abs(statics.solve(force, kYoung).work / exact - 1);
  };
  EXPECT_LT(errorOf(ElementOrder::Quadratic, 2), 1e-10);
  EXPECT_NEAR(std::log2(errorOf(ElementOrder::Linear, 8) / errorOf(ElementOrder::Linear, 16)), 2, 0.1);
  EXPECT_LT(errorOf(ElementOrder::Linear, 16), 5e-3);
}

TEST(KnownAnswer, CantileverConvergesToTimoshenkosWithTheElementsOrder) {
  const Cantilever beam;
  const auto errorOf = [&](ElementOrder order, int k) {
    const Statics statics = factored(shared(beam.mesh(k)), {0, order});
    const double energy = statics.solve(beam.load(*statics.elements()), kYoung).work;
    EXPECT_LT(energy, beam.energy(kYoung));  // a displacement method is too stiff
    return 1 - energy / beam.energy(kYoung);
  };
  const double linear2 = errorOf(ElementOrder::Linear, 2), linear4 = errorOf(ElementOrder::Linear, 4),
               quadratic1 = errorOf(ElementOrder::Quadratic, 1),
               quadratic2 = errorOf(ElementOrder::Quadratic, 2);
  RecordProperty("linear_order", std::to_string(std::log2(linear2 / linear4)));
  RecordProperty("quadratic_order", std::to_string(std::log2(quadratic1 / quadratic2)));
  EXPECT_GT(std::log2(linear2 / linear4), 1.7);
  EXPECT_GT(std::log2(quadratic1 / quadratic2), 3.6);
  EXPECT_LT(linear4, 0.1);
  EXPECT_LT(quadratic2, 1e-3);
}

/// Pure bending has the same energy for every ν; elements that lock have next to none of it near ½.
TEST(NearlyIncompressible, BendingDoesNotLock) {
  const PureBending beam;
  const auto shareOf = [&](const StaticsParams& params, int k) {
    const Statics statics = factored(shared(beam.mesh(k)), params);
    return statics.solve(beam.load(*statics.elements(), kYoung), kYoung).work / beam.energy(kYoung);
  };
  const double plain = std::numeric_limits<double>::infinity();
  for (const double poisson : {0.3, 0.45, 0.49, 0.4999}) {
    EXPECT_NEAR(shareOf({poisson, ElementOrder::Quadratic}, 1), 1, 0.02) << poisson;
    EXPECT_NEAR(shareOf({poisson, ElementOrder::Linear}, 3), shareOf({0, ElementOrder::Linear}, 3), 0.1)
        << poisson;
  }
  EXPECT_LT(shareOf({0.4999, ElementOrder::Linear, -1, plain}, 3), 0.5);  // what the averages are for
  const double coarse = 1 - shareOf({0.4999, ElementOrder::Linear}, 2),
               fine = 1 - shareOf({0.4999, ElementOrder::Linear}, 4);
  EXPECT_LT(std::abs(fine), 0.4 * std::abs(coarse));
}

/// Where strains vary, quadratic elements lock as well, less: all energies of plain ones are too small, and
/// on the same mesh averages come closer.
TEST(NearlyIncompressible, AveragesConvergeFasterUnderAPatch) {
  const auto energyOf = [](ElementOrder order, int n, double largestFull) {
    const Statics statics = factored(shared(ball(n, 0.1)), {0.4999, order, -1, largestFull});
    const PatchLoader loader(statics.elements());
    std::vector<Vec3> force(statics.elements()->nodeCount(), Vec3::Zero());
    for (const double side : {-1.0, 1.0})
      EXPECT_TRUE(loader.add(Vec3(0, side * 0.1, 0), Vec3(0, -side * 1e4, 0), 0.04, force).ok());
    return statics.solve(force, kYoung).work;
  };
  const double plain = std::numeric_limits<double>::infinity(), averaged = VolumetricSplit::kLargestFull;
  const double fine = energyOf(ElementOrder::Quadratic, 5, averaged);
  const auto errorOf = [&](ElementOrder order, int n, double largestFull) {
    return std::abs(energyOf(order, n, largestFull) / fine - 1);
  };
  EXPECT_LT(errorOf(ElementOrder::Quadratic, 3, averaged), 0.05);
  EXPECT_LT(errorOf(ElementOrder::Quadratic, 3, averaged), 0.6 * errorOf(ElementOrder::Quadratic, 3, plain));
  EXPECT_LT(errorOf(ElementOrder::Linear, 8, averaged), 0.5 * errorOf(ElementOrder::Linear, 8, plain));
}

TEST(NearlyIncompressible, UpToTwoFifthsNothingIsAveraged) {
  const Shared mesh = shared(jittered(2, Vec3(1, 1, 1)));
  for (const ElementOrder order : kOrders) {
    const StaticsParams averaging{0.3999, order},
        plain{0.3999, order, -1, std::numeric_limits<double>::infinity()};
    const Statics a = factored(mesh, averaging), b = factored(mesh, plain);
    std::vector<Vec3> force(a.elements()->nodeCount(), Vec3::Zero());
    force[1] = Vec3(1, 2, 3);
    EXPECT_EQ(a.solve(force, kYoung).tetEnergy, b.solve(force, kYoung).tetEnergy);
  }
  // And just beyond, next to nothing: no step in ν.
  const Statics below = factored(mesh, {0.4 - 1e-9}), above = factored(mesh, {0.4 + 1e-9});
  std::vector<Vec3> force(mesh->nodes.size(), Vec3::Zero());
  force[1] = Vec3(1, 2, 3);
  const double work = below.solve(force, kYoung).work;
  EXPECT_NEAR(above.solve(force, kYoung).work, work, 1e-7 * work);
}

/// A ball between two patches: coarse meshes are too stiff and come from below, quadratic elements are ahead.
TEST(KnownAnswer, BallBetweenTwoPatchLoads) {
  const auto energyOf = [](ElementOrder order, int n) {
    const Statics statics = factored(shared(ball(n, 0.1)), {0.2, order});
    const PatchLoader loader(statics.elements());
    std::vector<Vec3> force(statics.elements()->nodeCount(), Vec3::Zero());
    for (const double side : {-1.0, 1.0})
      EXPECT_TRUE(loader.add(Vec3(0, side * 0.1, 0), Vec3(0, -side * 1e4, 0), 0.04, force).ok());
    return statics.solve(force, kYoung).work;
  };
  const double l4 = energyOf(ElementOrder::Linear, 4), l6 = energyOf(ElementOrder::Linear, 6),
               l12 = energyOf(ElementOrder::Linear, 12), q4 = energyOf(ElementOrder::Quadratic, 4),
               q6 = energyOf(ElementOrder::Quadratic, 6);
  EXPECT_LT(l4, l6);
  EXPECT_LT(l6, l12);
  EXPECT_LT(std::abs(q6 - q4), 0.1 * q6);
  const double limit = l12 + (l12 - l6) / 3;  // Richardson, second order
  EXPECT_NEAR(q6, limit, 0.06 * limit);       // their surfaces differ, too
}

/// Rods in a row whose moduli alternate by a factor of a million: under tension each has its own exact
/// energy.
TEST(KnownAnswer, StiffnessContrastOfAMillion) {
  const Shared mesh = shared(box(6, 2, 2, Vec3(3, 0.5, 0.5)));
  for (const ElementOrder order : kOrders) {
    const Elements elements(mesh, order);
    std::vector<double> weight(mesh->tets.size());
    double exact = 0;
    for (std::size_t t = 0; t < weight.size(); ++t) {
      const int cube = static_cast<int>(t / 6) % 6;
      const double modulus = cube % 2 == 0 ? 1 : 1e-6;
      weight[t] = modulus * tetVolume(*mesh, t);
      exact += 0.5 / modulus * tetVolume(*mesh, t);  // σ = 1
    }
    const Lame lame(0.0);
    BlockMatrix stiffness = assembleStiffness(elements, ElementRules(elements, weight, {}), mesh->nodes,
                                              weight, lame.mu, VolumetricSplit(lame));
    std::vector<Index> members(mesh->nodes.size());
    std::iota(members.begin(), members.end(), 0);
    addGauge(stiffness, mesh->nodes, members, -1);
    const std::vector<Vec3> x = elements.positions(mesh->nodes);
    const Result<SparseCholesky> factor = SparseCholesky::factor(stiffness, nestedDissection(x, stiffness));
    ASSERT_TRUE(factor.ok()) << factor.error().text();
    const std::vector<Vec3> force =
        tractionOn(elements, [](const Vec3&) { return Mat3(Vec3(1, 0, 0).asDiagonal()); });
    std::vector<Vec3> u = force;
    factor->solve(u);
    double work = 0;
    for (std::size_t n = 0; n < u.size(); ++n) work += 0.5 * u[n].dot(force[n]);
    EXPECT_NEAR(work, exact, 1e-7 * exact);  // unrefined: the contrast costs six digits
  }
}

TEST(QuadraticInsideFraction, EdgesThatHardlyAnythingHoldsAreNoProblem) {
  TetMesh cage = box(4, 2, 2, Vec3(4, 2, 2));
  for (std::size_t t = 0; t < cage.tets.size(); ++t)
    cage.insideFraction[t] = t % 4 == 0 ? 0 : 1e-7 * static_cast<double>(t % 3);
  const Statics statics = factored(shared(cage), {0.2, ElementOrder::Quadratic});
  std::vector<Vec3> force(statics.elements()->nodeCount(), Vec3::Zero());
  force[3] = Vec3(1, -1, 2);
  const StaticSolution solution = statics.solve(force, kYoung);
  EXPECT_TRUE(std::isfinite(solution.work) && solution.work > 0);
  EXPECT_NEAR(sum(solution.tetEnergy), solution.work, 1e-10 * solution.work);
}

TEST(QuadraticInertiaRelief, BalanceWorkAndGauge) {
  TetMesh partly = uShape(1, 2, 3, 1, 0.1);
  for (std::size_t t = 0; t < partly.tets.size(); ++t)
    partly.insideFraction[t] = 0.1 + 0.1 * static_cast<double>(t % 9);
  const Shared mesh = shared(partly);
  const Statics statics = factored(mesh, {0.2, ElementOrder::Quadratic});
  Rng rng(3);
  std::vector<Vec3> force(statics.elements()->nodeCount());
  for (Vec3& f : force) f = Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
  const std::vector<Vec3> load = statics.balanced(force), x = statics.elements()->positions(mesh->nodes);
  Vec3 net = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t n = 0; n < load.size(); ++n) {
    net += load[n];
    moment += x[n].cross(load[n]);
  }
  EXPECT_LT(net.norm(), 1e-12);
  EXPECT_LT(moment.norm(), 1e-12);
  const StaticSolution solution = statics.solve(force, kYoung);
  EXPECT_NEAR(sum(solution.tetEnergy), solution.work, 1e-10 * solution.work);
  for (const Index gauge : {Index{0}, Index{17}}) {
    const double other = factored(mesh, {0.2, ElementOrder::Quadratic, gauge}).solve(force, kYoung).work;
    EXPECT_NEAR(other, solution.work, 1e-8 * solution.work);
  }
}

}  // namespace
