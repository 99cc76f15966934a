#include "convex_proxies/clipped.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace sherd {
namespace {

using Segment = std::array<Vec3, 2>;

/// In sizes of the solid: what rounding moves points off their plane or line. Without it a plane that is also
/// a cap's would cut that cap and the segments around it, which have other corners, in different places.
constexpr double kOff = 1e-12;

/// The kept part of one polygon goes to `out`; where it ends on the plane, the way back goes to `section`.
class PolygonCutter {
 public:
  /// `off`: how far from the plane points still count as in it.
  PolygonCutter(const CutPlane& plane, double off, PolygonList& out, std::vector<Segment>& section)
      : plane_(plane), off_(off), out_(out), section_(section) {}

  void cut(std::span<const Vec3> polygon) {
    heights_.clear();
    bool below = false;
    for (const Vec3& p : polygon) {
      const double height = plane_.height(p);
      const double h = heights_.emplace_back(std::abs(height) <= off_ ? 0 : height);
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
  double off_;
  PolygonList& out_;
  std::vector<Segment>& section_;
  std::vector<double> heights_;
  std::vector<Vec3> corners_;
  std::vector<bool> onPlane_;
};

struct LineEnd {
  double along;  ///< the segments' line
  int turn;      ///< 1 where a segment begins, -1 where one ends
  const Vec3* point;
};

/// The ends of segments along a line, in its order; those of one place become one, and are gone where as many
/// segments begin as end. Empty where the ends are on no line: planes that hardly differ cut each other
/// anywhere.
std::vector<LineEnd> endsAlong(const std::vector<Segment>& segments, const Vec3& direction, double off) {
  std::vector<LineEnd> ends;
  for (const Segment& s : segments) {
    ends.push_back({direction.dot(s[0]), 1, &s[0]});
    ends.push_back({direction.dot(s[1]), -1, &s[1]});
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const LineEnd& a, const LineEnd& b) { return a.along < b.along; });
  std::vector<LineEnd> merged;
  for (const LineEnd& end : ends) {
    const Vec3 reach = *end.point - *ends.front().point;
    if ((reach - direction.dot(reach) * direction).norm() > off) return {};
    if (!merged.empty() && *end.point == *merged.back().point)
      merged.back().turn += end.turn;
    else
      merged.push_back(end);
  }
  std::erase_if(merged, [](const LineEnd& end) { return end.turn == 0; });
  return merged;
}

/// Adds the sum of segments of one line, as a signed chain, in as few segments as there can be.
void addSum(const std::vector<Segment>& segments, const Vec3& direction, double off,
            std::vector<Segment>& out) {
  const double length = direction.norm();
  std::vector<LineEnd> ends;
  if (segments.size() > 1 && length > 0) ends = endsAlong(segments, direction / length, off);
  if (ends.empty()) out.insert(out.end(), segments.begin(), segments.end());
  int over = 0;  // segments over the current place: those along less those against the line
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    over += ends[i].turn;
    for (int k = 0; k < std::abs(over); ++k)
      out.push_back(over > 0 ? Segment{*ends[i].point, *ends[i + 1].point}
                             : Segment{*ends[i + 1].point, *ends[i].point});
  }
}

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
  if (triangles.empty()) return;
  reference_ = box.centre();
  size_ = box.diagonal();
}

ClippedSolid ClippedSolid::clipped(const CutPlane& plane) const {
  ClippedSolid part;
  part.reference_ = reference_;
  part.size_ = size_;
  part.planes_ = planes_;
  part.planes_.push_back(plane);
  std::vector<Segment> section, crossings;
  PolygonCutter skin(plane, kOff * size_, part.skin_, section);
  for (std::size_t i = 0; i < skin_.size(); ++i) skin.cut(skin_.polygon(i));
  for (std::size_t c = 0; c < caps_.size(); ++c) {
    crossings.clear();
    PolygonCutter cap(plane, kOff * size_, part.caps_.emplace_back(), crossings);
    for (std::size_t i = 0; i < caps_[c].size(); ++i) cap.cut(caps_[c].polygon(i));
    addSum(crossings, planes_[c].normal.cross(plane.normal), kOff * size_, section);
  }
  PolygonList& fan = part.caps_.emplace_back();
  for (std::size_t s = 1; s < section.size(); ++s) {
    const Vec3& apex = section.front()[0];
    if (section[s][0] == apex || section[s][1] == apex) continue;
    fan.corners.insert(fan.corners.end(), {apex, section[s][0], section[s][1]});
    fan.ends.push_back(fan.corners.size());
  }
  return part;
}

bool ClippedSolid::within(const CutPlane& plane) const {
  const auto isKept = [&](const Vec3& p) { return plane.height(p) <= kOff * size_; };
  return std::all_of(skin_.corners.begin(), skin_.corners.end(), isKept) &&
         std::all_of(caps_.begin(), caps_.end(), [&](const PolygonList& cap) {
           return std::all_of(cap.corners.begin(), cap.corners.end(), isKept);
         });
}

bool ClippedSolid::empty() const { return polygons() == 0; }

std::size_t ClippedSolid::polygons() const {
  std::size_t count = skin_.size();
  for (const PolygonList& cap : caps_) count += cap.size();
  return count;
}

double ClippedSolid::volume() const {
  double sum = sixVolumes(skin_, reference_);
  for (const PolygonList& cap : caps_) sum += sixVolumes(cap, reference_);
  return sum / 6;
}

}  // namespace sherd
