// Harmonic extension (extension.h).
#include <Eigen/CholmodSupport>
#include <vector>

#include "embed/extension.h"
#include "embed/spectrum.h"

namespace sherd {

Result<void> extendHarmonically(std::span<const Vec3> nodes, std::span<const Tetra> tets,
                                const std::vector<char>& given, Eigen::MatrixXd& values,
                                std::span<const double> stretch) {
  std::vector<Eigen::Index> unknownOf(nodes.size(), -1);
  Eigen::Index unknowns = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!given[n]) unknownOf[n] = unknowns++;
  if (unknowns == 0) return {};

  const Laplacian laplacian = solidLaplacian(nodes, tets, stretch);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, values.cols());
  for (Eigen::Index column = 0; column < laplacian.stiffness.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(laplacian.stiffness, column); it; ++it) {
      const Eigen::Index row = unknownOf[static_cast<std::size_t>(it.row())];
      if (row < 0) continue;
      const Eigen::Index other = unknownOf[static_cast<std::size_t>(column)];
      if (other >= 0)
        entries.emplace_back(row, other, it.value());
      else
        right.row(row) -= it.value() * values.row(column);
    }
  Eigen::SparseMatrix<double> inner(unknowns, unknowns);
  inner.setFromTriplets(entries.begin(), entries.end());
  const Eigen::CholmodSimplicialLDLT<Eigen::SparseMatrix<double>> factor(inner);
  if (factor.info() != Eigen::Success)
    return failure("the harmonic extension has no solution on this tetrahedral mesh", "use extension: mvc",
                   "extension");
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    const Eigen::VectorXd solution = factor.solve(right.col(k));
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (unknownOf[n] >= 0) values(static_cast<Eigen::Index>(n), k) = solution[unknownOf[n]];
  }
  return {};
}

}  // namespace sherd
