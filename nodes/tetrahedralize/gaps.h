// Where a surface faces another part of itself across empty space, how far, and how long the way round is.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/exec.h"
#include "tetrahedralize/shells.h"
#include "types/vec.h"

namespace sherd {

/// One look across a gap, from a point of the surface along its outward normal to the next surface.
struct Gap {
  Vec3 from, to;
  double width;   ///< |to − from|
  double detour;  ///< length of the way along the surface; infinite between shells and beyond `farthest`
  Vec3 middle() const { return 0.5 * (from + to); }
};

struct GapSearch {
  double spacing;         ///< of the points looked from, and size of the patches in which ways are measured
  double widest;          ///< wider gaps are left out
  double farthest;        ///< ways longer than this count as infinite
  bool touching = false;  ///< parts of the surface touch: ways lead through the places where they do
};

/// All gaps seen. Only surfaces that face each other count (the angle of their normals exceeds 120°): a
/// concave corner has no gap to keep open. Positions and lengths in one unit. Cost O(points looked from · log
/// triangles).
std::vector<Gap> findGaps(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          const GapSearch& search, const Exec& exec);

struct BodyGaps {
  std::vector<Gap> gaps;   ///< all with an infinite detour
  bool isTooMany = false;  ///< looking ended before all were found
  std::optional<Gap> narrowest;
};

/// Gaps between bodies (shells of positive volume) no wider than `widest`, from points of one to the nearest
/// of the other, so densely that each stands for a patch of the surface half as wide as the gap. Bodies
/// nearer than `touching` count as touching: there is no gap between them. Ends when there are more than
/// `most`: as many patches, then, would take as many edges of the cage. Cost O(n log n) for each pair of
/// bodies that near.
BodyGaps gapsBetweenBodies(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           const std::vector<Shell>& shells, double touching, double widest, std::size_t most,
                           const Exec& exec);

}  // namespace sherd
