// Coordinates whose straight distances come closest to the lengths of ways inside: a bent body, straightened.
#pragma once

#include <Eigen/Core>

#include "base/exec.h"
#include "base/result.h"
#include "embed/part.h"

namespace sherd {

/// x̄_n = A ψ_n, d × nodes, with ψ_n = (X_n, φ_1(n), …, φ_K(n)): linear in the positions and the smooth modes,
/// so that neither the zigzag of single paths nor the choice of landmarks shows. A minimises
///
///   Σ_m Σ_n w_mn (‖A (ψ_n − ψ_m)‖ − l_mn)²,   w_mn = l_mn⁻²,
///
/// over landmarks m and up to 2000 nodes n (l: landmarks.h), by majorization (SMACOF: de Leeuw 1977; Borg and
/// Groenen, "Modern Multidimensional Scaling") from the landmarks' classical scaling (de Silva and Tenenbaum
/// 2004), until it falls by less than a thousandth in a step. d is at most 8, and fewer where the classical
/// scaling has fewer dimensions that count. Rows are the principal axes, the longest first. `functions`:
/// nodes × modes. Errors: there are no lengths to fit, as in a part of one place; cancelled. Cost O(landmarks
/// · links · log nodes), and per step O(landmarks · partners · K).
Result<Eigen::MatrixXd> unfolded(const BodyPart& part, const Eigen::MatrixXd& functions, const Exec& exec);

/// Coordinates, up to `most` × nodes, from the lengths alone: classical scaling of those between the
/// landmarks, the other nodes placed by theirs to all landmarks (de Silva and Tenenbaum 2004). Rows of
/// descending extent. They hold what smooth functions do not show, as how far it is across a narrow band of
/// stretched lengths, and the zigzag of paths. Errors: there are no lengths; cancelled.
Result<Eigen::MatrixXd> pathCoordinates(const BodyPart& part, int most, const Exec& exec);

}  // namespace sherd
