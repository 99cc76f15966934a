// Boxes in cages that their faces cut.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "geometry/tet_share.h"
#include "support/tet_families.h"

namespace sherd::families {

/// The box from the origin to `size` (m) as the surface in these tetrahedra, each of which holds all of it.
inline TetMesh withBoxInside(TetMesh cage, const Vec3& size) {
  cage.surface = box(4, 2, 1, size).surface;
  std::vector<Index> all(cage.surface->triangles.size());
  std::iota(all.begin(), all.end(), 0);
  cage.held.clear();
  cage.heldBegin = {0};
  for (std::size_t t = 0; t < cage.tets.size(); ++t) {
    std::array<Vec3, 4> x;
    for (std::size_t c = 0; c < 4; ++c) x[c] = cage.nodes[at(cage.tets[t][c])];
    const bool lastInside = (x[3].array() > 0).all() && (x[3].array() < size.array()).all();
    const TetShare share(x, cage.surface->positions, cage.surface->triangles);
    cage.insideFraction[t] = std::clamp(share.volume(all, lastInside) / tetVolume(cage, t), 0.0, 1.0);
    cage.held.insert(cage.held.end(), all.begin(), all.end());
    cage.heldBegin.push_back(static_cast<Index>(cage.held.size()));
  }
  return cage;
}

/// A box in a cage of nx × ny × nz cells that reaches `margin` (m) beyond it.
inline TetMesh cagedBox(int nx, int ny, int nz, const Vec3& size, const Vec3& margin) {
  const TetMesh block = box(nx, ny, nz, size + 2 * margin);
  return withBoxInside(mapped(block, [&](const Vec3& p) { return Vec3(p - margin); }), size);
}

}  // namespace sherd::families
