#include "train_degree/ball_hits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/rng.h"

namespace sherd {
namespace {

constexpr std::uint64_t kHitStream = 0x62616c6c;         // "ball"
constexpr double kSexticRatio = 1.16730397826141868426;  // x⁶ = x + 1

/// The sum of the areas up to each triangle, its own included.
std::vector<double> areaSums(const TriMesh& surface) {
  std::vector<double> sums;
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = surface.positions[at(t[0])], &b = surface.positions[at(t[1])],
               &c = surface.positions[at(t[2])];
    sum += (b - a).cross(c - a).norm() / 2;
    sums.push_back(sum);
  }
  return sums;
}

Vec3 onSphere(double u, double v) {
  const double z = 2 * u - 1, r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(2 * M_PI * v), r * std::sin(2 * M_PI * v), z};
}

}  // namespace

std::vector<BallHit> spreadBallHits(const TriMesh& surface, int count, bool fromAbove, std::int64_t seed) {
  const std::vector<double> sums = areaSums(surface);
  std::vector<BallHit> hits;
  if (sums.empty()) return hits;
  Vec3 low = surface.positions[0], high = low;
  for (const Vec3& p : surface.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 extent = (high - low).unaryExpr([](double e) { return e > 0 ? e : 1; });
  const Rng rng(static_cast<std::uint64_t>(seed), kHitStream);
  for (int i = 0; i < count; ++i) {
    std::array<double, 5> u{};
    double step = 1;
    for (std::uint64_t k = 0; k < u.size(); ++k) {
      step /= kSexticRatio;
      const double x = rng.uniformAt(k) + (i + 1) * step;
      u[k] = x - std::floor(x);
    }
    const auto found = std::upper_bound(sums.begin(), sums.end(), u[0] * sums.back());
    const auto place = std::min<std::ptrdiff_t>(found - sums.begin(), std::ssize(sums) - 1);
    const Triangle& t = surface.triangles[static_cast<std::size_t>(place)];
    const Vec3 &a = surface.positions[at(t[0])], &b = surface.positions[at(t[1])],
               &c = surface.positions[at(t[2])];
    const double s = std::sqrt(u[1]);
    const Vec3 point = (1 - s) * a + s * (1 - u[2]) * b + s * u[2] * c;
    const Vec3 normal = (b - a).cross(c - a).normalized();
    Vec3 direction = -(normal + 0.999 * onSphere(u[3], u[4])).normalized();
    if (fromAbove) direction.y() = -std::abs(direction.y());
    hits.push_back({(point - low).cwiseQuotient(extent), direction});
  }
  return hits;
}

}  // namespace sherd
