#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "simulate/patch_load.h"
#include "support/tet_families.h"

using namespace sherd;
using namespace sherd::families;

namespace {

std::shared_ptr<const Elements> linear(std::shared_ptr<const TetMesh> mesh) {
  return std::make_shared<const Elements>(std::move(mesh), ElementOrder::Linear);
}

struct Net {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  // about `point`
};

Net netOf(const TetMesh& mesh, const std::vector<Vec3>& nodal, const Vec3& point) {
  Net net;
  for (std::size_t n = 0; n < nodal.size(); ++n) {
    net.force += nodal[n];
    net.moment += (mesh.nodes[n] - point).cross(nodal[n]);
  }
  return net;
}

std::vector<Vec3> loaded(const std::shared_ptr<const TetMesh>& mesh, const Vec3& point, const Vec3& force,
                         double radius) {
  std::vector<Vec3> nodal(mesh->nodes.size(), Vec3::Zero());
  const Result<void> done = PatchLoader(linear(mesh)).add(point, force, radius, nodal);
  EXPECT_TRUE(done.ok()) << (done.ok() ? "" : done.error().text());
  return nodal;
}

TEST(PatchLoad, ForceAndMomentAreExact) {
  const auto mesh = shared(box(4, 3, 5, Vec3(0.4, 0.3, 0.5)));
  Rng rng(3);
  // On a face, an edge and a corner; straight, slanted and pulling.
  for (const Vec3& point : {Vec3(0.21, 0, 0.13), Vec3(0.4, 0, 0.3), Vec3(0, 0.3, 0.5)})
    for (const double radius : {1e-4, 0.02, 0.15})
      for (int k = 0; k < 4; ++k) {
        const Vec3 force(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
        const Net net = netOf(*mesh, loaded(mesh, point, force, radius), point);
        EXPECT_LT((net.force - force).norm(), 1e-12 * force.norm());
        EXPECT_LT(net.moment.norm(), 1e-9 * radius * force.norm() + 1e-14 * force.norm());
      }
}

TEST(PatchLoad, QuadraticElementsTakeTheSameForceAndMoment) {
  const auto mesh = shared(box(4, 3, 5, Vec3(0.4, 0.3, 0.5)));
  const auto elements = std::make_shared<const Elements>(mesh, ElementOrder::Quadratic);
  const Vec3 point(0.21, 0, 0.13), force(0.3, 1, -0.2);
  std::vector<Vec3> nodal(elements->nodeCount(), Vec3::Zero());
  ASSERT_TRUE(PatchLoader(elements).add(point, force, 0.08, nodal).ok());
  const std::vector<Vec3> x = elements->positions(mesh->nodes);
  Vec3 net = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t n = 0; n < nodal.size(); ++n) {
    net += nodal[n];
    moment += (x[n] - point).cross(nodal[n]);
  }
  EXPECT_LT((net - force).norm(), 1e-12);
  EXPECT_LT(moment.norm(), 1e-11);
}

/// Hertz's pressure has a mean square distance of 2/5 a²; quadratic elements hand on squares exactly.
TEST(PatchLoad, PressureConvergesToHertzs) {
  const auto mesh = shared(box(10, 2, 10, Vec3(1, 0.2, 1)));
  const auto elements = std::make_shared<const Elements>(mesh, ElementOrder::Quadratic);
  const std::vector<Vec3> x = elements->positions(mesh->nodes);
  const Vec3 point(0.52, 0, 0.47), force(0, 100, 0);
  const double radius = 0.25;
  double last = 1;
  std::size_t points = 0;
  for (const double piece : {1.0, kPatchPiece, kPatchPiece / 4}) {
    const PatchLoader loader(elements, piece);
    std::vector<Vec3> nodal(elements->nodeCount(), Vec3::Zero());
    ASSERT_TRUE(loader.add(point, force, radius, nodal).ok());
    double square = 0;
    for (std::size_t n = 0; n < nodal.size(); ++n)
      square += nodal[n].y() / 100 * (x[n] - point).squaredNorm();
    const double error = std::abs(square / (0.4 * radius * radius) - 1);
    EXPECT_LT(error, last);
    last = error;
    EXPECT_GT(loader.pointCount(point, force, radius), 3 * points);
    points = loader.pointCount(point, force, radius);
  }
  EXPECT_LT(last, 2e-3);
}

TEST(PatchLoad, ReachesAsFarAsTheRadius) {
  const auto mesh = shared(box(10, 2, 10, Vec3(1, 0.2, 1)));
  const std::vector<Vec3> nodal = loaded(mesh, Vec3(0.5, 0, 0.5), Vec3(0, 100, 0), 0.25);
  for (std::size_t n = 0; n < nodal.size(); ++n) {
    const double distance = (mesh->nodes[n] - Vec3(0.5, 0, 0.5)).norm();
    if (distance > 0.25 + 0.1 * std::sqrt(3)) {
      EXPECT_TRUE(nodal[n].isZero(0));
    }
    if (mesh->nodes[n].y() == 0 && distance < 0.2) {
      EXPECT_GT(nodal[n].y(), 0);
    }
  }
}

TEST(PatchLoad, TheFarSideOfAThinWallIsNotLoaded) {
  const auto mesh = shared(box(10, 10, 1, Vec3(1, 1, 0.05)));
  const std::vector<Vec3> nodal = loaded(mesh, Vec3(0.5, 0.5, 0), Vec3(0, 0, 100), 0.2);
  for (std::size_t n = 0; n < nodal.size(); ++n)
    if (mesh->nodes[n].z() > 0) {
      EXPECT_LT(nodal[n].norm(), 1e-12);
    }
  // Neither is the other arm of a U.
  const auto u = shared(uShape(1, 1, 4, 1, 0.1));
  const std::vector<Vec3> onArm = loaded(u, Vec3(0.1, 0.35, 0.05), Vec3(-100, 0, 0), 0.14);
  for (std::size_t n = 0; n < onArm.size(); ++n)
    if (u->nodes[n].x() > 0.15) {
      EXPECT_LT(onArm[n].norm(), 1e-12);
    }
}

TEST(PatchLoad, SurfaceOutsideOfTheTetrahedraIsNamed) {
  TetMesh mesh = box(2, 2, 2, Vec3(1, 1, 1));
  auto surface = std::make_shared<TriMesh>(*mesh.surface);
  for (Vec3& p : surface->positions) p *= 1.5;
  mesh.surface = surface;
  std::vector<Vec3> nodal(mesh.nodes.size(), Vec3::Zero());
  const Result<void> done =
      PatchLoader(linear(shared(mesh))).add(Vec3(1.5, 1.5, 1.5), Vec3(-1, -1, -1), 0.1, nodal);
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().text().find("must enclose the surface"), std::string::npos);
}

}  // namespace
