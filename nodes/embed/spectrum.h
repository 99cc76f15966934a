// Laplacians of surfaces and solids, and their lowest eigenmodes.
#pragma once

#include <Eigen/SparseCore>
#include <span>

#include "base/exec.h"
#include "base/result.h"
#include "types/vec.h"

namespace sherd {

/// Linear finite elements: stiffness S (symmetric, positive semidefinite, also where angles are obtuse) and
/// lumped mass M, so that S φ = λ M φ is the Laplace eigenproblem with free (Neumann) borders.
struct Laplacian {
  Eigen::SparseMatrix<double> stiffness;
  Eigen::VectorXd mass;  ///< m² on a surface, m³ in a solid; positive
};

/// Cotangent Laplacian of a triangle surface; a third of each triangle's area per corner. Every vertex has to
/// belong to a triangle. Triangles flatter than 1e-10 (height over length) count as that flat.
/// `stretch`: per vertex, > 0, or empty for 1 everywhere: lengths count s times, with s the mean of an
/// element's corners. Areas are then s² as large, and stiffness is what it was.
Laplacian surfaceLaplacian(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           std::span<const double> stretch = {});
/// The same in a tetrahedral mesh. A tetrahedron that is inside out counts as its mirror image. Volumes are
/// s³ and stiffness is s times as large.
Laplacian solidLaplacian(std::span<const Vec3> positions, std::span<const Tetra> tets,
                         std::span<const double> stretch = {});

struct Modes {
  Eigen::VectorXd eigenvalues;  ///< ascending, 1/m²; the constant mode is left out
  Eigen::MatrixXd functions;  ///< vertices × modes, φᵀ M φ = 1; the entry of largest magnitude is positive
};

/// The `count` lowest modes (fewer where there are fewer vertices) of a connected Laplacian. Lanczos
/// iteration on the shift-inverted problem (Spectra; simplicial CHOLMOD, which calls no BLAS, so that bits
/// don't depend on its threads) from a fixed start vector; dense where the problem is small. Cost O(count ·
/// factor's size).
Result<Modes> lowestModes(const Laplacian& laplacian, int count, const Exec& exec);

}  // namespace sherd
