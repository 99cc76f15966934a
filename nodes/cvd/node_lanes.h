// The coordinates of nodes as cvd/lane_bounds.h takes them, in blocks of sixteen.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "base/exec.h"
#include "cvd/lane_bounds.h"

namespace sherd {

/// Coordinates relative to about their middle, over a scale, as floats: block b holds nodes 16 b to 16 b +
/// 15, component by component, and behind these the squares of their norms. All distances below are over the
/// scale.
class NodeLanes {
 public:
  /// d × n coordinates, finite, n ≥ 1; scale: about the size of the cloud (1 is taken where it isn't
  /// positive).
  NodeLanes(const Eigen::MatrixXd& coordinates, double scale, const Exec& exec = {});

  std::size_t blockCount() const { return blocks_; }
  /// `dimensions` + 1 of them.
  const LaneValues* block(std::size_t b) const { return values_.get() + b * (dimensions_ + 1); }
  /// Writes LaneSite::minusTwice, `dimensions` numbers; returns LaneSite::squaredNorm.
  float convert(const double* position, float* minusTwice) const;
  /// A length over the scale, and no less.
  float atLeast(double length) const;

 private:
  void convertBlock(const Eigen::MatrixXd& coordinates, std::size_t b);

  std::size_t dimensions_, blocks_;
  double inverseScale_;
  std::vector<double> origin_;
  std::unique_ptr<LaneValues[]> values_;
};

}  // namespace sherd
