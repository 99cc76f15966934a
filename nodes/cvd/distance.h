// Squared distances and weighted sums over coordinates of many dimensions, with one order of summation
// whatever the processor: the labels' ties, and with them the cut, hang on the last bit.
//
// Component i goes to partial sum i mod 8; the sums are added as ((s0+s4)+(s1+s5)) + ((s2+s6)+(s3+s7)), so
// that zeros behind a vector change nothing. Variants for wider registers are chosen at run time
// (function multiversioning); none contracts into fused multiply-adds, so all give the same bits.
#pragma once

#include <cstddef>
#include <span>

namespace sherd {

inline constexpr std::size_t kLanes = 8;

/// ‖a − b‖² of two vectors of any size; quickest for multiples of kLanes.
double squaredDistance(const double* a, const double* b, std::size_t size);

/// sum += weight · a, component by component.
void addScaled(double* sum, const double* a, double weight, std::size_t size);

/// out = Σ weight[n] · points[n · size …] over the numbers n listed, component by component from 0 on, in the
/// order of the list.
void sumScaled(double* out, const double* points, const double* weight, std::span<const int> list,
               std::size_t size);

}  // namespace sherd
