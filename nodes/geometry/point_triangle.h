// The point of a triangle that is closest to another point.
#pragma once

#include <algorithm>

#include "types/vec.h"

namespace sherd {

/// Closest point of segment ab to p. A segment of no length is its end.
inline Vec3 closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length2 = (b - a).squaredNorm();
  if (!(length2 > 0)) return a;
  return a + std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) * (b - a);
}

/// Closest point of triangle abc to p: its projection where that falls inside, else the
/// closest of the edges'.
inline Vec3 closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  if (normal.squaredNorm() > 0 && normal.dot((b - a).cross(p - a)) >= 0 &&
      normal.dot((c - b).cross(p - b)) >= 0 && normal.dot((a - c).cross(p - c)) >= 0)
    return p - normal.dot(p - a) / normal.squaredNorm() * normal;
  Vec3 best = closestOnSegment(p, a, b);
  for (const Vec3& q : {closestOnSegment(p, b, c), closestOnSegment(p, c, a)})
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  return best;
}

}  // namespace sherd
