#include "train_degree/rotations.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace sherd {
namespace {

constexpr std::uint64_t kShiftStream = 0x726f7461;     // "rota"
constexpr double kCubicRatio = 1.2207440846057594754;  // x⁴ = x + 1

Eigen::Quaterniond shoemake(double u, double v, double w) {
  const double a = std::sqrt(1 - u), b = std::sqrt(u), p = 2 * M_PI * v, q = 2 * M_PI * w;
  return {b * std::cos(q), a * std::sin(p), a * std::cos(p), b * std::sin(q)};
}

/// R = R_z R_y R_x.
Vec3 anglesOf(const Mat3& r) {
  const double y = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  return Vec3(std::atan2(r(2, 1), r(2, 2)), y, std::atan2(r(1, 0), r(0, 0))) * (180 / M_PI);
}

}  // namespace

std::vector<Vec3> uniformOrientations(int count, std::int64_t seed) {
  const Rng rng(static_cast<std::uint64_t>(seed), kShiftStream);
  std::vector<Vec3> out;
  for (int i = 0; i < count; ++i) {
    double u[3], step = 1;
    for (std::uint64_t k = 0; k < 3; ++k) {
      step /= kCubicRatio;
      const double x = rng.uniformAt(k) + (i + 1) * step;
      u[k] = x - std::floor(x);
    }
    out.push_back(anglesOf(shoemake(u[0], u[1], u[2]).toRotationMatrix()));
  }
  return out;
}

}  // namespace sherd
