// Signed distance of a closed surface on a narrow band of voxels (OpenVDB, hidden here).
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "base/exec.h"
#include "types/vec.h"

namespace sherd {

/// Distances come from openvdb::tools::meshToVolume, without sign. The sign is the winding number along
/// columns of voxels, so that voids, components and nested shells get theirs without flood filling, for any
/// thread count.
class LevelSet {
 public:
  /// Positions and sizes in one unit of length. `band`: how far from the surface distances are kept.
  /// When cancelled, what was made is unfit for use: check exec.cancelled() afterwards.
  LevelSet(std::span<const Vec3> positions, std::span<const Triangle> triangles, double voxel, double band,
           const Exec& exec);
  ~LevelSet();
  LevelSet(LevelSet&&) noexcept;

  double voxel() const { return voxel_; }
  double band() const { return band_; }
  /// Calls visit(i, j, k) for every voxel within the band, in an order that depends on the surface alone. The
  /// centre of voxel (i, j, k) is voxel() · (i, j, k).
  void visitBand(const std::function<void(int, int, int)>& visit) const;
  /// A function (i, j, k) → distance at that voxel's centre. As with sampler(), one per thread.
  std::function<double(int, int, int)> values() const;
  /// A function x → distance (trilinear, negative inside), ±band beyond the band. Each has a cache of its
  /// own: one per thread; must not outlive the LevelSet.
  std::function<double(const Vec3&)> sampler() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  double voxel_, band_;
};

}  // namespace sherd
