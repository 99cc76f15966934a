#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "graph/node_type.h"
#include "simulate/simulate.h"
#include "simulate/statics.h"
#include "support/tet_families.h"

namespace sherd {
NodeType simulateNode();
}

using namespace sherd;
using namespace sherd::families;

namespace {

using Shared = std::shared_ptr<const TetMesh>;

struct Messages {
  std::vector<std::string> infos, warnings;
  Exec exec() {
    Exec e;
    e.onMessage = [this](LogLevel level, const std::string& line) {
      (level == LogLevel::Warning ? warnings : infos).push_back(line);
    };
    return e;
  }
};

SimulateOutput run(const Shared& mesh, const SimulateParams& params, const Exec& exec = {}) {
  Result<SimulateOutput> out = simulate(mesh, params, exec);
  EXPECT_TRUE(out.ok()) << (out.ok() ? "" : out.error().text());
  return std::move(out).value();
}

Shared someU() { return shared(uShape(1, 2, 6, 2, 0.05)); }

SimulateParams tilted() {
  SimulateParams params;
  params.orientation = Vec3(25, 10, 40);
  return params;
}

/// A node that next to nothing of the body reaches to has the energy density of what does: raised to a power,
/// it would otherwise outweigh all others.
TEST(Simulate, WhatHoldsUpNodesOutsideTheSurfaceHasNoEnergy) {
  TetMesh cage = box(4, 3, 3, Vec3(0.4, 0.3, 0.3));
  for (std::size_t t = 0; t < cage.tets.size(); ++t)
    for (const Index n : cage.tets[t])
      if (cage.nodes[at(n)].x() == 0) cage.insideFraction[t] = 1e-9;
  const Shared mesh = shared(std::move(cage));
  const SimulateOutput out = run(mesh, tilted());
  const std::vector<double> volume = lumpedVolumes(*mesh);
  std::vector<double> largest(mesh->nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh->tets.size(); ++t)
    for (const Index n : mesh->tets[t])
      largest[at(n)] = std::max(
          largest[at(n)],
          out.energy.tetEnergy[t] / (tetVolume(*mesh, t) * std::max(mesh->insideFraction[t], kLeastSupport)));
  for (std::size_t n = 0; n < volume.size(); ++n)
    EXPECT_LE(out.energy.nodeEnergy[n] / volume[n], largest[n] * (1 + 1e-12)) << n;
}

/// A fracture of a body that nothing hit would be one whole piece, as if it were tough.
TEST(Simulate, WithoutAHitFailsByTheParametersName) {
  const auto errorOf = [](const SimulateParams& params) {
    const Result<SimulateOutput> out = simulate(someU(), params, {});
    return out.ok() ? failure("no error") : out.error();
  };
  SimulateParams params = tilted();
  params.gravity = 0;
  EXPECT_EQ(errorOf(params).port, "gravity");
  params = tilted();
  params.dropHeight = 1000;
  EXPECT_EQ(errorOf(params).port, "max_time");
  EXPECT_NE(errorOf(params).text().find("14.3 s"), std::string::npos) << errorOf(params).text();
  params.maxTime = 14.3;
  EXPECT_EQ(errorOf(params).what, "no error");
  params = tilted();
  params.scene = RigidScene::Ball;
  params.ballTarget = Vec3(0.5, 5, 0.5);
  EXPECT_EQ(errorOf(params).port, "ball_target");
  params.ballTarget = Vec3(0.5, 0.2, 0.5);
  EXPECT_EQ(errorOf(params).what, "no error");
}

/// Hertz's contact of a body as soft as nothing is larger than any body: it is cut, and said to be.
TEST(Simulate, AbsurdlySoftIsToldAsSuch) {
  Messages said;
  SimulateParams params = tilted();
  params.body.youngModulus = 1e-300;
  const Result<SimulateOutput> out = simulate(someU(), params, said.exec());
  EXPECT_TRUE(out.ok() || out.error().text().find("young") != std::string::npos);
  ASSERT_EQ(said.warnings.size(), 1U);
  EXPECT_NE(said.warnings[0].find("young"), std::string::npos) << said.warnings[0];
}

TEST(Simulate, BelowTheThresholdStaticsAreSkipped) {
  Messages said;
  SimulateParams params = tilted();
  params.threshold = 1e6;
  const SimulateOutput weak = run(someU(), params, said.exec());
  EXPECT_TRUE(weak.impact.hit);
  EXPECT_EQ(totalEnergy(weak.energy), 0);
  ASSERT_EQ(said.infos.size(), 1U);
  EXPECT_NE(said.infos[0].find("below the threshold"), std::string::npos);
  params.threshold = 1e-3;
  EXPECT_GT(totalEnergy(run(someU(), params, said.exec()).energy), 0);
  EXPECT_NE(said.infos[1].find("strain energy"), std::string::npos);
  params.threshold = -1;
  EXPECT_FALSE(simulate(someU(), params, {}).ok());
}

/// A sheet a million times longer than thick has a stiffness that is singular to rounding: no energy is
/// better than any.
TEST(Simulate, WhatRoundingLeavesNothingOfIsAnError) {
  SimulateParams params = tilted();
  params.body.poissonRatio = 0.4999;
  const auto sheet = shared(box(4, 4, 1, Vec3(1, 1, 1e-6)));
  const Result<SimulateOutput> out = simulate(sheet, params, {});
  ASSERT_FALSE(out.ok());
  EXPECT_NE(out.error().text().find("too flat"), std::string::npos) << out.error().text();
}

TEST(Simulate, QuadraticElementsGiveMoreEnergyInBendingOnTheSameMesh) {
  SimulateParams params = tilted();
  const SimulateOutput linear = run(someU(), params);
  params.elements = ElementOrder::Quadratic;
  const SimulateOutput quadratic = run(someU(), params);
  EXPECT_GT(totalEnergy(quadratic.energy), totalEnergy(linear.energy));
  EXPECT_EQ(quadratic.energy.displacement.size(), someU()->nodes.size());
  EXPECT_EQ(quadratic.energy.nodeEnergy.size(), someU()->nodes.size());
}

TEST(Simulate, SaysWhatMemoryFactoringTook) {
  Messages said;
  run(someU(), tilted(), said.exec());
  ASSERT_EQ(said.infos.size(), 1U);
  EXPECT_NE(said.infos[0].find("factorized in at most"), std::string::npos) << said.infos[0];
  EXPECT_NE(said.infos[0].find("MB"), std::string::npos);
}

TEST(Simulate, NodesGetQuartersOfTheirTetrahedra) {
  const SimulateOutput out = run(someU(), tilted());
  const double tets = totalEnergy(out.energy);
  const double nodes = std::accumulate(out.energy.nodeEnergy.begin(), out.energy.nodeEnergy.end(), 0.0);
  EXPECT_GT(tets, 0);
  EXPECT_NEAR(nodes, tets, 1e-12 * tets);
}

TEST(Simulate, EnergyGrowsWithTheDropHeight) {
  SimulateParams params = tilted();
  params.contactDuration = 2e-4;
  params.contactRadius = 0.03;
  const double one = totalEnergy(run(someU(), params).energy);
  params.dropHeight = 4;
  EXPECT_NEAR(totalEnergy(run(someU(), params).energy), 4 * one, 1e-6 * one);
  params.contactDuration = 0;
  params.dropHeight = 1;
  const double hertz = totalEnergy(run(someU(), params).energy);
  params.dropHeight = 4;
  EXPECT_NEAR(totalEnergy(run(someU(), params).energy), std::pow(4, 1.2) * hertz, 1e-4 * hertz);
}

TEST(Simulate, HalvingTheTimeStepKeepsTheEnergy) {
  SimulateParams params = tilted();
  params.angularVelocity = Vec3(3, -7, 11);
  const double energy = totalEnergy(run(someU(), params).energy);
  params.timeStep /= 2;
  EXPECT_NEAR(totalEnergy(run(someU(), params).energy), energy, 1e-4 * energy);
  params.timeStep = 1.0 / 24;
  EXPECT_NEAR(totalEnergy(run(someU(), params).energy), energy, 1e-4 * energy);
}

/// The mesh's place in rest space and the way it is turned there, undone by the orientation, don't matter.
TEST(Simulate, RestSpaceDoesNotMatter) {
  const SimulateParams params = tilted();
  const double energy = totalEnergy(run(someU(), params).energy);
  const auto moved = shared(mapped(*someU(), [](const Vec3& p) { return Vec3(p + Vec3(3, -8, 2)); }));
  EXPECT_NEAR(totalEnergy(run(moved, params).energy), energy, 1e-6 * energy);
  SimulateParams straight = params;
  straight.orientation.setZero();
  const double d = M_PI / 180;
  const Mat3 turn = (Eigen::AngleAxisd(40 * d, Vec3::UnitZ()) * Eigen::AngleAxisd(10 * d, Vec3::UnitY()) *
                     Eigen::AngleAxisd(25 * d, Vec3::UnitX()))
                        .toRotationMatrix();
  const auto turned = shared(mapped(*someU(), [&](const Vec3& p) { return Vec3(turn * p); }));
  EXPECT_NEAR(totalEnergy(run(turned, straight).energy), energy, 1e-6 * energy);
}

/// The patch has a size, so a finer mesh comes to a limit (a point load's energy would go on growing).
TEST(Simulate, EnergySettlesAsTheMeshGetsFiner) {
  SimulateParams params;
  params.orientation = Vec3(0, 0, 45);
  params.contactRadius = 0.06;
  std::vector<double> energies;
  for (const int n : {4, 8, 16})
    energies.push_back(totalEnergy(run(shared(box(n, n, n, Vec3(0.2, 0.2, 0.2))), params).energy));
  EXPECT_LT(std::abs(energies[2] - energies[1]), 0.7 * std::abs(energies[1] - energies[0]));
  EXPECT_LT(std::abs(energies[2] - energies[1]), 0.15 * energies[2]);
}

TEST(Simulate, EnergyIsDensestAtTheImpact) {
  SimulateParams params;
  params.scene = RigidScene::Ball;
  params.ballTarget = Vec3(0.5, 0.25, 0.5);
  params.ballDirection = Vec3(0, 0, 1);
  const auto wall = shared(box(10, 10, 2, Vec3(1, 1, 0.1)));
  const SimulateOutput out = run(wall, params);
  const auto densest = std::max_element(out.energy.tetEnergy.begin(), out.energy.tetEnergy.end());
  const Tetra& tet = wall->tets[static_cast<std::size_t>(densest - out.energy.tetEnergy.begin())];
  EXPECT_LT((wall->nodes[at(tet[0])] - out.impact.contacts[0].point).norm(), 0.25);
}

TEST(Simulate, FiniteFromMillimetresToKilometres) {
  for (const double size : {1e-3, 1.0, 1e3}) {
    SimulateParams params = tilted();
    params.dropHeight = size;
    params.maxTime = 1000;
    const double energy = totalEnergy(run(shared(uShape(1, 2, 4, 1, size)), params).energy);
    EXPECT_TRUE(std::isfinite(energy) && energy > 0) << size;
  }
}

TEST(Simulate, SameBitsForAnyNumberOfThreads) {
  setThreadLimit(1);
  const SimulateOutput one = run(someU(), tilted());
  setThreadLimit(2);
  const SimulateOutput two = run(someU(), tilted());
  setThreadLimit(0);
  EXPECT_EQ(one.energy.tetEnergy, two.energy.tetEnergy);
  EXPECT_EQ(one.energy.displacement, two.energy.displacement);
}

TEST(SimulateNode, RunsWithItsDefaults) {
  const NodeType node = simulateNode();
  ParamValues values;
  for (const ParamInfo& param : node.params) {
    values[param.name] = param.fallback;
    EXPECT_FALSE(param.help.empty()) << param.name;
  }
  values.at("orientation") = std::vector<double>{25, 10, 40};
  const Exec exec;
  NodeIo io(exec);
  io.setInput("body", Value::of<TetMesh>(someU()));
  const Result<void> done = node.run(values, io);
  ASSERT_TRUE(done.ok()) << done.error().text();
  const double expected = totalEnergy(run(someU(), tilted()).energy);
  EXPECT_EQ(*io.output("work").as<double>(), expected);
  EXPECT_EQ(totalEnergy(*io.output("energy").as<EnergyField>()), expected);
  EXPECT_TRUE(io.output("impact").as<Impact>()->hit);
  EXPECT_EQ(node.outputs.front().name, "energy");
}

}  // namespace
