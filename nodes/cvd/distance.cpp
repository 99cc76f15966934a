#include "cvd/distance.h"

#include "base/clones.h"

namespace sherd {

SHERD_CLONES double squaredDistance(const double* a, const double* b, std::size_t size) {
  double sum[kLanes] = {};
  for (std::size_t i = 0; i < size; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double difference = a[i + lane] - b[i + lane];
      sum[lane] += difference * difference;
    }
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

SHERD_CLONES void addScaled(double* __restrict__ sum, const double* __restrict__ a, double weight,
                            std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) sum[i] += weight * a[i];
}

}  // namespace sherd
