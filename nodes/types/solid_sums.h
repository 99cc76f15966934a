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
    const auto moment = [&](int i, int j) { return a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]; };
    const double quarter = v / 4, twentieth = v / 20;
    first[0] += quarter * s[0];
    first[1] += quarter * s[1];
    first[2] += quarter * s[2];
    second[0] += twentieth * moment(0, 0);
    second[1] += twentieth * moment(1, 1);
    second[2] += twentieth * moment(2, 2);
    second[3] += twentieth * moment(0, 1);
    second[4] += twentieth * moment(1, 2);
    second[5] += twentieth * moment(2, 0);
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
