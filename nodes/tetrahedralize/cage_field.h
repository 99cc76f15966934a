// The implicit volume that becomes the cage: {x : d(x) < r(x)}, and how finely it is meshed.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/exec.h"
#include "geometry/level_set.h"
#include "geometry/surface_tree.h"
#include "tetrahedralize/gaps.h"
#include "tetrahedralize/graded_minimum.h"
#include "tetrahedralize/shells.h"
#include "tetrahedralize/volume_mesher.h"

namespace sherd {

/// The input surface, centred, its bounding box's diagonal 1.
struct UnitSurface {
  std::vector<Vec3> positions;  ///< rounded to 2⁻²⁴: the same for the same object in another unit
  std::vector<Triangle> triangles;
  std::vector<Shell> shells;  ///< volumes in the unit box's measure
  Vec3 centre;                ///< m
  double size;                ///< m, that 1 stands for
  double volume, area;

  Vec3 toMetres(const Vec3& p) const { return size * p + centre; }
};

/// Offset of the cage in edge lengths: large enough for flat facets to stay outside of curved surfaces, small
/// enough for the cage's volume to be near the surface's.
constexpr double kOffsetShare = 0.25;
/// Edge length at a gap in widths of it: leaves half of it open.
constexpr double kEdgeOfGap = 1;

struct CageSizes {
  double edgeLength;                       ///< where nothing asks for less
  double closeness = 1;                    ///< factor of all offsets, at most 1: smaller ones cost tetrahedra
  std::vector<Gap> open;                   ///< gaps to be kept open
  std::vector<GradedMinimum::Spot> finer;  ///< places to be meshed more finely, with edge lengths
};

class CageField {
 public:
  /// Takes over `levelSet` where it is fine and wide enough for the sizes, else makes a new one in its place.
  /// This, expectedTets() and volume() are cut short when cancelled, and their results then unfit for use:
  /// check exec.cancelled() afterwards.
  CageField(const UnitSurface& surface, const SurfaceTree& tree, CageSizes sizes,
            std::shared_ptr<const LevelSet>& levelSet, const Exec& exec);

  double offset(const Vec3& x) const { return offsetShare_ * gapEdge_(x); }
  double edgeLength(const Vec3& x) const { return std::min(gapEdge_(x), finer_(x)); }
  /// d(x) − r(x), exact in sign near narrow gaps and to a fraction of the offset elsewhere. One thread at a
  /// time.
  double operator()(const Vec3& x) const;
  /// Tetrahedra that meshing will take, roughly.
  double expectedTets() const;
  /// What Mesh_3 is given. Refers to this.
  VolumeToMesh volume() const;

 private:
  /// Points of the level set, spread over every shell: where Mesh_3 starts from. None of its own random ones.
  std::vector<Vec3> seeds() const;
  std::optional<Vec3> onLevelSet(const Vec3& p, const Vec3& normal) const;

  const UnitSurface& surface_;
  const SurfaceTree& tree_;
  const Exec& exec_;
  CageSizes sizes_;
  double offsetShare_;
  GradedMinimum gapEdge_, finer_;
  std::shared_ptr<const LevelSet> levelSet_;
  std::function<double(const Vec3&)> distance_;
};

}  // namespace sherd
