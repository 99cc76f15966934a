#include "cvd/node_lanes.h"

#include <algorithm>
#include <cmath>

#include "base/clones.h"

namespace sherd {
namespace {

using Lanes __attribute__((vector_size(sizeof(LaneValues)), may_alias)) = float;

constexpr double kUlp = 0x1p-24;      // of float, relative, when rounding to nearest
constexpr double kUnderflow = 1e-17;  // √(d · 2⁻¹⁴⁹) and less for d ≤ 10⁷ dimensions

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
      // Differences, squares and their sum are off by dimensions + 3 roundings of the square at most.
      relativeError_(static_cast<float>(static_cast<double>(dimensions_ + 8) * kUlp)),
      origin_(middleOf(coordinates)),
      values_(std::make_unique_for_overwrite<LaneValues[]>(blocks_ * dimensions_)) {
  const auto nodes = static_cast<std::size_t>(coordinates.cols());
  double farthest2 = 0;
  for (std::size_t b = 0; b < blocks_; ++b) {
    const double* x[kNodeLanes];  // the last node stands in for those that a last block lacks
    for (std::size_t k = 0; k < kNodeLanes; ++k)
      x[k] = coordinates.data() + std::min(b * kNodeLanes + k, nodes - 1) * dimensions_;
    double norm2[kNodeLanes] = {};
    for (std::size_t i = 0; i < dimensions_; ++i) {
      LaneValues& out = values_[b * dimensions_ + i];
      for (std::size_t k = 0; k < kNodeLanes; ++k) {
        const double y = (x[k][i] - origin_[i]) * inverseScale_;
        norm2[k] += y * y;
        out.lane[k] = static_cast<float>(y);
      }
    }
    for (const double n2 : norm2) farthest2 = std::max(farthest2, n2);
  }
  radius_ = std::sqrt(farthest2);
}

float NodeLanes::convert(const double* position, float* out) const {
  double norm2 = 0;
  for (std::size_t i = 0; i < dimensions_; ++i) {
    const double y = (position[i] - origin_[i]) * inverseScale_;
    norm2 += y * y;
    out[i] = static_cast<float>(y);
  }
  // Twice what rounding both points to floats moves them by, for the arithmetic of the bounds themselves.
  return static_cast<float>(4 * kUlp * (radius_ + std::sqrt(norm2)) + kUnderflow);
}

float NodeLanes::atLeast(double length) const {
  return static_cast<float>(length * inverseScale_ * (1 + 4 * kUlp));
}

float NodeLanes::atMost(double length) const {
  return static_cast<float>(length * inverseScale_ * (1 - 4 * kUlp));
}

SHERD_CLONES unsigned compareLanes(const LaneValues* block, const float* site, std::size_t dimensions,
                                   const LaneError& error, const float* __restrict__ up,
                                   LaneValues& __restrict__ low, LaneValues& __restrict__ high) {
  const auto* x = reinterpret_cast<const Lanes*>(block);
  Lanes sums[4] = {};  // four, so that one addition needn't wait for another
  std::size_t i = 0;
  for (; i + 4 <= dimensions; i += 4) {
    const Lanes a = x[i] - site[i], b = x[i + 1] - site[i + 1], c = x[i + 2] - site[i + 2],
                d = x[i + 3] - site[i + 3];
    sums[0] += a * a, sums[1] += b * b, sums[2] += c * c, sums[3] += d * d;
  }
  for (; i < dimensions; ++i) {
    const Lanes a = x[i] - site[i];
    sums[0] += a * a;
  }
  const Lanes squares = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  const float less = 1 - error.relative, more = 1 + error.relative, off = error.absolute;
  unsigned open = 0;
  for (std::size_t k = 0; k < kNodeLanes; ++k) {
    const float distance = std::sqrt(squares[k]);
    low.lane[k] = distance * less - off;
    high.lane[k] = distance * more + off;
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
