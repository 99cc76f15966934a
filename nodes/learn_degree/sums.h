// Long sums with one order of summation whatever the processor. Variants for wider registers are chosen at
// run time (function multiversioning); none contracts into fused multiply-adds, so all give the same bits.
#pragma once

#include <cstddef>
#include <span>

namespace sherd {

/// A matrix, column by column.
struct Columns {
  const double* value;
  std::size_t rows, columns;
};

/// y += M a.
void addProduct(const Columns& m, const double* a, double* y);

/// out_j = ‖column j − z‖².
void squaredDistances(const Columns& points, const double* z, double* out);

/// ‖Uᵀ a‖² of an upper triangular U.
double squaredNormOfProduct(const Columns& upper, const double* a);

/// Σ √(v w) and Σ √(w √(v w)).
struct RootSums {
  double half = 0, threeQuarters = 0;
};
RootSums rootSums(std::span<const double> v, std::span<const double> w);

/// Of the first k columns taken by `order`, k = 0 … n, of x = column − centre: Σ w x, Σ w and Σ w ‖x‖², one
/// after the other. `out`: (n + 1) · (rows + 2).
void runningSums(const Columns& columns, const double* centre, const double* weight,
                 std::span<const int> order, double* out);

}  // namespace sherd
