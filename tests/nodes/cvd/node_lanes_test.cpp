// Bounds of distances in single precision hold, and are close, for bodies of any size at any place.
#include "cvd/node_lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sherd {
namespace {

class Points {
 public:
  explicit Points(unsigned seed) : random_(seed) {}
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1; }
  Eigen::MatrixXd cloud(Eigen::Index dimensions, Eigen::Index count, double size, double shift) {
    Eigen::MatrixXd x(dimensions, count);
    for (double& value : x.reshaped()) value = size * (uniform() / 2 + shift);
    return x;
  }

 private:
  std::mt19937_64 random_;
};

long double distanceOf(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  long double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const long double d = static_cast<long double>(a[i]) - static_cast<long double>(b[i]);
    sum += d * d;
  }
  return std::sqrt(sum);
}

struct Compared {
  unsigned open;
  LaneValues low, high;
};

Compared compare(const NodeLanes& lanes, std::size_t block, const Eigen::VectorXd& site,
                 const LaneValues& up) {
  std::vector<float> minusTwice(static_cast<std::size_t>(site.size()));
  const float norm = lanes.convert(site.data(), minusTwice.data());
  Compared c;
  c.open =
      compareLanes(lanes.block(block), {minusTwice.data(), norm}, minusTwice.size(), up.lane, c.low, c.high);
  return c;
}

TEST(NodeLanes, BoundsHoldAndAreClose) {
  Points points(1);
  for (const Eigen::Index dimensions : {1, 3, 8, 74, 250})
    for (const double size : {1e-6, 1.0, 1e6})
      for (const double shift : {0.0, 1e3, 1e6}) {
        const Eigen::MatrixXd x = points.cloud(dimensions, 41, size, shift);
        const double diameter = size * std::sqrt(static_cast<double>(dimensions));
        const NodeLanes lanes(x, diameter);
        ASSERT_EQ(lanes.blockCount(), 3u);
        for (Eigen::Index j = 0; j < 41; j += 5) {
          Eigen::VectorXd site = x.col(j);
          if (j % 2 == 1) site *= 1 + 1e-3;
          for (Eigen::Index n = 0; n < 41; ++n) {
            const auto lane = static_cast<std::size_t>(n) % kNodeLanes;
            const auto distance = distanceOf(x.col(n), site) / static_cast<long double>(diameter);
            LaneValues up;
            std::fill_n(up.lane, kNodeLanes, static_cast<float>(distance * 0.999L));
            const Compared c = compare(lanes, static_cast<std::size_t>(n) / kNodeLanes, site, up);
            ASSERT_LE(c.low.lane[lane], distance) << dimensions << " " << size << " " << shift;
            ASSERT_GE(c.high.lane[lane], distance) << dimensions << " " << size << " " << shift;
            if (distance > 0.1L && distance < 10) {
              EXPECT_LT(c.high.lane[lane] - c.low.lane[lane], 3e-4f);
            }
            // Nodes nearer than `up` are always open; where bounds are close, others aren't.
            EXPECT_EQ(c.open >> lane & 1u, c.low.lane[lane] > up.lane[lane] ? 0u : 1u);
            if (distance > 0.3L && distance < 10) {
              EXPECT_EQ(c.open >> lane & 1u, 0u);
            }
          }
        }
      }
}

TEST(NodeLanes, WhatOverflowsStaysOpen) {
  Points points(2);
  const Eigen::MatrixXd x = points.cloud(3, 16, 1, 0);
  LaneValues up;
  std::fill_n(up.lane, kNodeLanes, 1e30f);
  // A site so far off that its square is infinite may be farther than anything, but isn't known to be nearer.
  for (const double place : {1e30, 1e40}) {  // finite as float, and not
    const Compared far = compare(NodeLanes(x, 1), 0, Eigen::Vector3d(place, 0, 0), up);
    EXPECT_EQ(far.open, 0xffffu);
    for (std::size_t k = 0; k < kNodeLanes; ++k) {
      EXPECT_EQ(far.low.lane[k], 0.0f);
      EXPECT_EQ(far.high.lane[k], std::numeric_limits<float>::infinity());
    }
  }
  // A scale far below the body's size: nothing is known.
  const Compared tiny = compare(NodeLanes(x, 1e-25), 0, x.col(0), up);
  EXPECT_EQ(tiny.open, 0xffffu);
  // None, where it isn't positive: as with 1.
  const Compared none = compare(NodeLanes(x, 0), 0, x.col(0), up),
                 one = compare(NodeLanes(x, 1), 0, x.col(0), up);
  for (std::size_t k = 0; k < kNodeLanes; ++k) EXPECT_EQ(none.low.lane[k], one.low.lane[k]);
}

TEST(NodeLanes, LengthsAreNoLess) {
  const NodeLanes lanes(Eigen::MatrixXd::Random(2, 5), 3);
  for (const double length : {0.0, 1e-30, 0.1, 1.0, 7.7, 1e20}) {
    EXPECT_GE(static_cast<double>(lanes.atLeast(length)), length / 3 * (1 - 1e-15));
    EXPECT_NEAR(static_cast<double>(lanes.atLeast(length)), length / 3, 1e-6 * length);
  }
}

TEST(NodeLanes, KeptBoundsSurviveRounding) {
  Points points(3);
  for (int round = 0; round < 2000; ++round) {
    LaneValues low, kept, up;
    const float drift = static_cast<float>(std::ldexp(1 + points.uniform(), round % 40 - 20));
    for (std::size_t k = 0; k < kNodeLanes; ++k) low.lane[k] = static_cast<float>(1 + points.uniform());
    keepBounds(low, drift, kept);
    up = low;
    std::uint16_t open = 0;
    findOpenLanes(&kept, &drift, 1, up.lane, &open);
    EXPECT_EQ(open, 0xffffu);  // the site may be as near as that
    for (float& value : up.lane) value *= 1 - 0x1p-3f;
    for (float& value : up.lane) value -= 1e-6f * drift;
    findOpenLanes(&kept, &drift, 1, up.lane, &open);
    for (std::size_t k = 0; k < kNodeLanes; ++k)
      if (low.lane[k] > 1e-4f * drift) {
        EXPECT_EQ(open >> k & 1, 0);
      }
  }
}

}  // namespace
}  // namespace sherd
