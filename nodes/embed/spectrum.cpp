#include "embed/spectrum.h"

#include <Spectra/SymEigsShiftSolver.h>
#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>

#include <cmath>

#include "base/rng.h"

namespace sherd {
namespace {

constexpr Eigen::Index kDense = 160;  ///< vertices up to which the dense solver is the faster one

/// Thrown through Spectra, which can't be stopped otherwise.
struct Cancelled {};

/// y = M^½ (S − σ M)⁻¹ M^½ x, the shift-inverted form of M^−½ S M^−½. σ < 0 makes S − σ M positive definite.
class ShiftInvert {
 public:
  using Scalar = double;
  ShiftInvert(const Laplacian& laplacian, const Exec& exec)
      : laplacian_(laplacian), exec_(exec), rootMass_(laplacian.mass.cwiseSqrt()) {}

  void set_shift(double sigma) {
    Eigen::SparseMatrix<double> shifted = laplacian_.stiffness;
    for (Eigen::Index i = 0; i < rows(); ++i) shifted.coeffRef(i, i) -= sigma * laplacian_.mass[i];
    factor_.compute(shifted);
  }
  bool ok() const { return factor_.info() == Eigen::Success; }
  Eigen::Index rows() const { return laplacian_.mass.size(); }
  Eigen::Index cols() const { return rows(); }
  void perform_op(const double* in, double* out) const {
    if (exec_.cancelled()) throw Cancelled{};
    const Eigen::Map<const Eigen::VectorXd> x(in, rows());
    Eigen::Map<Eigen::VectorXd> y(out, rows());
    const Eigen::VectorXd right = rootMass_.cwiseProduct(x);
    y = rootMass_.cwiseProduct(factor_.solve(right));
  }

 private:
  const Laplacian& laplacian_;
  const Exec& exec_;
  Eigen::VectorXd rootMass_;
  Eigen::CholmodSimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

/// Fixes the signs that an eigensolver leaves open.
void fixSigns(Eigen::MatrixXd& functions) {
  for (Eigen::Index k = 0; k < functions.cols(); ++k) {
    const double largest = functions.col(k).cwiseAbs().maxCoeff();
    // The first of nearly largest magnitude: rounding must not choose between mirror images.
    for (Eigen::Index i = 0; i < functions.rows(); ++i) {
      if (std::abs(functions(i, k)) < (1 - 1e-6) * largest) continue;
      if (functions(i, k) < 0) functions.col(k) = -functions.col(k);
      break;
    }
  }
}

/// Modes from eigenvectors of M^−½ S M^−½ in ascending order, the constant one first.
Modes asModes(const Laplacian& laplacian, const Eigen::VectorXd& values, const Eigen::MatrixXd& vectors,
              Eigen::Index count) {
  Modes modes{values.segment(1, count),
              laplacian.mass.cwiseSqrt().cwiseInverse().asDiagonal() * vectors.middleCols(1, count)};
  fixSigns(modes.functions);
  return modes;
}

Modes denseModes(const Laplacian& laplacian, Eigen::Index count) {
  const Eigen::VectorXd inverseRoot = laplacian.mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd dense =
      inverseRoot.asDiagonal() * Eigen::MatrixXd(laplacian.stiffness) * inverseRoot.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense);
  return asModes(laplacian, solver.eigenvalues(), solver.eigenvectors(), count);
}

}  // namespace

Result<Modes> lowestModes(const Laplacian& laplacian, int wanted, const Exec& exec) {
  const Eigen::Index n = laplacian.mass.size();
  const Eigen::Index count = std::min<Eigen::Index>(wanted, n - 1);
  if (count < 1) return Modes{Eigen::VectorXd(0), Eigen::MatrixXd(n, 0)};
  const Eigen::Index basis = std::min(n, std::max<Eigen::Index>(2 * (count + 1), 20));
  if (n <= kDense || basis >= n) return denseModes(laplacian, count);

  // Close to the spectrum's lower end: λ_1 is at least of the order of 1 / (area or volume)^(2/d); an area's
  // order will do for both, since the shift only has to be small and the factor positive.
  const double scale = laplacian.stiffness.diagonal().sum() / laplacian.mass.sum();
  ShiftInvert operation(laplacian, exec);
  const double shift = -1e-4 * scale / static_cast<double>(n);
  try {
    Spectra::SymEigsShiftSolver<ShiftInvert> solver(operation, count + 1, basis, shift);
    if (!operation.ok()) return failure("the Laplacian of the tetrahedral mesh could not be factored");
    Eigen::VectorXd start(n);
    const Rng random(0x656d6265, 0);
    for (Eigen::Index i = 0; i < n; ++i) start[i] = random.uniformAt(static_cast<std::uint64_t>(i)) - 0.5;
    solver.init(start.data());
    if (exec.cancelled()) return cancelledError();
    solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10, Spectra::SortRule::SmallestAlge);
    if (solver.info() != Spectra::CompInfo::Successful)
      return failure("the eigenmodes of the tetrahedral mesh did not converge",
                     "ask for fewer dimensions, or measure with metric: euclidean", "dimensions");
    return asModes(laplacian, solver.eigenvalues(), solver.eigenvectors(), count);
  } catch (const Cancelled&) {
    return cancelledError();
  } catch (const std::exception& e) {
    return failure(std::string("the eigenmodes of the tetrahedral mesh could not be computed: ") + e.what(),
                   "measure with metric: euclidean", "metric");
  }
}

}  // namespace sherd
