// How much each eigenmode counts in the distance: the spectral filter of a diffusion map.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "embed/part.h"
#include "embed/spectrum.h"

namespace sherd {

/// exp(−λ_k t) with t = `time` / λ_1 (Rustamov, Lipman and Funkhouser 2009): factors of the mode functions.
Eigen::VectorXd diffusionFilter(const Eigen::VectorXd& eigenvalues, double time);

struct FittedFilter {
  double positions = 0;   ///< factor of the nodes' own positions
  Eigen::VectorXd modes;  ///< factors of the modes, m · (unit of the mode functions)⁻¹
};

/// The factors ≥ 0 for which ‖x̄_i − x̄_j‖² = f_0² ‖X_i − X_j‖² + Σ_k f_k² (φ_k(i) − φ_k(j))² comes closest to
/// the squared lengths of paths through the part: least squares of these errors over the length, over pairs
/// of up to 64 landmarks (farthest-point sampling) with up to 2000 nodes, by non-negative coordinate descent.
/// Path lengths are divided by the median ratio to the straight distance over pairs 3 to 8 links apart (where
/// nothing is stretched), which takes out their zigzag. `functions`: nodes × modes. Cost O(landmarks · nodes
/// · (modes² + log nodes)).
Result<FittedFilter> fittedFilter(const BodyPart& part, const Eigen::MatrixXd& functions, const Exec& exec);

/// Coordinates, nodes × up to `most`, whose straight distances are close to the lengths of the same paths:
/// classical scaling of those between the landmarks, the other nodes placed by theirs to all landmarks
/// (landmark multidimensional scaling, de Silva and Tenenbaum 2004). Columns of ascending extent.
Result<Eigen::MatrixXd> pathCoordinates(const BodyPart& part, int most, const Exec& exec);

}  // namespace sherd
