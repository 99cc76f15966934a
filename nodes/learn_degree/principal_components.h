// Principal components of a few long rows of numbers (learn_degree.h).
#pragma once

#include <Eigen/Core>

#include "base/exec.h"
#include "base/result.h"

namespace sherd {

/// More examples than this give their directions by an even choice of so many.
inline constexpr Eigen::Index kMostExamples = 512;

struct PrincipalComponents {
  Eigen::VectorXd mean;   ///< of all examples
  Eigen::MatrixXd basis;  ///< components × features: orthonormal rows, largest variance first
  double total = 0;       ///< ‖X‖_F of the centred examples that gave the basis
  double residual = 0;    ///< ‖X − X_k‖_F that the basis leaves of it
};

/// `examples`: features × examples, finite. Components until residual ≤ tolerance · total, and no more than
/// the examples' rank to rounding; at least one row, of zeros where all examples are equal. In each row the
/// entry of the largest magnitude is positive. Errors: no example; a number that is not finite, with the
/// example's number from 1; cancelled. Cost: O(features · e² + e³), e = min(examples, 512).
Result<PrincipalComponents> principalComponents(const Eigen::MatrixXd& examples, double tolerance,
                                                const Exec& exec);

/// `count` of [0, of) evenly chosen, ascending; all where there are no more.
std::vector<Eigen::Index> evenlyChosen(Eigen::Index of, Eigen::Index count);

}  // namespace sherd
