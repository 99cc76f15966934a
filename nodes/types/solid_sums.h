// Running sums of a solid's volume integrals (divergence theorem): plain numbers that add up over any parts
// of its surface.
#pragma once

#include <array>

#include "types/vec.h"

namespace sherd {

/// Over the tetrahedra from one common origin to triangles, the triangles' corners relative to it.
struct SolidSums {
  double volume = 0;               ///< m³
  std::array<double, 3> first{};   ///< m⁴: ∫ x dV
  std::array<double, 6> second{};  ///< m⁵: ∫ of xx, yy, zz, xy, yz, zx

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double v = a.cross(b).dot(c) / 6;
    volume += v;
    const Vec3 s = a + b + c;
    // ∫ x dV = v/4 s, and ∫ x xᵀ dV = v/20 (a aᵀ + b bᵀ + c cᵀ + s sᵀ).
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const auto k = static_cast<std::size_t>(i);
      first[k] += v / 4 * s[i];
      second[k] += v / 20 * (a[i] * a[i] + b[i] * b[i] + c[i] * c[i] + s[i] * s[i]);
      second[k + 3] += v / 20 * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]);
    }
  }

  SolidSums& operator+=(const SolidSums& o) {
    volume += o.volume;
    for (std::size_t i = 0; i < first.size(); ++i) first[i] += o.first[i];
    for (std::size_t i = 0; i < second.size(); ++i) second[i] += o.second[i];
    return *this;
  }
  SolidSums& operator-=(const SolidSums& o) {
    volume -= o.volume;
    for (std::size_t i = 0; i < first.size(); ++i) first[i] -= o.first[i];
    for (std::size_t i = 0; i < second.size(); ++i) second[i] -= o.second[i];
    return *this;
  }
};

}  // namespace sherd
