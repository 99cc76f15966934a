#include "embed/extension.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "embed/convexity.h"
#include "embed/part.h"
#include "embed/paths.h"
#include "embed/spectrum.h"
#include "support/tet_families.h"

namespace sherd {
namespace {

BodyPart partOf(const TetMesh& mesh) { return bodyParts(mesh, {.places = mesh.nodes}).front(); }

double linear(const Vec3& p) { return 0.3 + p.dot(Vec3(1.5, -2, 0.7)); }

/// How far mean value coordinates at p are from reproducing 1, x, y, z and a linear function.
double linearError(const Vec3& p, const BodyPart& part) {
  const Eigen::VectorXd w = meanValueCoordinates(p, part.borderPositions, part.borderTriangles);
  Vec3 place = Vec3::Zero();
  double value = 0;
  for (std::size_t v = 0; v < part.borderPositions.size(); ++v) {
    place += w[static_cast<Eigen::Index>(v)] * part.borderPositions[v];
    value += w[static_cast<Eigen::Index>(v)] * linear(part.borderPositions[v]);
  }
  return std::max({(place - p).norm(), std::abs(value - linear(p)), std::abs(w.sum() - 1)});
}

TEST(MeanValue, ReproducesLinearFunctions) {
  std::mt19937 random(1);
  std::uniform_real_distribution<> uniform(0.001, 0.999);
  const BodyPart box = partOf(families::box(4, 3, 5, Vec3(1, 1, 1)));
  const BodyPart u = partOf(families::uShape(3, 3, 9, 3, 1.0 / 9));
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(uniform(random), uniform(random), uniform(random));
    EXPECT_LT(linearError(p, box), 1e-10) << p.transpose();
    const Vec3 q(p.x(), p.y() / 3, p.z() / 3);  // in the U's bridge
    EXPECT_LT(linearError(q, u), 1e-10) << q.transpose();
  }
  // Lattice points see many triangles edge-on.
  for (std::size_t n = 0; n < u.positions.size(); ++n) EXPECT_LT(linearError(u.positions[n], u), 1e-10);
}

TEST(MeanValue, HoldsNextToAndOnTheSurface) {
  const BodyPart box = partOf(families::box(3, 3, 3, Vec3(1, 1, 1)));
  for (const double above : {1e-3, 1e-6, 1e-9, 1e-11, 1e-13, 0.0})
    for (const Vec3& p : {Vec3(0.41, 0.27, above), Vec3(0.5, 0.5, above), Vec3(1.0 / 3, 0.4, above),
                          Vec3(above, above, above), Vec3(1.0 / 3, 2.0 / 3, above)})
      EXPECT_LT(linearError(p, box), 1e-10) << p.transpose();
  const Eigen::VectorXd onFace =
      meanValueCoordinates(Vec3(0.41, 0.27, 0), box.borderPositions, box.borderTriangles);
  EXPECT_EQ((onFace.array().abs() > 1e-9).count(), 3);
}

TEST(Harmonic, ReproducesLinearFunctions) {
  const BodyPart part = partOf(families::uShape(3, 3, 9, 3, 0.1));
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(part.positions.size()), 1);
  std::vector<char> given(part.positions.size(), 0);
  for (const Index n : part.borderNode) {
    values(n, 0) = linear(part.positions[at(n)]);
    given[at(n)] = 1;
  }
  ASSERT_TRUE(extendHarmonically(part.positions, part.tets, given, values).ok());
  for (std::size_t n = 0; n < part.positions.size(); ++n)
    EXPECT_NEAR(values(static_cast<Eigen::Index>(n), 0), linear(part.positions[n]), 1e-10);
}

TEST(Laplacian, ConstantsAreFreeAndLinearFunctionsHaveTheirEnergy) {
  const BodyPart part = partOf(families::box(4, 3, 2, Vec3(2, 1, 1)));
  const Laplacian solid = solidLaplacian(part.positions, part.tets);
  const Laplacian surface = surfaceLaplacian(part.borderPositions, part.borderTriangles);
  EXPECT_LT((solid.stiffness * Eigen::VectorXd::Ones(solid.mass.size())).norm(), 1e-12);
  EXPECT_LT((surface.stiffness * Eigen::VectorXd::Ones(surface.mass.size())).norm(), 1e-12);
  EXPECT_NEAR(solid.mass.sum(), 2, 1e-12);
  EXPECT_NEAR(surface.mass.sum(), 10, 1e-12);
  Eigen::VectorXd x(solid.mass.size()), onBorder(surface.mass.size());
  for (Eigen::Index n = 0; n < x.size(); ++n) x[n] = part.positions[static_cast<std::size_t>(n)].x();
  for (Eigen::Index v = 0; v < onBorder.size(); ++v)
    onBorder[v] = part.borderPositions[static_cast<std::size_t>(v)].x();
  EXPECT_NEAR(x.dot(solid.stiffness * x), 2, 1e-12);                  // ∫ |∇x|² = volume
  EXPECT_NEAR(onBorder.dot(surface.stiffness * onBorder), 8, 1e-12);  // area of the four sides along x
}

TEST(Modes, OfABarAreCosines) {
  const BodyPart part = partOf(families::box(48, 2, 2, Vec3(12, 0.5, 0.5)));  // enough nodes for Lanczos
  const auto modes = lowestModes(solidLaplacian(part.positions, part.tets), 5, {});
  ASSERT_TRUE(modes.ok());
  for (Eigen::Index k = 0; k < 5; ++k) {
    const double wave = std::numbers::pi * static_cast<double>(k + 1) / 12;
    EXPECT_NEAR(modes->eigenvalues[k] / (wave * wave), 1, 0.01);
    for (Eigen::Index n = 0; n < modes->functions.rows(); n += 7) {
      const double expected =
          std::cos(wave * part.positions[static_cast<std::size_t>(n)].x()) / std::sqrt(1.5);
      EXPECT_NEAR(std::abs(modes->functions(n, k)), std::abs(expected), 0.02);
    }
  }
}

TEST(Modes, AreOrthonormalPositiveAtTheirPeakAndAsManyAsThereCanBe) {
  for (const TetMesh& mesh :
       {families::box(3, 2, 2, Vec3(1.5, 1, 0.9)), families::box(9, 6, 5, Vec3(1.5, 1, 0.9))}) {
    const BodyPart part = partOf(mesh);
    const Laplacian laplacian = surfaceLaplacian(part.borderPositions, part.borderTriangles);
    const auto modes = lowestModes(laplacian, 20, {});
    ASSERT_TRUE(modes.ok());
    const Eigen::MatrixXd gram =
        modes->functions.transpose() * laplacian.mass.asDiagonal() * modes->functions;
    EXPECT_LT((gram - Eigen::MatrixXd::Identity(20, 20)).cwiseAbs().maxCoeff(), 1e-8);
    const Eigen::MatrixXd residual =
        laplacian.stiffness * modes->functions -
        laplacian.mass.asDiagonal() * modes->functions * modes->eigenvalues.asDiagonal();
    EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-6 * modes->eigenvalues.maxCoeff());
    for (Eigen::Index k = 0; k < 20; ++k)
      EXPECT_GE(modes->functions.col(k).maxCoeff(), -(1 - 1e-5) * modes->functions.col(k).minCoeff());
  }
  const BodyPart small = partOf(families::box(1, 1, 1, Vec3(1, 1, 1)));
  const auto all = lowestModes(solidLaplacian(small.positions, small.tets), 50, {});
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(all->eigenvalues.size(), 7);
}

TEST(Paths, StraightAlongEdgesAndNoneBetweenParts) {
  const TetMesh two = families::twoBoxes(2, 1, 0.5);
  const PathGraph graph(two.nodes, two.tets, two.neighbours);
  const std::vector<double> length = graph.lengthsFrom(0);
  for (std::size_t n = 0; n < two.nodes.size(); ++n) {
    const double straight = (two.nodes[n] - two.nodes[0]).norm();
    if (two.nodes[n].x() > 1.25) {
      EXPECT_TRUE(std::isinf(length[n]));
    } else {
      EXPECT_GE(length[n], straight * (1 - 1e-12));
      EXPECT_LE(length[n], 1.3 * straight);
    }
  }
}

TEST(BodyParts, AreNumberedByTheirLowestNodes) {
  const TetMesh boxes = families::twoBoxes(2, 1, 0.5);
  const std::vector<BodyPart> parts = bodyParts(boxes, {.places = boxes.nodes});
  ASSERT_EQ(parts.size(), 2u);
  for (const BodyPart& part : parts) {
    EXPECT_EQ(part.node.size(), 27u);
    EXPECT_EQ(part.tets.size(), 48u);
    EXPECT_EQ(part.borderTriangles.size(), 48u);
    EXPECT_EQ(part.shells, 1);
  }
  EXPECT_EQ(partOf(families::hollowBox(3, 1, 1.0)).shells, 2);
}

TEST(Convexity, HullVolumes) {
  EXPECT_NEAR(*convexHullVolume(families::box(2, 2, 2, Vec3(1, 2, 3)).nodes), 6, 1e-12);
  EXPECT_NEAR(*convexHullVolume(families::uShape(1, 1, 3, 1, 1).nodes), 9, 1e-12);
  const std::vector<Vec3> flat{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0.5, 0.2, 0)};
  EXPECT_EQ(*convexHullVolume(flat), 0);
  EXPECT_EQ(*convexHullVolume(std::vector<Vec3>(7, Vec3(1, 2, 3))), 0);
}

}  // namespace
}  // namespace sherd
