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

/// A site as blocks are compared with it: its components times −2, and the square of their norm.
struct LaneSite {
  const float* minusTwice;
  float squaredNorm;
};

/// Coordinates relative to about their middle, over a scale, as floats: block b holds nodes 16 b to 16 b +
/// 15, component by component, and behind these the squares of their norms. All distances below are over the
/// scale.
class NodeLanes {
 public:
  /// d × n coordinates, finite, n ≥ 1; scale: about the size of the cloud (1 is taken where it isn't
  /// positive).
  NodeLanes(const Eigen::MatrixXd& coordinates, double scale);

  std::size_t blockCount() const { return blocks_; }
  /// `dimensions` + 1 of them.
  const LaneValues* block(std::size_t b) const { return values_.get() + b * (dimensions_ + 1); }
  /// Writes LaneSite::minusTwice, `dimensions` numbers; returns LaneSite::squaredNorm.
  float convert(const double* position, float* minusTwice) const;
  /// A length over the scale, and no less, or no more.
  float atLeast(double length) const;
  float atMost(double length) const;

 private:
  void convertBlock(const Eigen::MatrixXd& coordinates, std::size_t b);

  std::size_t dimensions_, blocks_;
  double inverseScale_;
  std::vector<double> origin_;
  std::unique_ptr<LaneValues[]> values_;
};

/// low ≤ ‖x_n − p‖ ≤ high for the nodes of a block, from ‖x‖² + ‖p‖² − 2 x·p, whose error is at most
/// (d + 16) 2⁻²⁴ (‖x‖² + ‖p‖²). Returns a bit for each lane of which low > up isn't known: that of a node
/// which the site may be nearer to than `up`. Where numbers overflow, that is all of them. Same bits on all
/// processors, as below.
unsigned compareLanes(const LaneValues* block, const LaneSite& site, std::size_t dimensions, const float* up,
                      LaneValues& low, LaneValues& high);

/// kept: a little less than low + drift, so that rounding leaves kept − drift ≤ low.
void keepBounds(const LaneValues& low, float drift, LaneValues& kept);

/// For each of `count` sites the bits of the lanes of which bound − drift > up isn't known.
void findOpenLanes(const LaneValues* bound, const float* drift, std::size_t count, const float* up,
                   std::uint16_t* open);

/// The lanes, of sixteen, that have this label.
unsigned lanesWithLabel(const int* labels, int label);

}  // namespace sherd
