// Bounds of the distances of sixteen nodes from a site at once, in single precision: enough to tell nearly
// always which of two sites is nearer. What they can't tell is left to cvd/distance.h. Variants for wider
// registers are chosen at run time; all have the same bits (base/clones.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace sherd {

inline constexpr std::size_t kNodeLanes = 16;

/// Bounds times these stay bounds: more than what a sum, a product or a root is rounded by.
inline constexpr float kBoundUp = 1 + 0x1p-22f, kBoundDown = 1 - 0x1p-22f;

/// One number of each of sixteen nodes.
struct alignas(4 * kNodeLanes) LaneValues {
  float lane[kNodeLanes];
};

/// A site as blocks are compared with it: its components times −2, and the square of their norm.
struct LaneSite {
  const float* minusTwice;
  float squaredNorm;
};

/// 0 ≤ low ≤ ‖x_n − p‖ ≤ high, never NaN, for the nodes of a block, from ‖x‖² + ‖p‖² − 2 x·p, whose error is
/// at most (d + 16) 2⁻²⁴ (‖x‖² + ‖p‖²). Returns a bit for each lane of which low > up isn't known: that of a
/// node which the site may be nearer to than `up`. Where numbers overflow, that is all of them.
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
