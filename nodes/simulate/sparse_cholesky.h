// Sparse Cholesky factorization by CHOLMOD (supernodal, on OpenBLAS), which this header hides.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "types/vec.h"

namespace sherd {

/// A symmetric matrix of 3 × 3 blocks, one row and column of blocks per node; the lower triangle by columns.
struct BlockMatrix {
  std::vector<Index> begin;  ///< per block column: its first entry in `row`; one more at the end
  std::vector<Index> row;    ///< block rows ≥ the column, ascending, the diagonal first
  std::vector<Mat3> block;   ///< per entry of `row`

  std::size_t size() const { return begin.size() - 1; }
};

/// LLᵀ of a positive definite matrix. Solving is const and safe from several threads at once. Everything runs
/// on the calling thread: OpenBLAS and OpenMP are set to one thread, since their bits depend on the number.
/// Substitution is our own (supernodal_solve.h), for the same reason: BLAS has other bits for several loads.
class SparseCholesky {
 public:
  /// `order`: all nodes in the order of elimination (nestedDissection), which decides how large the factor
  /// gets. Cost with a good one, for a solid mesh of n nodes: O(n²) arithmetic, O(n^4/3) memory.
  static Result<SparseCholesky> factor(const BlockMatrix& matrix, std::span<const Index> order);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;

  /// x := A⁻¹ x; x.size() is the number of nodes.
  void solve(std::span<Vec3> x) const;
  /// The same for each of at most kSolveWidth vectors, to the bit, in little more time than two of them take.
  void solve(std::span<std::vector<Vec3>* const> xs) const;
  /// Numbers stored in L.
  double factorSize() const;
  /// Bytes: the most that factoring held at once, matrix and factor included.
  std::size_t peakBytes() const;

 private:
  struct Impl;
  explicit SparseCholesky(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
