// Where parts of a surface touch, or as good as.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// Of the surface's diagonal. Repair draws solids that touch apart by half of this: no cage could keep such a
/// gap open, and bodies that touch are one cage.
constexpr double kTouching = 2e-6;

/// Pairs of points no farther than `distance` > 0 from each other, each ascending, in ascending order. Cost
/// O(n log n) unless many points lie within 16 distances of each other.
std::vector<std::pair<Index, Index>> nearPairs(std::span<const Vec3> points, double distance);

/// How often parts of the surface touch in a point or along an edge, each with vertices of its own there:
/// vertices no farther than `distance` from another that they don't hang together with along edges as short.
/// Whatever encloses the surface joins them there.
std::size_t countContacts(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          double distance);

}  // namespace sherd
