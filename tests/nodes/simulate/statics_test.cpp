#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/rng.h"
#include "simulate/assembly.h"
#include "simulate/statics.h"
#include "support/elastic_loads.h"

using namespace sherd;
using namespace sherd::families;

namespace {

using Shared = std::shared_ptr<const TetMesh>;
constexpr double kYoung = 5e10, kPoisson = 0.2;

Statics factored(const Shared& mesh, Index gauge = -1, double poisson = kPoisson) {
  Result<Statics> statics = Statics::factor(mesh, {poisson, ElementOrder::Linear, gauge}, {});
  EXPECT_TRUE(statics.ok()) << (statics.ok() ? "" : statics.error().text());
  return std::move(statics).value();
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Any forces: seeded, one per node.
std::vector<Vec3> anyForce(std::size_t nodes, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3> force(nodes);
  for (Vec3& f : force) f = Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5) * 1e4;
  return force;
}

/// Nodal forces of the constant stress acting on the boundary.
std::vector<Vec3> traction(const TetMesh& mesh, const Mat3& stress) {
  std::vector<Vec3> force(mesh.nodes.size(), Vec3::Zero());
  for (const Triangle& t : mesh.boundary) {
    const Vec3 area =
        0.5 *
        (mesh.nodes[at(t[1])] - mesh.nodes[at(t[0])]).cross(mesh.nodes[at(t[2])] - mesh.nodes[at(t[0])]);
    for (const Index n : t) force[at(n)] += stress * area / 3;
  }
  return force;
}

Mat3 someStrain() {
  Mat3 strain;
  strain << 3, 1, -2, 1, -4, 0.5, -2, 0.5, 2;
  return 1e-5 * strain;
}

Mat3 stressOf(const Mat3& strain) { return kYoung * Element::stress(strain, Lame(kPoisson)); }

TEST(Statics, RefusesBadTetrahedra) {
  TetMesh mesh = box(1, 1, 1, Vec3(1, 1, 1));
  std::swap(mesh.tets[3][0], mesh.tets[3][1]);
  const Result<Statics> inverted = Statics::factor(shared(mesh), {kPoisson}, {});
  ASSERT_FALSE(inverted.ok());
  EXPECT_NE(inverted.error().text().find("tetrahedron 3 is flat or inverted"), std::string::npos);
  EXPECT_FALSE(Statics::factor(shared(TetMesh{}), {kPoisson}, {}).ok());
}

TEST(Statics, RefusesAHinge) {
  // Two cubes that share one edge: they can turn against each other.
  const TetMesh mesh = fromCubes({{0, 0, 0}, {1, 1, 0}}, Vec3(1, 1, 1));
  const Result<Statics> hinge = Statics::factor(shared(mesh), {kPoisson}, {});
  ASSERT_FALSE(hinge.ok());
  EXPECT_NE(hinge.error().text().find("hang together by faces"), std::string::npos);
}

TEST(Statics, CancellingIsAnError) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const Result<Statics> statics = Statics::factor(shared(box(1, 1, 1, Vec3(1, 1, 1))), {kPoisson}, exec);
  ASSERT_FALSE(statics.ok());
  EXPECT_EQ(statics.error().kind, Error::Kind::Cancelled);
}

TEST(PatchTest, LinearDisplacementGivesTheExactForcesAndEnergy) {
  const Shared mesh = shared(jittered(3, Vec3(1, 2, 0.5)));
  const Statics statics = factored(mesh);
  const Mat3 strain = someStrain(), stress = stressOf(strain);
  std::vector<Vec3> u;
  for (const Vec3& x : mesh->nodes) u.push_back(strain * x + Vec3(0.3, 0.1, -0.2));
  const std::vector<Vec3> inner = statics.internalForce(u, kYoung), outer = traction(*mesh, stress);
  double largest = 0;
  for (const Vec3& f : outer) largest = std::max(largest, f.norm());
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT((inner[n] - outer[n]).norm(), 1e-10 * largest);
  const std::vector<double> energy = statics.tetEnergies(u, kYoung);
  for (std::size_t t = 0; t < energy.size(); ++t) {
    const double exact = 0.5 * (stress.cwiseProduct(strain)).sum() * tetVolume(*mesh, t);
    EXPECT_NEAR(energy[t], exact, 1e-10 * exact);
  }
}

TEST(PatchTest, ConstantTractionGivesConstantStrain) {
  const Shared mesh = shared(jittered(4, Vec3(1, 2, 0.5)));
  const Mat3 strain = someStrain();
  const StaticSolution solution = factored(mesh).solve(traction(*mesh, stressOf(strain)), kYoung);
  for (const Tetra& tet : mesh->tets) {
    const Mat3 found = Element(mesh->nodes, tet).strain(solution.displacement, tet);
    EXPECT_LT((found - strain).norm(), 1e-10 * strain.norm());
  }
  const double exact = 0.5 * stressOf(strain).cwiseProduct(strain).sum() * 1.0;
  EXPECT_NEAR(sum(solution.tetEnergy), exact, 1e-10 * exact);
}

TEST(Statics, RigidMotionsAreStressFree) {
  const Shared mesh = shared(uShape(1, 1, 3, 2, 0.1));
  const Statics statics = factored(mesh);
  for (int mode = 0; mode < 6; ++mode) {
    std::vector<Vec3> u;
    for (const Vec3& x : mesh->nodes)
      u.push_back(mode < 3 ? Vec3(Vec3::Unit(mode)) : Vec3(Vec3::Unit(mode - 3).cross(x)));
    for (const Vec3& f : statics.internalForce(u, kYoung)) EXPECT_LT(f.norm(), 1e-12 * kYoung * 0.1);
  }
}

TEST(InertiaRelief, LeavesNoForceAndNoMoment) {
  TetMesh partly = uShape(1, 2, 4, 2, 0.1);
  for (std::size_t t = 0; t < partly.tets.size(); ++t)
    partly.insideFraction[t] = 0.1 + 0.1 * static_cast<double>(t % 9);
  const Shared mesh = shared(partly);
  const std::vector<Vec3> force = anyForce(mesh->nodes.size(), 3), load = factored(mesh).balanced(force);
  Vec3 net = Vec3::Zero(), moment = Vec3::Zero();
  double scale = 0;
  for (std::size_t n = 0; n < load.size(); ++n) {
    net += load[n];
    moment += mesh->nodes[n].cross(load[n]);
    scale += force[n].norm();
  }
  EXPECT_LT(net.norm(), 1e-13 * scale);
  EXPECT_LT(moment.norm(), 1e-13 * scale);
}

TEST(InertiaRelief, WorkIsTheStrainEnergy) {
  for (const Shared& mesh : {shared(jittered(4, Vec3(1, 1, 1))), shared(uShape(1, 2, 6, 1, 1e-3)),
                             shared(twoBoxes(2, 1, 50)), shared(hollowBox(5, 1, 0.1))}) {
    const StaticSolution solution = factored(mesh).solve(anyForce(mesh->nodes.size(), 7), kYoung);
    EXPECT_NEAR(sum(solution.tetEnergy), solution.work, 1e-10 * solution.work);
    for (const double e : solution.tetEnergy) EXPECT_GE(e, 0);
    EXPECT_GT(solution.work, 0);
  }
}

TEST(InertiaRelief, TheGaugeDoesNotMatter) {
  TetMesh partly = uShape(1, 2, 6, 2, 0.05);
  for (std::size_t t = 0; t < partly.tets.size(); ++t) partly.insideFraction[t] = t % 5 == 0 ? 0.003 : 0.8;
  const Shared mesh = shared(partly);
  const std::vector<Vec3> force = anyForce(mesh->nodes.size(), 11);
  const StaticSolution reference = factored(mesh).solve(force, kYoung);
  for (const Index gauge : {Index{0}, Index{17}, static_cast<Index>(mesh->nodes.size() - 1)}) {
    const StaticSolution other = factored(mesh, gauge).solve(force, kYoung);
    EXPECT_NEAR(other.work, reference.work, 1e-8 * reference.work);
    for (std::size_t n = 0; n < force.size(); ++n)
      EXPECT_LT((other.displacement[n] - reference.displacement[n]).norm(),
                1e-8 * reference.displacement[n].norm() + 1e-14);
  }
}

TEST(InertiaRelief, PartsAreBalancedOneByOne) {
  const Shared mesh = shared(twoBoxes(2, 1, 0.1));
  std::vector<Vec3> force = anyForce(mesh->nodes.size(), 13);
  const Statics statics = factored(mesh);
  EXPECT_EQ(statics.partCount(), 2U);
  for (std::size_t n = 0; n < force.size(); ++n)
    if (mesh->nodes[n].x() > 0.25) force[n].setZero();
  const StaticSolution solution = statics.solve(force, kYoung);
  for (std::size_t t = 0; t < mesh->tets.size(); ++t) {
    const bool loaded = mesh->nodes[at(mesh->tets[t][0])].x() < 0.25;
    EXPECT_EQ(solution.tetEnergy[t] > 0, loaded);
  }
}

TEST(Invariance, UnderRigidMotionOfBodyAndLoad) {
  const TetMesh mesh = uShape(1, 2, 5, 2, 0.1);
  const std::vector<Vec3> force = anyForce(mesh.nodes.size(), 17);
  const double reference = factored(shared(mesh)).solve(force, kYoung).work;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  const TetMesh moved = mapped(mesh, [&](const Vec3& p) { return Vec3(turn * p + Vec3(10, -3, 5)); });
  std::vector<Vec3> turned;
  for (const Vec3& f : force) turned.push_back(turn * f);
  EXPECT_NEAR(factored(shared(moved)).solve(turned, kYoung).work, reference, 1e-9 * reference);
}

TEST(Invariance, UnderRenumberingOfNodes) {
  const TetMesh mesh = uShape(1, 2, 5, 2, 0.1);
  const std::vector<Vec3> force = anyForce(mesh.nodes.size(), 19);
  const StaticSolution reference = factored(shared(mesh)).solve(force, kYoung);
  std::vector<Index> newName(mesh.nodes.size());
  std::iota(newName.begin(), newName.end(), 0);
  Rng rng(23);
  for (std::size_t i = newName.size(); i > 1; --i) std::swap(newName[i - 1], newName[rng.below(i)]);
  TetMesh renamed = mesh;
  std::vector<Vec3> renamedForce(force.size());
  for (std::size_t n = 0; n < force.size(); ++n) {
    renamed.nodes[at(newName[n])] = mesh.nodes[n];
    renamedForce[at(newName[n])] = force[n];
  }
  for (Tetra& tet : renamed.tets)
    for (Index& n : tet) n = newName[at(n)];
  const StaticSolution other = factored(shared(renamed)).solve(renamedForce, kYoung);
  EXPECT_NEAR(other.work, reference.work, 1e-9 * reference.work);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    EXPECT_NEAR(other.tetEnergy[t], reference.tetEnergy[t], 1e-8 * reference.work);
}

TEST(Invariance, EnergyIsQuadraticInLoadAndInverseInYoung) {
  const Shared mesh = shared(box(3, 2, 4, Vec3(1, 1, 1)));
  std::vector<Vec3> force = anyForce(mesh->nodes.size(), 29);
  const Statics statics = factored(mesh);
  const double once = statics.solve(force, kYoung).work;
  EXPECT_NEAR(statics.solve(force, 2 * kYoung).work, once / 2, 1e-12 * once);
  for (Vec3& f : force) f *= 3;
  EXPECT_NEAR(statics.solve(force, kYoung).work, 9 * once, 1e-12 * 9 * once);
}

/// A bar pushed at one end floats: its acceleration is uniform and its stress falls linearly to the free end,
/// so that U = F² L / (6 E A) with ν = 0. Linear tetrahedra are too stiff by O(h²).
TEST(Bar, PushedAtOneEndConvergesToTheAnalyticEnergy) {
  const double length = 2, width = 0.5, push = 1e6;
  const double exact = push * push * length / (6 * kYoung * width * width);
  double previous = 1;
  for (const int n : {4, 8, 16}) {
    const Shared mesh = shared(box(n, 2, 2, Vec3(length, width, width)));
    std::vector<Vec3> force(mesh->nodes.size(), Vec3::Zero());
    for (const Triangle& t : mesh->boundary) {
      const Vec3 &a = mesh->nodes[at(t[0])], &b = mesh->nodes[at(t[1])], &c = mesh->nodes[at(t[2])];
      if (a.x() != 0 || b.x() != 0 || c.x() != 0) continue;
      const double share = 0.5 * (b - a).cross(c - a).norm() / (width * width);
      for (const Index i : t) force[at(i)].x() += push * share / 3;
    }
    const double energy = factored(mesh, -1, 0).solve(force, kYoung).work;
    const double error = std::abs(energy - exact) / exact;
    EXPECT_LT(error, previous / 3.5);
    previous = error;
  }
  EXPECT_LT(previous, 5e-3);
}

/// Pulled at both ends the load is balanced by itself: U = F² L / (2 E A), exact for linear elements.
TEST(Bar, PulledAtBothEndsIsExact) {
  const Shared mesh = shared(box(6, 2, 2, Vec3(3, 0.5, 0.5)));
  Mat3 stress = Mat3::Zero();
  stress(0, 0) = 4e6;
  const double force = 4e6 * 0.25, exact = force * force * 3 / (2 * kYoung * 0.25);
  EXPECT_NEAR(factored(mesh).solve(traction(*mesh, stress), kYoung).work, exact, 1e-10 * exact);
}

/// Tetrahedra outside of the surface make next to no difference, and nodes that only they
/// have are no problem.
TEST(InsideFraction, WhatIsOutsideHasNoStiffnessAndNoMass) {
  TetMesh cage = box(8, 2, 2, Vec3(4, 1, 1));
  std::vector<Vec3> force(cage.nodes.size(), Vec3::Zero());
  Mat3 stress = Mat3::Zero();
  stress(0, 0) = 1e6;
  for (std::size_t t = 0; t < cage.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const Index n : cage.tets[t]) centre += cage.nodes[at(n)] / 4;
    cage.insideFraction[t] = centre.x() < 3 ? 1 : 0;
  }
  // The body is the first 3 m; pulled at x = 0 and x = 3.
  const TetMesh inner = box(6, 2, 2, Vec3(3, 1, 1));
  const std::vector<Vec3> innerForce = traction(inner, stress);
  for (std::size_t i = 0; i < inner.nodes.size(); ++i)
    for (std::size_t n = 0; n < cage.nodes.size(); ++n)
      if ((cage.nodes[n] - inner.nodes[i]).norm() < 1e-9) force[n] = innerForce[i];
  const double exact = factored(shared(inner)).solve(innerForce, kYoung).work;
  const double found = factored(shared(cage)).solve(force, kYoung).work;
  EXPECT_NEAR(found, exact, 0.02 * exact);
  EXPECT_LE(found, exact * (1 + 1e-9));
}

TEST(InsideFraction, SliversAndExtremeUnitsStayFinite) {
  for (const double unit : {1e-3, 1.0, 1e3}) {
    const TetMesh flat = mapped(box(4, 4, 4, unit * Vec3(1, 1, 1)), [&](const Vec3& p) {
      return Vec3(p.x(), p.y() + 0.999 * unit / 4 * (p.x() / unit), 1e-4 * p.z());
    });
    TetMesh partly = flat;
    for (std::size_t t = 0; t < partly.tets.size(); ++t) partly.insideFraction[t] = t % 3 == 0 ? 1e-9 : 0.4;
    const Shared mesh = shared(partly);
    const StaticSolution solution = factored(mesh).solve(anyForce(mesh->nodes.size(), 31), kYoung);
    EXPECT_TRUE(std::isfinite(solution.work) && solution.work > 0);
    EXPECT_NEAR(sum(solution.tetEnergy), solution.work, 1e-6 * solution.work);
  }
}

TEST(Statics, TwoFactorizationsAreBitIdentical) {
  const Shared mesh = shared(uShape(2, 2, 6, 2, 0.1));
  const std::vector<Vec3> force = anyForce(mesh->nodes.size(), 37);
  const StaticSolution a = factored(mesh).solve(force, kYoung), b = factored(mesh).solve(force, kYoung);
  EXPECT_EQ(a.tetEnergy, b.tetEnergy);
  EXPECT_EQ(a.work, b.work);
}

}  // namespace
