// Smooth noise that is a pure function of seed and place.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/rng.h"
#include "types/vec.h"

namespace sherd {

/// Uniform values in [0, 1) on a cubic lattice of edge `size` (m), fixed by seed and stream alone
/// (counter-based), interpolated by t³ (10 − 15 t + 6 t²): two derivatives are continuous.
class ValueNoise {
 public:
  ValueNoise(std::uint64_t seed, double size, std::uint64_t stream = 0) : rng_(seed, stream), size_(size) {}

  /// In [0, 1).
  double at(const Vec3& metres) const {
    const Vec3 p = metres / size_, cell = p.array().floor();
    const Vec3 t = p - cell;
    const Vec3 s = (t.array().cube() * (10 + t.array() * (6 * t.array() - 15))).matrix();
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::uint64_t number = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const int high = corner >> axis & 1;
        weight *= high ? s[axis] : 1 - s[axis];
        // 21 bits an axis: it repeats after two million cells.
        const auto place = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[axis]) + high);
        number = number << 21 | (place & 0x1fffff);
      }
      value += weight * rng_.uniformAt(number);
    }
    return value;
  }

 private:
  Rng rng_;
  double size_;
};

}  // namespace sherd
