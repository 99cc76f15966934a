// Doubles with the precision of a float.
#pragma once

#include "types/vec.h"

namespace sherd {

/// The double that the nearest float to `x` is; ±∞ beyond the floats' range; 0 for −0. Not inline: GCC 12
/// drops the rounding where it turns two conversions side by side into a vector's.
double roundedToFloat(double x);

template <int N>
Eigen::Matrix<double, N, 1> roundedToFloat(const Eigen::Matrix<double, N, 1>& v) {
  Eigen::Matrix<double, N, 1> rounded;
  for (int i = 0; i < N; ++i) rounded[i] = roundedToFloat(v[i]);
  return rounded;
}

}  // namespace sherd
