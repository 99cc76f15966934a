#include "surfaces.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "geometry/solid.h"
#include "geometry/surface_tree.h"

namespace sherd::test {
namespace {

/// An index on a closed row of n.
Index wrap(Index i, Index n) { return (i + n) % n; }

}  // namespace

TriMesh box(const Vec3& low, const Vec3& high, int cells) {
  TriMesh mesh;
  std::map<std::array<int, 3>, Index> numberOf;
  const auto vertex = [&](std::array<int, 3> c) {
    const auto [found, isNew] = numberOf.try_emplace(c, static_cast<Index>(mesh.positions.size()));
    if (isNew) {
      const Vec3 share = Vec3(c[0], c[1], c[2]) / cells;
      mesh.positions.push_back(low + share.cwiseProduct(high - low));
    }
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, cells})
      for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> c;
            c[axis] = side, c[(axis + 1) % 3] = i + di, c[(axis + 2) % 3] = j + dj;
            return vertex(c);
          };
          const Index a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side != 0)
            mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, b, c}, Triangle{a, c, d}});
          else
            mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, c, b}, Triangle{a, d, c}});
        }
  return mesh;
}

TriMesh sphere(const Vec3& centre, double radius, int rings) {
  TriMesh mesh = box(-Vec3::Ones(), Vec3::Ones(), rings / 2);
  for (Vec3& p : mesh.positions) p = centre + radius * p.normalized();
  return mesh;
}

TriMesh torus(double major, double minor, int around, int across) {
  TriMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = major + minor * std::cos(v);
      mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
    }
  const auto vertex = [&](Index i, Index j) { return wrap(i, around) * across + wrap(j, across); };
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j)
      mesh.triangles.insert(mesh.triangles.end(),
                            {Triangle{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)},
                             Triangle{vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)}});
  return mesh;
}

TriMesh slitBlock(double slit) {
  // A profile extruded along z: outline counter-clockwise in (x, y), ends triangulated as strips.
  const double w = 1, h = 1, floor = 0.25, a = (w - slit) / 2, b = (w + slit) / 2;
  const std::vector<Vec2> outline = {{0, 0}, {w, 0}, {w, h}, {b, h}, {b, floor}, {a, floor}, {a, h}, {0, h}};
  const std::vector<Triangle> end = {{0, 5, 7}, {5, 6, 7}, {0, 1, 5}, {1, 4, 5}, {1, 2, 4}, {2, 3, 4}};
  TriMesh mesh;
  const Index n = 8;
  for (const double z : {0.0, 0.5})
    for (const Vec2& p : outline) mesh.positions.emplace_back(p.x(), p.y(), z);
  for (const Triangle& t : end) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
  }
  return mesh;
}

TriMesh joined(const TriMesh& a, const TriMesh& b) {
  TriMesh mesh = a;
  const auto shift = static_cast<Index>(a.positions.size());
  mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return mesh;
}

TriMesh insideOut(TriMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriMesh mapped(TriMesh mesh, const std::function<Vec3(const Vec3&)>& map) {
  for (Vec3& p : mesh.positions) p = map(p);
  return mesh;
}

double volumeOf(const TriMesh& mesh) { return solidVolume(mesh.positions, mesh.triangles); }

std::shared_ptr<const TriMesh> shared(TriMesh mesh) {
  return std::make_shared<const TriMesh>(std::move(mesh));
}

namespace {

/// Surface points (vertices and centroids) that are not strictly inside the cage, or not in a tetrahedron
/// that holds their triangle.
std::string enclosureDefect(const TetMesh& cage) {
  const TriMesh& surface = *cage.surface;
  const SurfaceTree boundary(cage.nodes, cage.boundary);
  std::vector<std::vector<std::size_t>> holders(surface.triangles.size());
  for (std::size_t t = 0; t < cage.tets.size(); ++t)
    for (Index i = cage.heldBegin[t]; i < cage.heldBegin[t + 1]; ++i)
      holders[at(cage.held[at(i)])].push_back(t);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& v = surface.triangles[t];
    for (const Vec3& w :
         {Vec3(1, 0, 0), Vec3(0.5, 0.5, 0), Vec3(1 / 3.0, 1 / 3.0, 1 / 3.0), Vec3(0.1, 0.2, 0.7)}) {
      const Vec3 p = w[0] * surface.positions[at(v[0])] + w[1] * surface.positions[at(v[1])] +
                     w[2] * surface.positions[at(v[2])];
      if (!boundary.contains(p)) return fmt::format("triangle {} is not inside the cage", t);
      bool held = false;
      for (const std::size_t k : holders[t]) {
        bool inside = true;
        for (const auto& face : kTetraFace) {
          const auto node = [&](int c) { return cage.nodes[at(cage.tets[k][static_cast<std::size_t>(c)])]; };
          const Vec3 a = node(face[0]), normal = (node(face[1]) - a).cross(node(face[2]) - a);
          inside = inside && normal.dot(p - a) <= 1e-12 * normal.norm();
        }
        held = held || inside;
      }
      if (!held) return fmt::format("no tetrahedron around a point of triangle {} holds it", t);
    }
  }
  return {};
}

}  // namespace

std::string defectOf(const TetMesh& cage) {
  if (cage.tets.empty()) return "no tetrahedra";
  std::set<Index> used;
  double volume = 0, inside = 0;
  for (std::size_t t = 0; t < cage.tets.size(); ++t) {
    if (tetVolume(cage, t) <= 0) return fmt::format("tetrahedron {} is not positively oriented", t);
    volume += tetVolume(cage, t), inside += tetVolume(cage, t) * cage.insideFraction[t];
    used.insert(cage.tets[t].begin(), cage.tets[t].end());
    if (!(cage.insideFraction[t] >= 0 && cage.insideFraction[t] <= 1)) return "a fraction is not in [0, 1]";
  }
  if (used.size() != cage.nodes.size()) return "a node belongs to no tetrahedron";
  if (std::abs(solidVolume(cage.nodes, cage.boundary) - volume) > 1e-9 * volume)
    return "the boundary is not closed";
  if (std::abs(cage.quality.cageVolume - volume) > 1e-9 * volume) return "the cage's volume is wrong";
  const double expected = volumeOf(*cage.surface);
  if (std::abs(inside - expected) > 1e-9 * expected)
    return fmt::format("the fractions hold {} m³ of {} m³", inside, expected);
  return enclosureDefect(cage);
}

std::pair<int, int> cageTopology(const TetMesh& cage) {
  std::vector<bool> seen(cage.tets.size(), false);
  int components = 0;
  for (std::size_t t = 0; t < cage.tets.size(); ++t) {
    if (seen[t]) continue;
    ++components;
    std::vector<std::size_t> todo{t};
    while (!todo.empty()) {
      const std::size_t k = todo.back();
      todo.pop_back();
      if (seen[k]) continue;
      seen[k] = true;
      for (const Index n : cage.neighbours[k])
        if (n >= 0) todo.push_back(at(n));
    }
  }
  std::set<Index> vertices;
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& f : cage.boundary)
    for (std::size_t c = 0; c < 3; ++c) {
      vertices.insert(f[c]);
      edges.insert(std::minmax(f[c], f[(c + 1) % 3]));
    }
  return {components, static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) +
                          static_cast<int>(cage.boundary.size())};
}

bool holds(const TetMesh& cage, const Vec3& point) {
  return std::any_of(cage.tets.begin(), cage.tets.end(), [&](const Tetra& tet) {
    return std::all_of(std::begin(kTetraFace), std::end(kTetraFace), [&](const auto& face) {
      const auto node = [&](int c) { return cage.nodes[at(tet[static_cast<std::size_t>(c)])]; };
      const Vec3 a = node(face[0]);
      return (node(face[1]) - a).cross(node(face[2]) - a).dot(point - a) <= 0;
    });
  });
}

Result<TetMesh> cageOf(TriMesh mesh, int tets) {
  return tetrahedralize(shared(std::move(mesh)), {.tets = tets}, {});
}

void expectGood(const Result<TetMesh>& cage, int components, int euler) {
  ASSERT_TRUE(cage.ok()) << cage.error().text();
  EXPECT_EQ(defectOf(*cage), "");
  EXPECT_EQ(cageTopology(*cage), std::make_pair(components, euler));
  EXPECT_LT(cage->quality.volumeError, 1e-9);
  EXPECT_GT(cage->quality.minDihedral, 3);
  EXPECT_LT(cage->quality.maxDihedral, 175);
}

}  // namespace sherd::test
