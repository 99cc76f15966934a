#include "cvd/lane_bounds.h"

#include <cmath>
#include <limits>

#include "base/clones.h"

namespace sherd {
namespace {

using Lanes __attribute__((vector_size(sizeof(LaneValues)), may_alias)) = float;

constexpr double kUlp = 0x1p-24;      // of float, relative, when rounding to nearest
constexpr float kUnderflow = 1e-36f;  // more than d · 2⁻¹⁴⁹ for d ≤ 10⁷ dimensions
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}  // namespace

SHERD_CLONES unsigned compareLanes(const LaneValues* block, const LaneSite& site, std::size_t dimensions,
                                   const float* __restrict__ up, LaneValues& __restrict__ low,
                                   LaneValues& __restrict__ high) {
  const auto* x = reinterpret_cast<const Lanes*>(block);
  const float* p = site.minusTwice;
  Lanes sums[4] = {};  // four, so that one addition needn't wait for another
  std::size_t i = 0;
  for (; i + 4 <= dimensions; i += 4) {
    sums[0] += x[i] * p[i], sums[1] += x[i + 1] * p[i + 1];
    sums[2] += x[i + 2] * p[i + 2], sums[3] += x[i + 3] * p[i + 3];
  }
  for (; i < dimensions; ++i) sums[0] += x[i] * p[i];
  const Lanes norms = x[dimensions] + site.squaredNorm;
  const Lanes squares = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + norms;
  const Lanes error = norms * static_cast<float>(static_cast<double>(dimensions + 16) * kUlp) + kUnderflow;
  unsigned open = 0;
  for (std::size_t k = 0; k < kNodeLanes; ++k) {
    const float least = squares[k] - error[k], most = squares[k] + error[k];
    // What overflowed, or isn't a number any more, is known to be nothing.
    low.lane[k] = std::sqrt(least > 0 && least < kInfinity ? least : 0) * kBoundDown;
    high.lane[k] = most < kInfinity ? std::sqrt(most) * kBoundUp : kInfinity;
    open |= static_cast<unsigned>(!(low.lane[k] > up[k])) << k;
  }
  return open;
}

SHERD_CLONES void keepBounds(const LaneValues& __restrict__ low, float drift, LaneValues& __restrict__ kept) {
  for (std::size_t k = 0; k < kNodeLanes; ++k) kept.lane[k] = (low.lane[k] + drift) * kBoundDown;
}

SHERD_CLONES void findOpenLanes(const LaneValues* __restrict__ bound, const float* __restrict__ drift,
                                std::size_t count, const float* __restrict__ up,
                                std::uint16_t* __restrict__ open) {
  for (std::size_t j = 0; j < count; ++j) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < kNodeLanes; ++k)
      bits |= static_cast<unsigned>(!(bound[j].lane[k] - drift[j] > up[k])) << k;
    open[j] = static_cast<std::uint16_t>(bits);
  }
}

SHERD_CLONES unsigned lanesWithLabel(const int* labels, int label) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < kNodeLanes; ++k) bits |= static_cast<unsigned>(labels[k] == label) << k;
  return bits;
}

}  // namespace sherd
