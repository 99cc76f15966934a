#include "embed/convexity.h"

#include "geometry/convex_hull.h"

namespace sherd {

Result<double> convexHullVolume(std::span<const Vec3> points) {
  const auto hull = convexHull(points);
  if (hull.ok()) return hull->volume;
  Error error = hull.error();
  error.port = "metric";
  return error;
}

}  // namespace sherd
