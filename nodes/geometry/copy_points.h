// Copies of points as the plain numbers that they are.
#pragma once

#include <cstring>
#include <span>

#include "types/vec.h"

namespace sherd {

/// Eigen's vectors copy one by one, several times slower. `to` has room for as many, and does not overlap
/// them.
inline void copyPoints(std::span<const Vec3> from, Vec3* to) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  if (!from.empty()) std::memcpy(static_cast<void*>(to), from.data(), from.size_bytes());
}

}  // namespace sherd
