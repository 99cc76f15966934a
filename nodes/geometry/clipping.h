// Convex polygons cut by half spaces.
#pragma once

#include <array>
#include <cstddef>

#include "types/vec.h"

namespace sherd {

/// A convex polygon on the stack. A triangle cut by n half spaces has at most 3 + n corners.
class Polygon {
 public:
  static constexpr std::size_t kCapacity = 24;
  void push_back(const Vec3& p) { corners_[size_++] = p; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Vec3& operator[](std::size_t i) const { return corners_[i]; }
  const Vec3* begin() const { return corners_.data(); }
  const Vec3* end() const { return corners_.data() + size_; }

 private:
  std::array<Vec3, kCapacity> corners_;
  std::size_t size_ = 0;
};

/// The part of the polygon with normal · (x − origin) ≤ 0 (Sutherland and Hodgman 1974). The corners are kept
/// in order; a cut edge gets its new corner from the end with the smaller height first, so that two polygons
/// that share an edge get the same one.
inline Polygon clipPolygon(const Polygon& polygon, const Vec3& origin, const Vec3& normal) {
  Polygon out;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % n];
    const double hp = normal.dot(p - origin), hq = normal.dot(q - origin);
    if (hp <= 0) out.push_back(p);
    if ((hp <= 0) == (hq <= 0)) continue;
    out.push_back(hp <= hq ? Vec3(p + hp / (hp - hq) * (q - p)) : Vec3(q + hq / (hq - hp) * (p - q)));
  }
  return out;
}

}  // namespace sherd
