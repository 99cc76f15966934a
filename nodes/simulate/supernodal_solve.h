// Forward and back substitution with a supernodal Cholesky factor, for one load or a block of them.
//
// Every unknown of every load goes through the same operations in the same order whatever the width of the
// block: a load's bits do not depend on what is solved beside it, which BLAS does not promise. A wide block
// reads the factor once for all its loads; reading it is most of the time of a single one.
#pragma once

#include <cstddef>

namespace sherd {

/// Loads that are solved side by side.
inline constexpr std::size_t kSolveWidth = 16;
/// Fewer loads are faster one by one.
inline constexpr std::size_t kWorthABlock = 3;

/// A view of CHOLMOD's simplest form of LLᵀ: dense column blocks over lists of rows (cholmod_factor,
/// "supernodal").
struct SupernodalFactor {
  std::size_t supernodes = 0;
  const int* column = nullptr;    ///< per supernode, its first column; one more at the end
  const int* rowBegin = nullptr;  ///< per supernode, its first entry in `row`; one more at the end
  const int* valueBegin = nullptr;
  const int* row = nullptr;       ///< of each supernode: its own columns, then those below, ascending
  const double* value = nullptr;  ///< per supernode rows × columns, by columns; above the diagonal: unused
};

/// x := (LLᵀ)⁻¹ x for `width` loads, 1 or kSolveWidth, in the factor's order: x[width · row + load].
void solveSupernodal(const SupernodalFactor& factor, double* x, std::size_t width);

}  // namespace sherd
