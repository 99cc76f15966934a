#include "geometry/tet_share.h"

#include <algorithm>
#include <cmath>

namespace sherd {

ShareProducts wholeProducts() { return (ShareProducts::Ones() + ShareProducts::Identity()) / 20; }

TetShare::TetShare(const std::array<Vec3, 4>& corners, std::span<const Vec3> positions,
                   std::span<const Triangle> triangles)
    : corner_(corners), positions_(positions), triangles_(triangles) {
  for (std::size_t f = 0; f < 4; ++f) {
    const Vec3& a = corner_[static_cast<std::size_t>(kTetraFace[f][0])];
    normal_[f] = (corner_[static_cast<std::size_t>(kTetraFace[f][1])] - a)
                     .cross(corner_[static_cast<std::size_t>(kTetraFace[f][2])] - a);
  }
}

/// Integrals over tetrahedra with a corner in p, each with the sign of its orientation.
class TetShare::Sum {
 public:
  explicit Sum(const std::array<Vec3, 4>& corner) : origin_(corner[0]) {
    Mat3 edges;
    for (std::size_t i = 0; i < 3; ++i) edges.col(static_cast<Eigen::Index>(i)) = corner[1 + i] - origin_;
    toLocal_ = edges.inverse();
  }
  void add(const Vec3& a, const Vec3& b, const Vec3& c, double sign = 1) {
    Mat3 local;
    local.col(0) = toLocal_ * (a - origin_);
    local.col(1) = toLocal_ * (b - origin_);
    local.col(2) = toLocal_ * (c - origin_);
    const double share = sign * local.col(0).dot(local.col(1).cross(local.col(2)));
    const Vec3 sum = local.col(0) + local.col(1) + local.col(2);
    share_ += share;
    first_ += share / 4 * sum;
    second_ += share / 20 * (local * local.transpose() + sum * sum.transpose());
  }
  ShareProducts products() const {
    ShareProducts p;
    p.bottomRightCorner<3, 3>() = second_;
    p.topRightCorner<1, 3>() = first_.transpose() - second_.colwise().sum();
    p.bottomLeftCorner<3, 1>() = p.topRightCorner<1, 3>().transpose();
    p(0, 0) = share_ - 2 * first_.sum() + second_.sum();
    return p;
  }

 private:
  Vec3 origin_;
  Mat3 toLocal_;  ///< the last three barycentric coordinates, of which the integrals are
  double share_ = 0;
  Vec3 first_ = Vec3::Zero();
  Mat3 second_ = Mat3::Zero();
};

double TetShare::volume(std::span<const Index> held, bool lastInside) const {
  const Vec3 &p = corner_[0], &q = corner_[1], &r = corner_[2], &s = corner_[3];
  const Vec3 normal = (r - q).cross(s - q), unit = normal.normalized();
  double flux = 0;
  for (const Index t : held) {
    const Polygon part = clipped(triangles_[at(t)]);
    double twice = 0;  // (x − p)·n is constant on a plane: half the triple product per fan triangle
    for (std::size_t i = 2; i < part.size(); ++i)
      twice += 0.5 * (part[0] - p).dot((part[i - 1] - p).cross(part[i] - p));
    flux += twice;
  }
  return (flux + unit.dot(q - p) * faceArea(held, unit, lastInside)) / 3;
}

ShareProducts TetShare::products(std::span<const Index> held, bool lastInside) const {
  const Vec3 &q = corner_[1], &r = corner_[2], &s = corner_[3];
  const Vec3 unit = (r - q).cross(s - q).normalized(), along = (s - r).normalized(),
             outward = along.cross(unit);
  Sum sum(corner_);
  for (const Index t : held) {
    const Polygon part = clipped(triangles_[at(t)]);
    for (std::size_t i = 2; i < part.size(); ++i) sum.add(part[0], part[i - 1], part[i]);
    const auto ends = segment(triangles_[at(t)], unit);
    if (!ends) continue;
    const auto& [from, to] = *ends;
    if (const auto clip = clipToFace(*ends, unit))
      sum.add(q, from + clip->begin * (to - from), from + clip->end * (to - from));
    if (const double place = crossing(*ends, along, outward); place != 0)
      sum.add(q, r, r + std::abs(place) * along, place > 0 ? 1 : -1);
  }
  return lastInside ? ShareProducts(sum.products() + wholeProducts()) : sum.products();
}

/// The part of a surface triangle in the tetrahedron.
Polygon TetShare::clipped(const Triangle& t) const {
  Polygon part;
  for (const Index v : t) part.push_back(positions_[at(v)]);
  for (std::size_t f = 0; f < 4; ++f) {
    const Vec3& a = corner_[static_cast<std::size_t>(kTetraFace[f][0])];
    const bool outside =
        std::any_of(part.begin(), part.end(), [&](const Vec3& x) { return normal_[f].dot(x - a) > 0; });
    if (outside) part = clipPolygon(part, a, normal_[f]);
  }
  return part;
}

/// Where the edge (a, b) of the surface meets the plane of the face. The same for both triangles at the edge.
Vec3 TetShare::onFace(Index a, Index b, const Vec3& unit) const {
  if (b < a) std::swap(a, b);
  const Vec3 &x = positions_[at(a)], &y = positions_[at(b)];
  const double hx = unit.dot(x - corner_[1]), hy = unit.dot(y - corner_[1]);
  return x + hx / (hx - hy) * (y - x);
}

/// The segment in which a triangle meets the face's plane, directed so that the solid is on its left as seen
/// from outside the tetrahedron (against `unit`).
std::optional<TetShare::Segment> TetShare::segment(const Triangle& t, const Vec3& unit) const {
  std::array<bool, 3> above;
  for (std::size_t c = 0; c < 3; ++c) above[c] = unit.dot(positions_[at(t[c])] - corner_[1]) > 0;
  Segment ends;
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
double TetShare::faceArea(std::span<const Index> held, const Vec3& unit, bool lastInside) const {
  const Vec3 &q = corner_[1], &r = corner_[2], &s = corner_[3];
  const Vec3 along = (s - r).normalized();
  const Vec3 outward = along.cross(unit);  // in the face's plane, away from q
  double twice = 0, length = lastInside ? (s - r).norm() : 0;
  for (const Index t : held) {
    const auto ends = segment(triangles_[at(t)], unit);
    if (!ends) continue;
    twice += segmentFlux(*ends, unit);
    length += crossing(*ends, along, outward);
  }
  return 0.5 * (twice + outward.dot(r - q) * length);
}

/// What of a segment lies in the face.
std::optional<TetShare::Clip> TetShare::clipToFace(const Segment& s, const Vec3& unit) const {
  const auto& [from, to] = s;
  Clip clip{0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = corner_[1 + i], &b = corner_[1 + (i + 1) % 3];
    const Vec3 out = (b - a).cross(unit);
    const double h0 = out.dot(from - a), h1 = out.dot(to - a);
    if (h0 > 0 && h1 > 0) return std::nullopt;
    if (h0 > 0)
      clip.begin = std::max(clip.begin, h0 / (h0 - h1));
    else if (h1 > 0)
      clip.end = std::min(clip.end, h0 / (h0 - h1));
  }
  if (clip.begin >= clip.end) return std::nullopt;
  return clip;
}

/// ∫ (x − q)·m ds over the part of a segment in the face, m on the segment's right.
double TetShare::segmentFlux(const Segment& s, const Vec3& unit) const {
  const auto clip = clipToFace(s, unit);
  if (!clip) return 0;
  const auto& [from, to] = s;
  return (clip->end - clip->begin) * (from - corner_[1]).dot((to - from).cross(unit));
}

/// The signed share of edge (r, s) that one segment's crossing of it stands for.
double TetShare::crossing(const Segment& segment, const Vec3& along, const Vec3& outward) const {
  const auto& [from, to] = segment;
  const Vec3 &r = corner_[2], &s = corner_[3];
  const double h0 = outward.dot(from - r), h1 = outward.dot(to - r);
  if ((h0 > 0) == (h1 > 0)) return 0;
  const double place = along.dot(from - r) + h0 / (h0 - h1) * along.dot(to - from);
  if (place <= 0 || place >= along.dot(s - r)) return 0;
  return h0 > 0 ? place : -place;
}

}  // namespace sherd
