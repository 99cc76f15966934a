// Small fractures made by hand: closed surfaces sliced by parallel planes, with all that Fragments promises.
#pragma once

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "geometry/solid.h"
#include "types/fields.h"
#include "types/fragments.h"

namespace sherd::test {

/// A box with flat normals, one UV square and one of two materials per side.
inline TriMesh boxMesh(const Vec3& low, const Vec3& high) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                i & 4 ? high.z() : low.z());
  const Index sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  const Vec2 corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.materials = {"paint", "base"};
  mesh.uvSets.resize(1);
  mesh.uvSets[0].name = "map1";
  for (int side = 0; side < 6; ++side)
    for (const auto& half : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
      const auto* q = sides[side];
      mesh.triangles.push_back({q[half[0]], q[half[1]], q[half[2]]});
      mesh.materialOf.push_back(side == 2 ? 1 : 0);
      Vec3 normal = Vec3::Zero();
      normal[side / 2] = side % 2 ? 1 : -1;
      for (const int corner : half) {
        mesh.normals.push_back(normal);
        mesh.uvSets[0].uv.push_back(corners[corner]);
      }
    }
  return mesh;
}

/// Slices of a closed mesh between planes x = cuts[k] (ascending, none through a vertex). Each section has to
/// be made of loops that are star-shaped about each of their vertices.
class Slicer {
 public:
  Slicer(std::shared_ptr<const TriMesh> mesh, std::vector<double> cuts)
      : mesh_(std::move(mesh)), cuts_(std::move(cuts)) {
    auto tets = std::make_shared<TetMesh>();
    tets->surface = mesh_;
    f_.tets = tets;
    f_.positions = mesh_->positions;
    f_.pieces.resize(cuts_.size() + 1);
    f_.sites = f_.pieces.size();
    next_.resize(cuts_.size());
  }

  Fragments run() {
    for (std::size_t t = 0; t < mesh_->triangles.size(); ++t) sliceTriangle(static_cast<Index>(t));
    for (std::size_t k = 0; k < cuts_.size(); ++k) cap(static_cast<Index>(k));
    for (std::size_t p = 0; p < f_.pieces.size(); ++p) finish(p);
    return std::move(f_);
  }

 private:
  struct Corner {
    Index vertex;
    CornerWeights weights;
    Index plane;  ///< that it lies on, −1 for a corner of the source
  };

  Index slab(Index v) const {
    const double x = f_.positions[at(v)].x();
    return static_cast<Index>(std::count_if(cuts_.begin(), cuts_.end(), [&](double cut) { return cut < x; }));
  }

  Corner cross(const Triangle& t, int i, int j, Index plane) {
    const Index a = std::min(t[at(i)], t[at(j)]), b = std::max(t[at(i)], t[at(j)]);
    const Vec3 pa = f_.positions[at(a)], pb = f_.positions[at(b)];
    const double share = (cuts_[at(plane)] - pa.x()) / (pb.x() - pa.x());  // of b
    const auto [found, isNew] = made_.try_emplace({{a, b}, plane}, static_cast<Index>(f_.positions.size()));
    if (isNew) {
      Vec3 p = pa + share * (pb - pa);
      p.x() = cuts_[at(plane)];
      f_.positions.push_back(p);
    }
    CornerWeights w = CornerWeights::Zero();
    w[t[at(i)] == b ? i : j] = share;
    w[t[at(i)] == a ? i : j] = 1 - share;
    return {found->second, w, plane};
  }

  void sliceTriangle(Index source) {
    const Triangle& t = mesh_->triangles[at(source)];
    const Index slabs[3] = {slab(t[0]), slab(t[1]), slab(t[2])};
    const auto [low, high] = std::minmax({slabs[0], slabs[1], slabs[2]});
    if (low == high) {
      add(f_.pieces[at(low)], t, source, -1);
      return;
    }
    std::vector<Corner> ring;  // corners and crossings, in order around the triangle
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      ring.push_back({t[at(i)], CornerWeights::Unit(i), -1});
      if (slabs[i] < slabs[j])
        for (Index k = slabs[i]; k < slabs[j]; ++k) ring.push_back(cross(t, i, j, k));
      else
        for (Index k = slabs[i] - 1; k >= slabs[j]; --k) ring.push_back(cross(t, i, j, k));
    }
    for (Index s = low; s <= high; ++s) sliceOf(ring, s, source);
  }

  void sliceOf(const std::vector<Corner>& ring, Index s, Index source) {
    std::vector<Corner> polygon;
    for (const Corner& c : ring)
      if (c.plane >= 0 ? c.plane == s || c.plane == s - 1 : slab(c.vertex) == s) polygon.push_back(c);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if (a.plane == s && b.plane == s) next_[at(s)][b.vertex] = a.vertex;
      if (i == 0 || i + 1 == polygon.size()) continue;
      f_.cutCorners.push_back({polygon[0].weights, a.weights, b.weights});
      add(f_.pieces[at(s)], {polygon[0].vertex, a.vertex, b.vertex}, source,
          static_cast<Index>(f_.cutCorners.size() - 1));
    }
  }

  static void add(Piece& piece, const Triangle& t, Index source, Index cut) {
    piece.surface.push_back(t);
    piece.surfaceSource.push_back(source);
    piece.surfaceCut.push_back(cut);
  }

  /// Closes both sides of plane k with fans over the loops of its section.
  void cap(Index k) {
    auto& next = next_[at(k)];
    Piece &below = f_.pieces[at(k)], &above = f_.pieces[at(k + 1)];
    while (!next.empty()) {
      std::vector<Index> loop;
      for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
        if (loop.empty()) loop.push_back(at->first);
        const Index following = at->second;
        next.erase(at);
        if (following == loop.front()) break;
        loop.push_back(following);
      }
      std::rotate(loop.begin(), loop.begin() + bestStart(loop), loop.end());
      for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        below.crack.push_back({loop[0], loop[i], loop[i + 1]});
        below.crackNeighbour.push_back(k + 1);
        below.crackSheet.push_back(k);
        above.crack.push_back({loop[0], loop[i + 1], loop[i]});
        above.crackNeighbour.push_back(k);
        above.crackSheet.push_back(k);
      }
    }
  }

  /// Where a fan has to begin for its smallest triangle to be as large as can be (loops have straight
  /// corners).
  std::ptrdiff_t bestStart(const std::vector<Index>& loop) const {
    const auto corner = [&](std::size_t i) -> const Vec3& { return f_.positions[at(loop[i % loop.size()])]; };
    std::ptrdiff_t best = 0;
    double bestArea = -1;
    for (std::size_t start = 0; start < loop.size() && loop.size() < 100; ++start) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = start + 1; i + 1 < start + loop.size(); ++i)
        least = std::min(least, (corner(i) - corner(start)).cross(corner(i + 1) - corner(start)).norm());
      if (least > bestArea) {
        bestArea = least;
        best = static_cast<std::ptrdiff_t>(start);
      }
    }
    return best;
  }

  void finish(std::size_t p) {
    Piece& piece = f_.pieces[p];
    char name[32];
    std::snprintf(name, sizeof name, "piece_%04zu", p + 1);
    piece.name = name;
    piece.cell = static_cast<Index>(p);
    const std::span<const Triangle> lists[] = {piece.surface, piece.crack};
    const SolidIntegrals solid = integrateSolid(f_.positions, lists);
    piece.volume = solid.volume;
    piece.centreOfMass = solid.centroid;
    piece.inertia = solid.inertia(f_.material.density);
  }

  std::shared_ptr<const TriMesh> mesh_;
  std::vector<double> cuts_;
  Fragments f_;
  std::map<std::pair<std::pair<Index, Index>, Index>, Index> made_;  ///< edge and plane to vertex
  std::vector<std::map<Index, Index>> next_;  ///< per plane: the lower cap's boundary edges
};

inline Fragments slices(TriMesh mesh, std::vector<double> cuts) {
  return Slicer(std::make_shared<const TriMesh>(std::move(mesh)), std::move(cuts)).run();
}

/// A box of `count` metres by one by one in `count` slices of about one metre.
inline Fragments slicedBox(std::size_t count) {
  std::vector<double> cuts;
  for (std::size_t k = 1; k < count; ++k) cuts.push_back(static_cast<double>(k) + 0.1);
  return slices(boxMesh(Vec3::Zero(), Vec3(static_cast<double>(count), 1, 1)), cuts);
}

/// The box around a surface, a tenth larger, as n³ cubes of six tetrahedra each.
inline std::shared_ptr<TetMesh> gridCage(std::shared_ptr<const TriMesh> surface, Index n) {
  auto cage = std::make_shared<TetMesh>();
  Box box = boxOf(surface->positions);
  const Vec3 margin = 0.05 * (box.high - box.low), low = box.low - margin,
             size = box.high - box.low + 2 * margin;
  const auto node = [&](Index x, Index y, Index z) { return (z * (n + 1) + y) * (n + 1) + x; };
  for (Index z = 0; z <= n; ++z)
    for (Index y = 0; y <= n; ++y)
      for (Index x = 0; x <= n; ++x) cage->nodes.push_back(low + size.cwiseProduct(Vec3(x, y, z) / n));
  const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (Index cell = 0; cell < n * n * n; ++cell)
    for (int o = 0; o < 6; ++o) {
      Index c[3] = {cell % n, cell / n % n, cell / n / n};
      Tetra tet{node(c[0], c[1], c[2]), 0, 0, 0};
      for (std::size_t step = 0; step < 3; ++step) {
        ++c[orders[o][step]];
        tet[step + 1] = node(c[0], c[1], c[2]);
      }
      if (o >= 3) std::swap(tet[1], tet[2]);  // odd permutations are mirrored
      cage->tets.push_back(tet);
    }
  cage->insideFraction.assign(cage->tets.size(), 1);
  cage->heldBegin.push_back(0);
  for (const Tetra& tet : cage->tets) {
    Box around;
    for (const Index v : tet) around.add(cage->nodes[at(v)]);
    for (std::size_t t = 0; t < surface->triangles.size(); ++t) {
      Box triangle;
      for (const Index v : surface->triangles[t]) triangle.add(surface->positions[at(v)]);
      if (around.overlaps(triangle)) cage->held.push_back(static_cast<Index>(t));
    }
    cage->heldBegin.push_back(static_cast<Index>(cage->held.size()));
  }
  connectTets(*cage);
  cage->surface = std::move(surface);
  return cage;
}

}  // namespace sherd::test
