#include "cvd/node_lanes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace sherd {
namespace {

constexpr double kUlp = 0x1p-24;  // of float, relative, when rounding to nearest

/// The mean of some of the points: near the middle, so that floats have bits to spare.
std::vector<double> middleOf(const Eigen::MatrixXd& points) {
  constexpr Eigen::Index wanted = 32;
  const Eigen::Index every = std::max<Eigen::Index>(1, points.cols() / wanted);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(points.rows());
  double taken = 0;
  for (Eigen::Index n = 0; n < points.cols(); n += every, ++taken) sum += points.col(n);
  sum /= taken;
  return {sum.data(), sum.data() + sum.size()};
}

}  // namespace

NodeLanes::NodeLanes(const Eigen::MatrixXd& coordinates, double scale, const Exec& exec)
    : dimensions_(static_cast<std::size_t>(coordinates.rows())),
      blocks_((static_cast<std::size_t>(coordinates.cols()) + kNodeLanes - 1) / kNodeLanes),
      inverseScale_(scale > 0 && std::isfinite(1 / scale) ? 1 / scale : 1),
      origin_(middleOf(coordinates)),
      values_(std::make_unique_for_overwrite<LaneValues[]>(blocks_ * (dimensions_ + 1))) {
  const std::size_t grain = 1 + (std::size_t{1} << 11) / dimensions_;
  parallelFor(exec, blocks_, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) convertBlock(coordinates, b);
  });
}

void NodeLanes::convertBlock(const Eigen::MatrixXd& coordinates, std::size_t b) {
  const double* x[kNodeLanes];  // the last node stands in for those that a last block lacks
  for (std::size_t k = 0; k < kNodeLanes; ++k)
    x[k] = coordinates.data() +
           std::min(b * kNodeLanes + k, static_cast<std::size_t>(coordinates.cols()) - 1) * dimensions_;
  LaneValues* out = values_.get() + b * (dimensions_ + 1);
  double norm2[kNodeLanes] = {};
  for (std::size_t i = 0; i < dimensions_; ++i, ++out)
    for (std::size_t k = 0; k < kNodeLanes; ++k) {
      const double y = (x[k][i] - origin_[i]) * inverseScale_;
      norm2[k] += y * y;
      out->lane[k] = static_cast<float>(y);
    }
  for (std::size_t k = 0; k < kNodeLanes; ++k) out->lane[k] = static_cast<float>(norm2[k]);
}

float NodeLanes::convert(const double* position, float* minusTwice) const {
  double norm2 = 0;
  for (std::size_t i = 0; i < dimensions_; ++i) {
    const double y = (position[i] - origin_[i]) * inverseScale_;
    norm2 += y * y;
    minusTwice[i] = -2 * static_cast<float>(y);
  }
  return static_cast<float>(norm2);
}

float NodeLanes::atLeast(double length) const {
  return static_cast<float>(length * inverseScale_ * (1 + 4 * kUlp));
}

}  // namespace sherd
