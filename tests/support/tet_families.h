// Tetrahedral meshes with known answers: solids made of equal cubes, each cube split into six tetrahedra
// (Kuhn's triangulation, which matches across faces). The surface is the mesh's own boundary, so that every
// tetrahedron lies wholly inside, and all of the surface is held.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "types/tet_mesh.h"

namespace sherd::families {

using Cube = std::array<int, 3>;

/// Connects the tetrahedra and makes the boundary the surface; surface vertex k is the k-th node of
/// `boundary` in order of first use.
inline TetMesh withOwnSurface(std::vector<Vec3> nodes, std::vector<Tetra> tets) {
  TetMesh mesh;
  mesh.nodes = std::move(nodes);
  mesh.tets = std::move(tets);
  connectTets(mesh);

  auto surface = std::make_shared<TriMesh>();
  std::vector<Index> vertexOf(mesh.nodes.size(), -1);
  std::vector<std::vector<Index>> trianglesAt(mesh.nodes.size());
  for (const Triangle& face : mesh.boundary) {
    Triangle triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      Index& vertex = vertexOf[at(face[c])];
      if (vertex < 0) {
        vertex = static_cast<Index>(surface->positions.size());
        surface->positions.push_back(mesh.nodes[at(face[c])]);
      }
      triangle[c] = vertex;
      trianglesAt[at(face[c])].push_back(static_cast<Index>(surface->triangles.size()));
    }
    surface->triangles.push_back(triangle);
  }
  mesh.surface = surface;

  mesh.heldBegin.push_back(0);
  for (const Tetra& tet : mesh.tets) {
    std::map<Index, bool> touching;
    for (const Index n : tet)
      for (const Index triangle : trianglesAt[at(n)]) touching[triangle] = true;
    for (const auto& [triangle, unused] : touching) mesh.held.push_back(triangle);
    mesh.heldBegin.push_back(static_cast<Index>(mesh.held.size()));
  }

  mesh.insideFraction.assign(mesh.tets.size(), 1.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.quality.cageVolume += tetVolume(mesh, t);
  mesh.quality.surfaceVolume = mesh.quality.cageVolume;
  return mesh;
}

/// The union of cubes of edge `edge` (m) whose lowest corners are edge · (i, j, k). Cubes that touch share
/// nodes.
inline TetMesh fromCubes(const std::vector<Cube>& cubes, const Vec3& edge) {
  std::map<Cube, Index> indexOf;
  std::vector<Vec3> nodes;
  std::vector<Tetra> tets;
  auto nodeAt = [&](const Cube& corner) {
    const auto [found, isNew] = indexOf.try_emplace(corner, static_cast<Index>(nodes.size()));
    if (isNew) nodes.emplace_back(corner[0] * edge[0], corner[1] * edge[1], corner[2] * edge[2]);
    return found->second;
  };
  // A tetrahedron per order in which the three axes are walked from the lowest to the highest corner; odd
  // orders would come out inverted, so their last two corners change places.
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (const Cube& cube : cubes)
    for (int o = 0; o < 6; ++o) {
      Tetra tet{};
      Cube corner = cube;
      tet[0] = nodeAt(corner);
      for (std::size_t step = 0; step < 3; ++step) {
        ++corner[static_cast<std::size_t>(orders[o][step])];
        tet[step + 1] = nodeAt(corner);
      }
      if (o >= 3) std::swap(tet[2], tet[3]);
      tets.push_back(tet);
    }
  return withOwnSurface(std::move(nodes), std::move(tets));
}

/// The cubes of an nx × ny × nz block that `keep` wants.
inline std::vector<Cube> cubesOf(int nx, int ny, int nz, const std::function<bool(int, int, int)>& keep) {
  std::vector<Cube> cubes;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        if (keep(i, j, k)) cubes.push_back({i, j, k});
  return cubes;
}

/// A box from the origin to `size` (m), of nx × ny × nz cubes.
inline TetMesh box(int nx, int ny, int nz, const Vec3& size) {
  return fromCubes(cubesOf(nx, ny, nz, [](int, int, int) { return true; }),
                   Vec3(size[0] / nx, size[1] / ny, size[2] / nz));
}

/// A U in the x-y plane: two arms of `arm` × `height` cubes, `gap` cubes apart, on a bridge `arm` cubes high,
/// `depth` cubes deep along z. Cubes of edge `edge` (m); the outer corner is at the origin.
inline TetMesh uShape(int arm, int gap, int height, int depth, double edge) {
  auto solid = [=](int i, int j, int) { return j < arm || i < arm || i >= arm + gap; };
  return fromCubes(cubesOf(2 * arm + gap, height, depth, solid), Vec3::Constant(edge));
}

/// Two separate boxes of n³ cubes of edge `edge` (m), `gap` cubes apart along x.
inline TetMesh twoBoxes(int n, int gap, double edge) {
  return fromCubes(cubesOf(2 * n + gap, n, n, [=](int i, int, int) { return i < n || i >= n + gap; }),
                   Vec3::Constant(edge));
}

/// A box of n³ cubes with a void of (n − 2·wall)³ cubes: its boundary has two shells.
inline TetMesh hollowBox(int n, int wall, double edge) {
  auto inVoid = [=](int a) { return a >= wall && a < n - wall; };
  return fromCubes(
      cubesOf(n, n, n, [=](int i, int j, int k) { return !(inVoid(i) && inVoid(j) && inVoid(k)); }),
      Vec3::Constant(edge));
}

/// The mesh with every node and surface vertex mapped; `map` must keep orientation.
inline TetMesh mapped(const TetMesh& mesh, const std::function<Vec3(const Vec3&)>& map) {
  TetMesh out = mesh;
  for (Vec3& p : out.nodes) p = map(p);
  auto surface = std::make_shared<TriMesh>(*mesh.surface);
  for (Vec3& p : surface->positions) p = map(p);
  out.surface = surface;
  out.quality.cageVolume = 0;
  for (std::size_t t = 0; t < out.tets.size(); ++t) out.quality.cageVolume += tetVolume(out, t);
  out.quality.surfaceVolume = out.quality.cageVolume;
  return out;
}

inline std::shared_ptr<const TetMesh> shared(TetMesh mesh) {
  return std::make_shared<const TetMesh>(std::move(mesh));
}

}  // namespace sherd::families
