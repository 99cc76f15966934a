// Concave solids with known answers.
#pragma once

#include <memory>
#include <vector>

#include "support/fragment_families.h"
#include "types/fragments.h"

namespace sherd::test {

/// A polygon of the xy plane (counter-clockwise), cut into triangles, from z = 0 to z = height.
inline TriMesh prism(const std::vector<Vec2>& polygon, const std::vector<Triangle>& cut, double height = 1) {
  TriMesh mesh;
  const Index n = static_cast<Index>(polygon.size());
  for (const double z : {0.0, height})
    for (const Vec2& p : polygon) mesh.positions.emplace_back(p.x(), p.y(), z);
  for (const Triangle& t : cut) {
    mesh.triangles.push_back({t[2], t[1], t[0]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
  }
  return mesh;
}

/// 2 × 2 without its upper right quarter; volume 3.
inline TriMesh angle() {
  return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
               {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

/// 3 × 2 with a slot from above; volume 5.
inline TriMesh channel() {
  return prism({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
               {{0, 1, 4}, {0, 4, 5}, {1, 2, 4}, {2, 3, 4}, {0, 5, 7}, {5, 6, 7}});
}

/// Fragments of one piece, the body itself.
inline Fragments whole(TriMesh mesh) { return slices(std::move(mesh), {}); }

}  // namespace sherd::test
