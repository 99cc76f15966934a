// What is thrown away first when the cache is full.
#pragma once

#include <cmath>
#include <cstdint>

namespace sherd::store {

/// Without use for as long, what is kept is worth half as much.
constexpr double kHalfLife = 2 * 86400.0;  // s

/// Of something that took `ms` to make, has `bytes` and was last used `unused` seconds ago: time per byte,
/// halved for every kHalfLife, as a logarithm to base 2. The least goes first (GreedyDual-Size, with the
/// clock for its rising bar).
inline double worth(double ms, std::uint64_t bytes, double unused) {
  return std::log2((ms + 1e-3) / (static_cast<double>(bytes) + 1)) - unused / kHalfLife;
}

}  // namespace sherd::store
