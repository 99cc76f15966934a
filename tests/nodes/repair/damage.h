// Surfaces with known faults, and what every repaired one must be.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/rng.h"
#include "geometry/inspect_surface.h"
#include "geometry/solid.h"
#include "geometry/weld.h"
#include "repair/repair.h"
#include "support/said.h"
#include "support/surface_families.h"

namespace sherd::test {

inline TriMesh cube(const Vec3& low = Vec3::Zero(), double size = 1, int n = 1) {
  return families::boxSurface(low, low + Vec3::Constant(size), n, n, n);
}

/// Joins vertices in one place, as LoadMesh does.
inline TriMesh welded(TriMesh mesh) {
  weld(mesh);
  return mesh;
}

inline double volumeOf(const TriMesh& mesh) { return solidVolume(mesh.positions, mesh.triangles); }

/// Gives every corner attributes that are linear in the position, so that what becomes of them is known.
inline void dress(TriMesh& mesh) {
  mesh.uvSets = {{"map", {}}, {"second", {}}};
  mesh.colorSets = {{"paint", {}}};
  mesh.materials = {"clay", "glaze"};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.materialOf.push_back(static_cast<Index>(t % 2));
    const Triangle& v = mesh.triangles[t];
    const Vec3 &a = mesh.positions[at(v[0])], &b = mesh.positions[at(v[1])], &c = mesh.positions[at(v[2])];
    for (const Index corner : v) {
      const Vec3& p = mesh.positions[at(corner)];
      mesh.normals.push_back((b - a).cross(c - a).normalized());
      mesh.uvSets[0].uv.emplace_back(p.x() + 2 * p.z(), p.y() - p.x());
      mesh.uvSets[1].uv.emplace_back(p.y(), p.z());
      mesh.colorSets[0].rgba.emplace_back(p.x(), p.y(), p.z(), 1);
    }
  }
}

/// The attributes of dress(), to rounding. For surfaces without new faces also their normals.
inline void expectDressed(const TriMesh& mesh, bool normalsToo = true) {
  ASSERT_EQ(mesh.uvSets.size(), 2u);
  ASSERT_EQ(mesh.uvSets[1].uv.size(), mesh.cornerCount());
  ASSERT_EQ(mesh.colorSets[0].rgba.size(), mesh.cornerCount());
  ASSERT_EQ(mesh.normals.size(), mesh.cornerCount());
  ASSERT_EQ(mesh.materialOf.size(), mesh.triangles.size());
  const double size = boxOf(mesh.positions).diagonal();
  for (std::size_t k = 0; k < mesh.cornerCount(); ++k) {
    const Triangle& v = mesh.triangles[k / 3];
    const Vec3& p = mesh.positions[at(v[k % 3])];
    EXPECT_LT((mesh.uvSets[0].uv[k] - Vec2(p.x() + 2 * p.z(), p.y() - p.x())).norm(), 1e-5 * size);
    EXPECT_LT((mesh.colorSets[0].rgba[k].head<3>() - p).norm(), 1e-5 * size);
    EXPECT_NEAR(mesh.normals[k].norm(), 1, 1e-9);
    const Vec3 &a = mesh.positions[at(v[0])], &b = mesh.positions[at(v[1])], &c = mesh.positions[at(v[2])];
    if (normalsToo) {
      EXPECT_GT(mesh.normals[k].dot((b - a).cross(c - a).normalized()), 0.99);
    }
  }
}

/// Repairs, and checks what holds of whatever comes out.
inline Repaired repaired(const TriMesh& mesh, const RepairParams& params = {}) {
  auto result = repair(mesh, params, {});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  if (!result.ok()) return {};
  const SurfaceReport report = inspectSurface(result->mesh);
  EXPECT_TRUE(report.sound()) << (report.sound() ? "" : refusal(report, "the result")->text());
  EXPECT_GT(volumeOf(result->mesh), 0);
  return std::move(*result);
}

using Corners = std::array<std::array<double, 3>, 3>;
/// The triangle by its corners' positions, beginning with the least.
inline Corners cornersOf(const TriMesh& mesh, std::size_t t) {
  Corners corners;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3& p = mesh.positions[at(mesh.triangles[t][c])];
    corners[c] = {p.x(), p.y(), p.z()};
  }
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}
inline std::multiset<Corners> triangleSet(const TriMesh& mesh) {
  std::multiset<Corners> set;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) set.insert(cornersOf(mesh, t));
  return set;
}
/// How many triangles of `a` are not in `b`, bit for bit.
inline std::size_t missing(const TriMesh& a, const TriMesh& b) {
  const auto left = triangleSet(a), right = triangleSet(b);
  std::vector<Corners> gone;
  std::set_difference(left.begin(), left.end(), right.begin(), right.end(), std::back_inserter(gone));
  return gone.size();
}

}  // namespace sherd::test
