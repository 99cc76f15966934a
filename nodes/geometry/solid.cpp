#include "geometry/solid.h"

namespace sherd {
namespace {

Mat3 matrixOf(const std::array<double, 6>& m) {
  Mat3 result;
  result << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  return result;
}

}  // namespace

SolidIntegrals integrateSolid(std::span<const Vec3> positions,
                              std::span<const std::span<const Triangle>> lists) {
  SolidIntegrals result;
  const Vec3* origin = nullptr;
  for (const auto& list : lists)
    if (origin == nullptr && !list.empty()) origin = &positions[at(list.front()[0])];
  if (origin == nullptr) return result;
  SolidSums sums;
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
  result = integralsOf(sums, *origin);
  if (sums.volume == 0) result.centroid = *origin + Vec3(mean / static_cast<double>(corners));
  return result;
}

SolidIntegrals integralsOf(const SolidSums& sums, const Vec3& origin) {
  SolidIntegrals result;
  const Vec3 first(sums.first[0], sums.first[1], sums.first[2]);
  const Vec3 local = sums.volume != 0 ? Vec3(first / sums.volume) : Vec3::Zero();
  result.volume = sums.volume;
  result.centroid = origin + local;
  result.secondMoment = matrixOf(sums.second) - sums.volume * local * local.transpose();
  return result;
}

SolidIntegrals integrateSolid(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  const std::span<const Triangle> lists[] = {triangles};
  return integrateSolid(positions, lists);
}

double solidVolume(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  if (triangles.empty()) return 0;
  const Vec3& origin = positions[at(triangles.front()[0])];
  double volume = 0;
  for (const Triangle& t : triangles)
    volume +=
        (positions[at(t[0])] - origin).cross(positions[at(t[1])] - origin).dot(positions[at(t[2])] - origin) /
        6;
  return volume;
}

}  // namespace sherd
