// Bodies for the rigid tests, by their surface alone.
#pragma once

#include <functional>
#include <memory>

#include "geometry/solid.h"
#include "support/tet_families.h"
#include "types/fields.h"

namespace sherd::rigid_test {

/// A body with this surface and no tetrahedra: all that rigid motion looks at.
inline TetMesh bodyOf(std::vector<Vec3> positions, std::vector<Triangle> triangles) {
  auto surface = std::make_shared<TriMesh>();
  surface->positions = std::move(positions);
  surface->triangles = std::move(triangles);
  TetMesh mesh;
  mesh.surface = surface;
  return mesh;
}

/// A unit octahedron's faces split `levels` times and pushed onto the sphere of this radius.
inline TetMesh sphere(double radius, int levels) {
  std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Triangle> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                              {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middle;
    const auto between = [&](Index a, Index b) {
      const auto [found, isNew] = middle.try_emplace(std::minmax(a, b), static_cast<Index>(points.size()));
      if (isNew) points.push_back((points[at(a)] + points[at(b)]).normalized());
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      const Index ab = between(a, b), bc = between(b, c), ca = between(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  for (Vec3& p : points) p *= radius;
  return bodyOf(std::move(points), std::move(faces));
}

inline double massOf(const TetMesh& mesh, double density) {
  return density * solidVolume(mesh.surface->positions, mesh.surface->triangles);
}

inline Vec3 totalImpulse(const Impact& impact) {
  Vec3 sum = Vec3::Zero();
  for (const Contact& contact : impact.contacts) sum += contact.impulse;
  return sum;
}

}  // namespace sherd::rigid_test
