#include "repair/footing.h"

#include <cmath>

#include "geometry/point_triangle.h"

namespace sherd {
namespace {

constexpr double kOn = 1e-9;  ///< of the diagonal: as far from the surface as rounding takes a point on it

std::vector<Triangle> without(const std::vector<Triangle>& triangles, const std::vector<bool>& isSheet) {
  std::vector<Triangle> list;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!isSheet[t]) list.push_back(triangles[t]);
  return list;
}

std::vector<Box> boxesOf(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index v : triangles[t]) boxes[t].add(positions[at(v)]);
  return boxes;
}

}  // namespace

Footing::Footing(const Patchwork& surface, const std::vector<bool>& isSheet)
    : positions_(surface.positions),
      triangles_(without(surface.triangles, isSheet)),
      tree_(positions_, triangles_),
      boxes_(boxesOf(positions_, triangles_)),
      boxTree_(boxes_) {
  for (const Box& box : boxes_) {
    box_.add(box.low);
    box_.add(box.high);
  }
}

bool Footing::isNear(const Vec3& p, double distance) const {
  Box around;
  around.add(p - Vec3::Constant(distance));
  around.add(p + Vec3::Constant(distance));
  return box_.overlaps(around) && tree_.closest(p).distance <= distance;
}

bool Footing::holds(const Vec3& p) const {
  if (isNear(p, kOn * diagonal())) return true;
  Box point;
  point.add(p);
  return box_.overlaps(point) && tree_.contains(p);
}

Vec3 Footing::reach(const Vec3& p, const Vec3& normal, double thickness) const {
  const SurfacePoint nearest = tree_.closest(p);
  if (nearest.distance >= 0.5 * thickness) return Vec3::Zero();
  const Vec3 out = normalAt(nearest.point);
  const double across = normal.cross(out).norm();
  if (across < 1e-6) return Vec3::Zero();
  const Vec3 step = across * (thickness + nearest.distance) * out;
  // The solid may still be inside out.
  const bool isTurned =
      tree_.contains(nearest.point + 0.1 * step) && !tree_.contains(nearest.point - 0.1 * step);
  return isTurned ? step : Vec3(-step);
}

Vec3 Footing::normalAt(const Vec3& nearest) const {
  const double on = kOn * diagonal();
  Box around;
  around.add(nearest - Vec3::Constant(on));
  around.add(nearest + Vec3::Constant(on));
  std::vector<Vec3> normals;
  boxTree_.visitOverlaps(around, [&](Index t) {
    const auto& [i, j, k] = triangles_[at(t)];
    const Vec3 &a = positions_[at(i)], &b = positions_[at(j)], &c = positions_[at(k)];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    if ((closestOnTriangle(nearest, a, b, c) - nearest).norm() > on || !(normal.squaredNorm() > 0.5)) return;
    for (const Vec3& other : normals)
      if ((other - normal).norm() < 1e-6) return;
    normals.push_back(normal);
  });
  Vec3 sum = Vec3::Zero();
  for (const Vec3& normal : normals) sum += normal;
  return sum.norm() > 1e-6 ? Vec3(sum.normalized()) : Vec3::Zero();
}

}  // namespace sherd
