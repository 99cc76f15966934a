#include "tetrahedralize/inside_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "geometry/solid.h"
#include "geometry/surface_tree.h"
#include "geometry/tet_share.h"

namespace sherd {
namespace {

std::array<Vec3, 4> cornersOf(const TetMesh& cage, std::size_t t) {
  std::array<Vec3, 4> corners;
  for (std::size_t c = 0; c < 4; ++c) corners[c] = cage.nodes[at(cage.tets[t][c])];
  return corners;
}

void addDihedralAngles(const std::array<Vec3, 4>& x, TetQuality& quality) {
  std::array<Vec3, 4> normal;
  for (std::size_t f = 0; f < 4; ++f) {
    const Vec3& a = x[static_cast<std::size_t>(kTetraFace[f][0])];
    normal[f] = (x[static_cast<std::size_t>(kTetraFace[f][1])] - a)
                    .cross(x[static_cast<std::size_t>(kTetraFace[f][2])] - a)
                    .normalized();
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double angle =
          std::acos(std::clamp(-normal[i].dot(normal[j]), -1.0, 1.0)) * 180 / std::numbers::pi;
      quality.minDihedral = std::min(quality.minDihedral, angle);
      quality.maxDihedral = std::max(quality.maxDihedral, angle);
    }
}

}  // namespace

void fillInsideFractions(TetMesh& cage, std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         const Exec& exec) {
  const SurfaceTree tree(positions, triangles);
  std::vector<char> nodeInside(cage.nodes.size(), 0);
  parallelFor(exec, cage.nodes.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) nodeInside[n] = tree.contains(cage.nodes[n]) ? 1 : 0;
  });
  cage.insideFraction.assign(cage.tets.size(), 0.0);
  parallelFor(exec, cage.tets.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::size_t first = at(cage.heldBegin[t]), last = at(cage.heldBegin[t + 1]);
      const bool inside = nodeInside[at(cage.tets[t][3])] != 0;
      if (first == last) {
        cage.insideFraction[t] = inside ? 1 : 0;
        continue;
      }
      const TetShare share(cornersOf(cage, t), positions, triangles);
      const double volume = share.volume(std::span(cage.held).subspan(first, last - first), inside);
      cage.insideFraction[t] = std::clamp(volume / tetVolume(cage, t), 0.0, 1.0);
    }
  });
}

TetQuality measureQuality(const TetMesh& cage, std::span<const Vec3> positions,
                          std::span<const Triangle> triangles) {
  TetQuality quality;
  quality.minDihedral = 180;
  double inside = 0;
  for (std::size_t t = 0; t < cage.tets.size(); ++t) {
    const double volume = tetVolume(cage, t);
    quality.cageVolume += volume;
    inside += cage.insideFraction[t] * volume;
    addDihedralAngles(cornersOf(cage, t), quality);
  }
  quality.surfaceVolume = solidVolume(positions, triangles);
  quality.volumeError = std::abs(inside - quality.surfaceVolume) / quality.surfaceVolume;
  return quality;
}

}  // namespace sherd
