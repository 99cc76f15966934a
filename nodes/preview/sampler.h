// Two-dimensional low-discrepancy points: the additive sequence of Roberts' plastic number ("R2", the golden
// section's analogue in two dimensions), shifted by a random number for every pixel and use.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "base/rng.h"

namespace sherd {

class Sampler {
 public:
  /// Two of these for one pixel of one stream give the same points.
  Sampler(const Rng& rng, std::uint64_t pixel) {
    for (std::uint64_t use = 0; use < kUses; ++use) shift_[use] = rng.bitsAt(kUses * pixel + use);
  }

  /// Point `index` of use `use` < 3, in [0, 1)².
  Eigen::Vector2f point(std::uint32_t index, std::size_t use) const {
    // 1/ρ and 1/ρ² in units of 2^-32, ρ³ = ρ + 1; the sums wrap around as they should.
    const std::uint32_t x = static_cast<std::uint32_t>(shift_[use]) + index * 3242174889u;
    const std::uint32_t y = static_cast<std::uint32_t>(shift_[use] >> 32) + index * 2447445413u;
    return {unit(x), unit(y)};
  }

 private:
  static constexpr std::uint64_t kUses = 3;
  static float unit(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

  std::uint64_t shift_[kUses];
};

}  // namespace sherd
