#include "cvd/node_lanes.h"

#include <algorithm>
#include <cmath>

#include "base/clones.h"
#include "base/parallel.h"

namespace sherd {
namespace {

using Lanes __attribute__((vector_size(sizeof(LaneValues)), may_alias)) = float;

constexpr double kUlp = 0x1p-24;      // of float, relative, when rounding to nearest
constexpr float kUnderflow = 1e-36f;  // more than d · 2⁻¹⁴⁹ for d ≤ 10⁷ dimensions

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

NodeLanes::NodeLanes(const Eigen::MatrixXd& coordinates, double scale)
    : dimensions_(static_cast<std::size_t>(coordinates.rows())),
      blocks_((static_cast<std::size_t>(coordinates.cols()) + kNodeLanes - 1) / kNodeLanes),
      inverseScale_(scale > 0 && std::isfinite(1 / scale) ? 1 / scale : 1),
      origin_(middleOf(coordinates)),
      values_(std::make_unique_for_overwrite<LaneValues[]>(blocks_ * (dimensions_ + 1))) {
  const std::size_t grain = 1 + (std::size_t{1} << 11) / dimensions_;
  parallelFor(Exec{}, blocks_, grain, [&](std::size_t begin, std::size_t end) {
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

float NodeLanes::atMost(double length) const {
  return static_cast<float>(length * inverseScale_ * (1 - 4 * kUlp));
}

SHERD_CLONES unsigned compareLanes(const LaneValues* block, const LaneSite& site, std::size_t dimensions,
                                   const float* __restrict__ up, LaneValues& __restrict__ low,
                                   LaneValues& __restrict__ high) {
  const auto* x = reinterpret_cast<const Lanes*>(block);
  const float* p = site.minusTwice;
  Lanes sums[4] = {};  // four, so that one addition needn't wait for another
  std::size_t i = 0;
  for (; i + 4 <= dimensions; i += 4) {
    sums[0] += x[i] * p[i], sums[1] += x[i + 1] * p[i + 1];
    sums[2] += x[i + 2] * p[i + 2], sums[3] += x[i + 3] * p[i + 3];
  }
  for (; i < dimensions; ++i) sums[0] += x[i] * p[i];
  const Lanes norms = x[dimensions] + site.squaredNorm;
  const Lanes squares = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + norms;
  const Lanes error = norms * static_cast<float>(static_cast<double>(dimensions + 16) * kUlp) + kUnderflow;
  unsigned open = 0;
  for (std::size_t k = 0; k < kNodeLanes; ++k) {
    const float least = squares[k] - error[k], most = squares[k] + error[k];
    low.lane[k] = std::sqrt(least > 0 ? least : 0) * (1 - 0x1p-22f);
    high.lane[k] = std::sqrt(most) * (1 + 0x1p-22f);
    open |= static_cast<unsigned>(!(low.lane[k] > up[k])) << k;
  }
  return open;
}

SHERD_CLONES void keepBounds(const LaneValues& __restrict__ low, float drift, LaneValues& __restrict__ kept) {
  for (std::size_t k = 0; k < kNodeLanes; ++k) kept.lane[k] = (low.lane[k] + drift) * (1 - 0x1p-22f);
}

SHERD_CLONES void findOpenLanes(const LaneValues* __restrict__ bound, const float* __restrict__ drift,
                                std::size_t count, const float* __restrict__ up,
                                std::uint16_t* __restrict__ open) {
  for (std::size_t j = 0; j < count; ++j) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < kNodeLanes; ++k)
      bits |= static_cast<unsigned>(!(bound[j].lane[k] - drift[j] > up[k])) << k;
    open[j] = static_cast<std::uint16_t>(bits);
  }
}

SHERD_CLONES unsigned lanesWithLabel(const int* labels, int label) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < kNodeLanes; ++k) bits |= static_cast<unsigned>(labels[k] == label) << k;
  return bits;
}

}  // namespace sherd
