// A coarse graph of a surface for lengths of ways along it.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// The surface with every edge longer than `longest` split in halves, again and again; stays closed.
struct RefinedSurface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};
RefinedSurface refineLongEdges(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                               double longest);

/// Triangles are gathered into connected patches of a given size; a way along the surface is measured over
/// the centres of patches, and errs by about the size of one. Triangles should be smaller than that.
class SurfacePatches {
 public:
  /// `touching`: parts of the surface meet in vertices at one place, or nearer than kTouching (contacts.h),
  /// and ways lead through there.
  SurfacePatches(std::span<const Vec3> positions, std::span<const Triangle> triangles, double size,
                 bool touching = false);

  /// Length of the way from triangle s to triangle t; infinite if there is none or it is longer than
  /// `farthest` (the same in all calls). Remembers what it found from the patch of s.
  double distance(Index s, Index t, double farthest);

 private:
  struct Link {
    Index patch;
    double length;
  };
  using Distances = std::unordered_map<Index, double>;
  Distances distancesFrom(Index patch, double farthest) const;

  std::vector<Index> patchOf_;  ///< per triangle
  std::vector<Vec3> centre_;    ///< per patch
  std::vector<std::vector<Link>> links_;
  std::unordered_map<Index, Distances> found_;
};

}  // namespace sherd
