#include "convex_proxies/clipped.h"

#include <algorithm>
#include <array>

namespace sherd {
namespace {

using Segment = std::array<Vec3, 2>;

/// The kept part of one polygon goes to `out`; where it ends on the plane, the way back goes to `section`.
class PolygonCutter {
 public:
  PolygonCutter(const CutPlane& plane, PolygonList& out, std::vector<Segment>& section)
      : plane_(plane), out_(out), section_(section) {}

  void cut(std::span<const Vec3> polygon) {
    heights_.clear();
    bool below = false;
    for (const Vec3& p : polygon) {
      const double h = heights_.emplace_back(plane_.height(p));
      below = below || h < 0;
    }
    if (!below) return;  // beyond, or in the plane, where the section takes its place
    corners_.clear();
    onPlane_.clear();
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const double hp = heights_[i], hq = heights_[j];
      if (hp <= 0) push(polygon[i], hp == 0);
      if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) push(crossing(polygon[i], polygon[j], hp, hq), true);
    }
    finish();
  }

 private:
  void push(const Vec3& p, bool onPlane) {
    corners_.push_back(p);
    onPlane_.push_back(onPlane);
  }
  /// From the end below: polygons that share an edge get the same point.
  static Vec3 crossing(const Vec3& p, const Vec3& q, double hp, double hq) {
    return hp < 0 ? Vec3(p + hp / (hp - hq) * (q - p)) : Vec3(q + hq / (hq - hp) * (p - q));
  }
  void finish() {
    const std::size_t n = corners_.size();
    if (n < 3) return;
    for (std::size_t i = 0; i < n; ++i)
      if (const std::size_t j = (i + 1) % n; onPlane_[i] && onPlane_[j])
        section_.push_back({corners_[j], corners_[i]});
    out_.corners.insert(out_.corners.end(), corners_.begin(), corners_.end());
    out_.ends.push_back(out_.corners.size());
  }

  const CutPlane& plane_;
  PolygonList& out_;
  std::vector<Segment>& section_;
  std::vector<double> heights_;
  std::vector<Vec3> corners_;
  std::vector<bool> onPlane_;
};

double sixVolumes(const PolygonList& list, const Vec3& o) {
  double sum = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto p = list.polygon(i);
    for (std::size_t c = 2; c < p.size(); ++c) sum += (p[0] - o).cross(p[c - 1] - o).dot(p[c] - o);
  }
  return sum;
}

}  // namespace

ClippedSolid::ClippedSolid(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  Box box;
  for (const Triangle& t : triangles) {
    for (const Index v : t) {
      skin_.corners.push_back(positions[at(v)]);
      box.add(positions[at(v)]);
    }
    skin_.ends.push_back(skin_.corners.size());
  }
  if (!triangles.empty()) reference_ = box.centre();
}

ClippedSolid ClippedSolid::clipped(const CutPlane& plane) const {
  ClippedSolid part;
  part.reference_ = reference_;
  part.planes_ = planes_;
  part.planes_.push_back(plane);
  std::vector<Segment> section;
  PolygonCutter skin(plane, part.skin_, section);
  for (std::size_t i = 0; i < skin_.size(); ++i) skin.cut(skin_.polygon(i));
  PolygonCutter caps(plane, part.caps_, section);
  for (std::size_t i = 0; i < caps_.size(); ++i) caps.cut(caps_.polygon(i));
  for (std::size_t s = 1; s < section.size(); ++s) {
    const Vec3& apex = section.front()[0];
    if (section[s][0] == apex || section[s][1] == apex) continue;
    part.caps_.corners.insert(part.caps_.corners.end(), {apex, section[s][0], section[s][1]});
    part.caps_.ends.push_back(part.caps_.corners.size());
  }
  return part;
}

bool ClippedSolid::within(const CutPlane& plane) const {
  const auto isKept = [&](const Vec3& p) { return plane.height(p) <= 0; };
  return std::all_of(skin_.corners.begin(), skin_.corners.end(), isKept) &&
         std::all_of(caps_.corners.begin(), caps_.corners.end(), isKept);
}

double ClippedSolid::volume() const {
  return (sixVolumes(skin_, reference_) + sixVolumes(caps_, reference_)) / 6;
}

}  // namespace sherd
