// What a brush does to a scalar field.
#pragma once

#include <algorithm>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// How a value meets the one that is there.
enum class Blend { Replace, Add, Multiply, Max, Min };

inline double blended(Blend blend, double there, double value) {
  switch (blend) {
    case Blend::Replace:
      return value;
    case Blend::Add:
      return there + value;
    case Blend::Multiply:
      return there * value;
    case Blend::Max:
      return std::max(there, value);
    case Blend::Min:
      return std::min(there, value);
  }
  return value;
}

/// A dab (one point) or a polyline. At distance d from it the field v becomes v + s(d) (blend(v, value) − v)
/// with the strength
///   s(d) = 1                        d ≤ (1 − falloff) radius
///   s(d) = 1 − t² (3 − 2 t)         t = (d − (1 − falloff) radius) / (falloff radius) in (0, 1)
///   s(d) = 0                        d ≥ radius
/// where d is that from the whole polyline, so that a stroke which crosses itself counts once.
struct Stroke {
  std::vector<Vec3> points;  ///< m, program axes (y up); one or more, finite
  double radius = 0;         ///< m, > 0
  double falloff = 0.5;      ///< share of the radius over which it fades, in [0, 1]
  double value = 1;          ///< finite
  Blend blend = Blend::Replace;

  double strengthAt(double distance) const {
    const double core = (1 - falloff) * radius;
    if (distance >= radius) return 0;
    if (distance <= core) return 1;
    const double t = (distance - core) / (radius - core);
    return 1 - t * t * (3 - 2 * t);
  }
};

}  // namespace sherd
