// Distances of sixteen nodes from a site at once, in single precision and with their error: enough to tell
// nearly always which of two sites is nearer. What it can't tell is left to cvd/distance.h.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace sherd {

inline constexpr std::size_t kNodeLanes = 16;

/// One number of each of sixteen nodes.
struct alignas(4 * kNodeLanes) LaneValues {
  float lane[kNodeLanes];
};

/// Coordinates relative to about their middle, over a scale, as floats: block b holds nodes 16 b to 16 b +
/// 15, component by component. All distances below are over the scale.
class NodeLanes {
 public:
  /// d × n coordinates, finite, n ≥ 1; scale: about the size of the cloud (1 is taken where it isn't
  /// positive).
  NodeLanes(const Eigen::MatrixXd& coordinates, double scale);

  std::size_t blockCount() const { return blocks_; }
  /// `dimensions` of them.
  const LaneValues* block(std::size_t b) const { return values_.get() + b * dimensions_; }
  /// Writes a site's components; returns how far a distance of it may be off beside relativeError().
  float convert(const double* position, float* out) const;
  /// A length over the scale, and no less.
  float atLeast(double length) const;
  float atMost(double length) const;
  float relativeError() const { return relativeError_; }

 private:
  std::size_t dimensions_, blocks_;
  double inverseScale_, radius_ = 0;  ///< radius_: of all nodes around the origin, over the scale
  float relativeError_;
  std::vector<double> origin_;
  std::unique_ptr<LaneValues[]> values_;
};

/// How far a distance between floats may be from that of the points that they stand for.
struct LaneError {
  float relative, absolute;
};

/// low ≤ ‖x_n − p‖ ≤ high for the nodes of a block (not below 0). Returns a bit for each lane of which
/// low > up isn't known: that of a node which the site may be nearer to than `up`. Where numbers overflow,
/// that is all of them. Same bits on all processors, as below.
unsigned compareLanes(const LaneValues* block, const float* site, std::size_t dimensions,
                      const LaneError& error, const float* up, LaneValues& low, LaneValues& high);

/// kept: a little less than low + drift, so that rounding leaves kept − drift ≤ low.
void keepBounds(const LaneValues& low, float drift, LaneValues& kept);

/// For each of `count` sites the bits of the lanes of which bound − drift > up isn't known.
void findOpenLanes(const LaneValues* bound, const float* drift, std::size_t count, const float* up,
                   std::uint16_t* open);

/// The lanes, of sixteen, that have this label.
unsigned lanesWithLabel(const int* labels, int label);

}  // namespace sherd
