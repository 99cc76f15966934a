#include "cvd/distance.h"

#include "base/clones.h"

namespace sherd {

SHERD_CLONES double squaredDistance(const double* a, const double* b, std::size_t size) {
  double sum[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= size; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double difference = a[i + lane] - b[i + lane];
      sum[lane] += difference * difference;
    }
  if (i < size) {
    double last[kLanes] = {};
    for (std::size_t lane = 0; i + lane < size; ++lane) last[lane] = a[i + lane] - b[i + lane];
    for (std::size_t lane = 0; lane < kLanes; ++lane) sum[lane] += last[lane] * last[lane];
  }
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

SHERD_CLONES void addScaled(double* __restrict__ sum, const double* __restrict__ a, double weight,
                            std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) sum[i] += weight * a[i];
}

SHERD_CLONES void sumScaled(double* __restrict__ out, const double* points, const double* weight,
                            std::span<const int> list, std::size_t size) {
  constexpr std::size_t width = 4 * kLanes;  // as many sums as registers hold
  std::size_t i = 0;
  for (; i + width <= size; i += width) {
    double sum[width] = {};
    for (const int n : list) {
      const double* a = points + static_cast<std::size_t>(n) * size + i;
      const double w = weight[n];
      for (std::size_t lane = 0; lane < width; ++lane) sum[lane] += w * a[lane];
    }
    for (std::size_t lane = 0; lane < width; ++lane) out[i + lane] = sum[lane];
  }
  for (std::size_t k = i; k < size; ++k) out[k] = 0;
  for (const int n : list) {
    const double* a = points + static_cast<std::size_t>(n) * size;
    for (std::size_t k = i; k < size; ++k) out[k] += weight[n] * a[k];
  }
}

}  // namespace sherd
