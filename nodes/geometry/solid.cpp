#include "geometry/solid.h"

namespace sherd {
namespace {

/// Running sums of a solid made of tetrahedra from `origin` to each triangle.
struct Sums {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double v = a.cross(b).dot(c) / 6;
    const Vec3 s = a + b + c;
    volume += v;
    first += v / 4 * s;
    // ∫ x xᵀ over the tetrahedron (0, a, b, c) = v/20 (a aᵀ + b bᵀ + c cᵀ + s sᵀ).
    second += v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
};

}  // namespace

SolidIntegrals integrateSolid(std::span<const Vec3> positions,
                              std::span<const std::span<const Triangle>> lists) {
  SolidIntegrals result;
  const Vec3* origin = nullptr;
  for (const auto& list : lists)
    if (origin == nullptr && !list.empty()) origin = &positions[at(list.front()[0])];
  if (origin == nullptr) return result;
  Sums sums;
  Vec3 mean = Vec3::Zero();
  std::size_t corners = 0;
  for (const auto& list : lists)
    for (const Triangle& t : list) {
      const Vec3 a = positions[at(t[0])] - *origin, b = positions[at(t[1])] - *origin,
                 c = positions[at(t[2])] - *origin;
      sums.add(a, b, c);
      mean += a + b + c;
      corners += 3;
    }
  result.volume = sums.volume;
  const Vec3 local =
      sums.volume != 0 ? Vec3(sums.first / sums.volume) : Vec3(mean / static_cast<double>(corners));
  result.centroid = *origin + local;
  result.secondMoment = sums.second - sums.volume * local * local.transpose();
  return result;
}

SolidIntegrals integrateSolid(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  const std::span<const Triangle> lists[] = {triangles};
  return integrateSolid(positions, lists);
}

double solidVolume(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  return integrateSolid(positions, triangles).volume;
}

}  // namespace sherd
