#include "bench/scaled_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "base/rng.h"
#include "geometry/surface_links.h"
#include "support/tet_families.h"

namespace sherd::bench {
namespace {

/// The cubes of a grid that a box touches, with a margin for rounding.
struct CubeRange {
  int low[3], high[3];
};

CubeRange cubesTouched(const Box& box, const Vec3& corner, double edge, const std::array<int, 3>& n) {
  CubeRange range{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    auto cube = [&](double x) { return static_cast<int>(std::floor((x - corner[axis]) / edge)); };
    range.low[axis] = std::clamp(cube(box.low[axis] - 1e-9 * edge), 0, n[a] - 1);
    range.high[axis] = std::clamp(cube(box.high[axis] + 1e-9 * edge), 0, n[a] - 1);
  }
  return range;
}

/// Calls f(cube) for every cube that the triangle's box touches; cubes in the order that cubesOf makes them.
template <class F>
void forCubes(const TriMesh& surface, std::size_t t, const Vec3& corner, double edge,
              const std::array<int, 3>& n, F&& f) {
  Box box;
  for (const Index v : surface.triangles[t]) box.add(surface.positions[at(v)]);
  const CubeRange r = cubesTouched(box, corner, edge, n);
  for (int k = r.low[2]; k <= r.high[2]; ++k)
    for (int j = r.low[1]; j <= r.high[1]; ++j)
      for (int i = r.low[0]; i <= r.high[0]; ++i)
        f(static_cast<std::size_t>(i) +
          static_cast<std::size_t>(n[0]) *
              (static_cast<std::size_t>(j) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(k)));
}

/// The planes of a tetrahedron's faces: n · x > c beyond them, with a margin for rounding.
using Faces = std::array<Vec4, 4>;

Faces facesOf(const TetMesh& cage, std::size_t tet, double margin) {
  Faces faces;
  for (std::size_t f = 0; f < 4; ++f) {
    const auto corner = [&](std::size_t c) -> const Vec3& {
      return cage.nodes[at(cage.tets[tet][at(kTetraFace[f][c])])];
    };
    const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    faces[f] << normal, normal.dot(corner(0)) + margin;
  }
  return faces;
}

bool mayTouch(const TriMesh& surface, std::size_t triangle, const Faces& faces) {
  return std::ranges::none_of(faces, [&](const Vec4& face) {
    return std::ranges::all_of(surface.triangles[triangle], [&](Index v) {
      return face.head<3>().dot(surface.positions[at(v)]) > face[3];
    });
  });
}

/// Of the triangles that touch its cube a tetrahedron holds those that are not beyond one of its faces.
void hold(TetMesh& cage, const Vec3& corner, double edge, const std::array<int, 3>& n) {
  constexpr std::size_t kTets = 6;  // of a cube
  const TriMesh& surface = *cage.surface;
  std::vector<Faces> faces;
  for (std::size_t tet = 0; tet < cage.tets.size(); ++tet) faces.push_back(facesOf(cage, tet, 1e-9 * edge));
  std::vector<std::vector<Index>> ofTet(cage.tets.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    forCubes(surface, t, corner, edge, n, [&](std::size_t cube) {
      for (std::size_t tet = kTets * cube; tet < kTets * (cube + 1); ++tet)
        if (mayTouch(surface, t, faces[tet])) ofTet[tet].push_back(static_cast<Index>(t));
    });
  cage.held.clear();
  cage.heldBegin.assign(1, 0);
  for (const auto& held : ofTet) {
    cage.held.insert(cage.held.end(), held.begin(), held.end());
    cage.heldBegin.push_back(static_cast<Index>(cage.held.size()));
  }
}

}  // namespace

TriMesh roundedCube(const Vec3& centre, double radius, std::size_t triangles) {
  const int n = std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 12))));
  TriMesh mesh;
  // Per side a grid; sides share their borders through a map of grid points on the cube's edges.
  std::map<std::array<int, 3>, Index> border;
  auto vertex = [&](const std::array<int, 3>& g) {
    auto even = [&](int k) { return std::tan((2.0 * k / n - 1) * std::numbers::pi / 4); };  // equal angles
    const Vec3 p(even(g[0]), even(g[1]), even(g[2]));
    mesh.positions.push_back(centre + radius * p.normalized());
    return static_cast<Index>(mesh.positions.size()) - 1;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n}) {
      std::vector<Index> grid;
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          std::array<int, 3> g{};
          g[static_cast<std::size_t>(axis)] = side;
          g[static_cast<std::size_t>((axis + 1) % 3)] = i;
          g[static_cast<std::size_t>((axis + 2) % 3)] = j;
          if (i > 0 && i < n && j > 0 && j < n) {
            grid.push_back(vertex(g));
            continue;
          }
          const auto found = border.find(g);
          grid.push_back(found != border.end() ? found->second : border[g] = vertex(g));
        }
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const auto a = static_cast<std::size_t>(j * (n + 1) + i), up = a + static_cast<std::size_t>(n) + 1;
          Triangle s{grid[a], grid[a + 1], grid[up + 1]}, t{grid[a], grid[up + 1], grid[up]};
          if (side == 0) std::swap(s[1], s[2]), std::swap(t[1], t[2]);
          mesh.triangles.insert(mesh.triangles.end(), {s, t});
        }
    }
  return mesh;
}

std::shared_ptr<const TetMesh> blockAround(TriMesh surface, int n) {
  const Box bounds = boxOf(surface.positions);
  const Vec3 size = 1.1 * (bounds.high - bounds.low);
  const double edge = size.maxCoeff() / n;
  std::array<int, 3> count{};
  for (int axis = 0; axis < 3; ++axis)
    count[static_cast<std::size_t>(axis)] = static_cast<int>(std::ceil(size[axis] / edge - 1e-9));
  const Vec3 corner = bounds.centre() - 0.5 * edge * Vec3(count[0], count[1], count[2]);
  const auto cubes = families::cubesOf(count[0], count[1], count[2], [](int, int, int) { return true; });
  TetMesh cage = families::fromCubes(cubes, Vec3::Constant(edge));
  for (Vec3& p : cage.nodes) p += corner;
  cage.surface = std::make_shared<const TriMesh>(std::move(surface));
  hold(cage, corner, edge, count);
  linkSurface(cage, Exec{});  // as Tetrahedralize does, once for every body
  return std::make_shared<const TetMesh>(std::move(cage));
}

std::vector<Vec3> sitesInBall(const Vec3& centre, double radius, std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3> sites;
  while (sites.size() < count) {
    const Vec3 p(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
    if (p.norm() < 1) sites.push_back(centre + radius * p);
  }
  return sites;
}

}  // namespace sherd::bench
