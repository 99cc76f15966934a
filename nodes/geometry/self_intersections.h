// Where a triangle surface meets itself other than along shared corners and edges. Exact on the given
// doubles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/exec.h"
#include "types/vec.h"

namespace sherd {

struct SelfIntersections {
  std::size_t pairs = 0;               ///< of triangles; a lower bound where `more`
  std::array<Index, 2> first{-1, -1};  ///< the pair whose lower triangle comes first
  bool more = false;                   ///< counting was cut short
};

/// Counts the pairs of triangles that have a point in common which is not on a corner or an edge that they
/// share: crossing, overlapping in a plane, and merely touching ones. Pairs of the same three corners are
/// left to inspectSurface(), flat triangles to zeroAreaTriangles(). Counting stops at `limit` pairs per block
/// of triangles, so that a surface that is doubled all over costs no quadratic time. Finite positions, three
/// different corners. Cost O(n log n) on usual surfaces, in parallel; the result does not depend on the
/// number of threads. When exec is cancelled, it means nothing.
SelfIntersections findSelfIntersections(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                        const Exec& exec, std::size_t limit = 100);

/// The pairs themselves, each ascending, in ascending order; pairs of the same three corners are not among
/// them. `limit` as above, so that the list ends early where there are very many: `more` tells.
struct IntersectingPairs {
  std::vector<std::array<Index, 2>> pairs;
  bool more = false;
};
IntersectingPairs intersectingPairs(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                    const Exec& exec, std::size_t limit);

/// Do triangles s and t meet so? Neither has zero area.
bool trianglesMeet(std::span<const Vec3> positions, const Triangle& s, const Triangle& t);

/// Triangles whose corners lie on one line, ascending.
std::vector<Index> zeroAreaTriangles(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace sherd
