// Squared distances and weighted sums over coordinates of many dimensions, with one order of summation
// whatever the processor: the labels' ties, and with them the cut, hang on the last bit.
//
// Vectors are padded with zeros to a multiple of kLanes. Component i goes to partial sum i mod 8; the sums
// are added as ((s0+s4)+(s1+s5)) + ((s2+s6)+(s3+s7)). Variants for wider registers are chosen at run time
// (function multiversioning); none contracts into fused multiply-adds, so all give the same bits.
#pragma once

#include <cstddef>

namespace sherd {

inline constexpr std::size_t kLanes = 8;

constexpr std::size_t paddedSize(std::size_t dimensions) {
  return (dimensions + kLanes - 1) / kLanes * kLanes;
}

/// ‖a − b‖² of two padded vectors. `size` is a multiple of kLanes.
double squaredDistance(const double* a, const double* b, std::size_t size);

/// sum += weight · a, component by component.
void addScaled(double* sum, const double* a, double weight, std::size_t size);

}  // namespace sherd
