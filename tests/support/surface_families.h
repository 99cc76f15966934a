// Closed triangle surfaces with known answers, and block cages to put around them.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "support/tet_families.h"
#include "types/tet_mesh.h"
#include "types/tri_mesh.h"

namespace sherd::families {

/// A grid of quads, `u` × `v`, each split in two; closed in both directions where wrapped.
inline TriMesh torusSurface(double ringRadius, double tubeRadius, int u, int v) {
  TriMesh mesh;
  const double turn = 2 * std::numbers::pi;
  for (int i = 0; i < u; ++i)
    for (int j = 0; j < v; ++j) {
      const double a = turn * i / u, b = turn * j / v, r = ringRadius + tubeRadius * std::cos(b);
      mesh.positions.emplace_back(r * std::cos(a), tubeRadius * std::sin(b), -r * std::sin(a));
    }
  auto id = [&](int i, int j) { return static_cast<Index>((i % u) * v + j % v); };
  for (int i = 0; i < u; ++i)
    for (int j = 0; j < v; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return mesh;
}

/// A sphere about `centre` with poles on the y axis, `u` meridians and `v` bands.
inline TriMesh sphereSurface(const Vec3& centre, double radius, int u, int v) {
  TriMesh mesh;
  mesh.positions.push_back(centre + Vec3(0, radius, 0));
  for (int j = 1; j < v; ++j)
    for (int i = 0; i < u; ++i) {
      const double a = 2 * std::numbers::pi * i / u, b = std::numbers::pi * j / v;
      mesh.positions.push_back(
          centre + radius * Vec3(std::sin(b) * std::cos(a), std::cos(b), -std::sin(b) * std::sin(a)));
    }
  mesh.positions.push_back(centre - Vec3(0, radius, 0));
  const Index south = static_cast<Index>(mesh.positions.size()) - 1;
  auto id = [&](int j, int i) { return static_cast<Index>(1 + (j - 1) * u + i % u); };
  for (int i = 0; i < u; ++i) {
    mesh.triangles.push_back({0, id(1, i), id(1, i + 1)});
    mesh.triangles.push_back({south, id(v - 1, i + 1), id(v - 1, i)});
    for (int j = 1; j + 1 < v; ++j) {
      mesh.triangles.push_back({id(j, i), id(j + 1, i), id(j + 1, i + 1)});
      mesh.triangles.push_back({id(j, i), id(j + 1, i + 1), id(j, i + 1)});
    }
  }
  return mesh;
}

/// An axis-aligned box of nx × ny × nz quads a side, each split in two.
inline TriMesh boxSurface(const Vec3& low, const Vec3& high, int nx, int ny, int nz) {
  TetMesh solid = box(nx, ny, nz, high - low);
  TriMesh mesh = *solid.surface;
  for (Vec3& p : mesh.positions) p += low;
  return mesh;
}

inline TriMesh reversed(TriMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Both surfaces in one mesh.
inline TriMesh joined(TriMesh a, const TriMesh& b) {
  const Index shift = static_cast<Index>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

/// A block of n³ cubes around the surface, `margin` of its size larger on every side. `held` lists triangles
/// whose box comes within rounding of the tetrahedron's.
inline std::shared_ptr<const TetMesh> cagedInBlock(const TriMesh& surface, int n, double margin = 0.07) {
  const Box bounds = boxOf(surface.positions);
  const Vec3 border = Vec3::Constant(margin * bounds.diagonal());
  const Vec3 size = bounds.high - bounds.low + 2 * border;
  TetMesh cage = mapped(box(n, n, n, size), [&](const Vec3& p) { return Vec3(p + bounds.low - border); });
  cage.surface = std::make_shared<const TriMesh>(surface);
  cage.held.clear();
  cage.heldBegin.assign(1, 0);
  const Vec3 slack = Vec3::Constant(1e-10 * bounds.diagonal());
  for (const Tetra& tet : cage.tets) {
    Box box;
    for (const Index node : tet) box.add(cage.nodes[at(node)]);
    box.low -= slack;
    box.high += slack;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      Box other;
      for (const Index v : surface.triangles[t]) other.add(surface.positions[at(v)]);
      if (box.overlaps(other)) cage.held.push_back(static_cast<Index>(t));
    }
    cage.heldBegin.push_back(static_cast<Index>(cage.held.size()));
  }
  return shared(std::move(cage));
}

}  // namespace sherd::families
