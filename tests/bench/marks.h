// What stands out in plots.
#pragma once

#include <string>
#include <utility>

#include "bench/plot.h"

namespace sherd::bench {

/// A cross over a point: the default among choices.
inline Series crossAt(std::string name, double x, double y) {
  constexpr double kArm = 1.5;
  return {std::move(name), {x / kArm, x * kArm, x, x, x}, {y, y, y, y * kArm, y / kArm}};
}

}  // namespace sherd::bench
