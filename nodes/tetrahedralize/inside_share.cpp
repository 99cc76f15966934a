#include "tetrahedralize/inside_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parallel.h"
#include "geometry/solid.h"
#include "geometry/surface_tree.h"
#include "tetrahedralize/clipping.h"

namespace sherd {
namespace {

/// The surface as one tetrahedron sees it. Corners: p, then the face opposite p as q, r, s.
class TetShare {
 public:
  TetShare(const std::array<Vec3, 4>& corners, std::span<const Vec3> positions,
           std::span<const Triangle> triangles)
      : corner_(corners), positions_(positions), triangles_(triangles) {}

  /// Volume of the part inside. `lastInside`: is corner s inside the solid?
  double volume(std::span<const Index> held, bool lastInside) const {
    const Vec3 &p = corner_[0], &q = corner_[1], &r = corner_[2], &s = corner_[3];
    const Vec3 normal = (r - q).cross(s - q), unit = normal.normalized();
    double flux = 0;
    for (const Index t : held) flux += triangleFlux(triangles_[at(t)]);
    return (flux + unit.dot(q - p) * faceArea(held, unit, lastInside)) / 3;
  }

 private:
  /// ∫ (x − p)·n dA over the part of a surface triangle in the tetrahedron.
  double triangleFlux(const Triangle& t) const {
    Polygon part;
    for (const Index v : t) part.push_back(positions_[at(v)]);
    for (const auto& face : kTetraFace) {
      const Vec3& a = corner_[static_cast<std::size_t>(face[0])];
      part = clipPolygon(part, a,
                         (corner_[static_cast<std::size_t>(face[1])] - a)
                             .cross(corner_[static_cast<std::size_t>(face[2])] - a));
    }
    double flux = 0;  // (x − p)·n is constant on a plane: half the triple product per fan triangle
    for (std::size_t i = 2; i < part.size(); ++i)
      flux += 0.5 * (part[0] - corner_[0]).dot((part[i - 1] - corner_[0]).cross(part[i] - corner_[0]));
    return flux;
  }

  /// Where the edge (a, b) of the surface meets the plane of the face. The same for both triangles at the
  /// edge.
  Vec3 onFace(Index a, Index b, const Vec3& unit) const {
    if (b < a) std::swap(a, b);
    const Vec3 &x = positions_[at(a)], &y = positions_[at(b)];
    const double hx = unit.dot(x - corner_[1]), hy = unit.dot(y - corner_[1]);
    return x + hx / (hx - hy) * (y - x);
  }

  /// The segment in which a triangle meets the face's plane, directed so that the solid is on its left as
  /// seen from outside the tetrahedron (against `unit`).
  std::optional<std::array<Vec3, 2>> segment(const Triangle& t, const Vec3& unit) const {
    std::array<bool, 3> above;
    for (std::size_t c = 0; c < 3; ++c) above[c] = unit.dot(positions_[at(t[c])] - corner_[1]) > 0;
    std::array<Vec3, 2> ends;
    int found = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3;
      if (above[c] == above[d]) continue;
      ends[above[c] ? 0 : 1] = onFace(t[c], t[d], unit);
      ++found;
    }
    if (found != 2) return std::nullopt;
    return ends;
  }

  /// Area of the part of the face (q, r, s) inside the solid.
  double faceArea(std::span<const Index> held, const Vec3& unit, bool lastInside) const {
    const Vec3 &q = corner_[1], &r = corner_[2], &s = corner_[3];
    const Vec3 along = (s - r).normalized();
    const Vec3 outward = along.cross(unit);  // in the face's plane, away from q
    double twice = 0, length = lastInside ? (s - r).norm() : 0;
    for (const Index t : held) {
      const auto ends = segment(triangles_[at(t)], unit);
      if (!ends) continue;
      twice += segmentFlux((*ends)[0], (*ends)[1], unit);
      length += crossing((*ends)[0], (*ends)[1], along, outward);
    }
    return 0.5 * (twice + outward.dot(r - q) * length);
  }

  /// ∫ (x − q)·m ds over the part of a segment in the face, m on the segment's right.
  double segmentFlux(const Vec3& from, const Vec3& to, const Vec3& unit) const {
    double begin = 0, end = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = corner_[1 + i], &b = corner_[1 + (i + 1) % 3];
      const Vec3 out = (b - a).cross(unit);
      const double h0 = out.dot(from - a), h1 = out.dot(to - a);
      if (h0 > 0 && h1 > 0) return 0;
      if (h0 > 0)
        begin = std::max(begin, h0 / (h0 - h1));
      else if (h1 > 0)
        end = std::min(end, h0 / (h0 - h1));
    }
    if (begin >= end) return 0;
    return (end - begin) * (from - corner_[1]).dot((to - from).cross(unit));
  }

  /// The signed share of edge (r, s) that one segment's crossing of it stands for.
  double crossing(const Vec3& from, const Vec3& to, const Vec3& along, const Vec3& outward) const {
    const Vec3 &r = corner_[2], &s = corner_[3];
    const double h0 = outward.dot(from - r), h1 = outward.dot(to - r);
    if ((h0 > 0) == (h1 > 0)) return 0;
    const double place = along.dot(from - r) + h0 / (h0 - h1) * along.dot(to - from);
    if (place <= 0 || place >= along.dot(s - r)) return 0;
    return h0 > 0 ? place : -place;
  }

  std::array<Vec3, 4> corner_;
  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
};

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
