// A grid while it is being painted: its voxels' places in the program's space, and edits block by block. For
// this folder alone, since it shows OpenVDB.
#pragma once

#include <openvdb/openvdb.h>

#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/scalar_grid_vdb.h"

namespace sherd {

/// Index space to metres and back; the transform has to be linear.
class Lattice {
 public:
  Lattice(const openvdb::math::Transform& transform, const FileFrame& frame);
  Vec3 metres(const openvdb::Coord& c) const { return origin_ + axes_ * Vec3(c.x(), c.y(), c.z()); }
  Vec3 index(const Vec3& metres) const { return inverse_ * (metres - origin_); }
  /// Metres along the index axes from one voxel to the next.
  double step(int axis) const { return axes_.col(axis).norm(); }
  double longestStep() const { return std::max({step(0), step(1), step(2)}); }
  /// Half a block's diagonal, m: the farthest of its voxels' centres from the middle.
  double blockRadius() const { return blockRadius_; }
  Vec3 blockCentre(const openvdb::Coord& origin) const {
    return origin_ + axes_ * (Vec3(origin.x(), origin.y(), origin.z()) + Vec3::Constant(3.5));
  }
  /// The box in index space around one in metres.
  Box indexBox(const Box& metres) const;
  /// Around the centres of a block's voxels, m.
  Box blockBox(const openvdb::Coord& origin) const;

 private:
  Vec3 origin_ = Vec3::Zero();
  Mat3 axes_ = Mat3::Identity(), inverse_ = Mat3::Identity();
  double blockRadius_ = 0;
};

/// Origins of blocks of 8³ voxels, in order, each once.
class Blocks {
 public:
  static constexpr std::size_t kMost = 1u << 20;

  /// All that the voxels of index space in [low, high] lie in. Does nothing once there are too many.
  void add(const Vec3& low, const Vec3& high,
           const std::function<bool(const openvdb::Coord&)>& isWanted = {});
  /// Those of all active voxels, grown by `margin` voxels.
  void addActive(const openvdb::FloatTree& tree, const openvdb::Coord& margin = openvdb::Coord(0));
  bool tooMany() const { return tooMany_; }
  std::vector<openvdb::Coord> list() const { return {origins_.begin(), origins_.end()}; }

 private:
  std::set<openvdb::Coord> origins_;
  bool tooMany_ = false;
};

/// Calls visit(box) for each active block of 8³ voxels, and for each larger active tile.
void visitActive(const openvdb::FloatTree& tree, const std::function<void(const openvdb::CoordBBox&)>& visit);

struct Canvas {
  using Leaf = openvdb::FloatTree::LeafNodeType;

  openvdb::FloatGrid::Ptr grid;
  FileFrame frame;

  float background() const { return grid->background(); }
  Lattice lattice() const { return {grid->transform(), frame}; }
  /// edit(voxel, its value now, whether it is active) gives the value that it is to have and be active with;
  /// nothing leaves it as it is.
  using Edit = std::function<std::optional<double>(const openvdb::Coord&, double, bool)>;
  /// Calls makeEdit(block) once for each block, and what it returns for each voxel; blocks in parallel.
  Result<void> edit(const Blocks& blocks, const std::function<Edit(const openvdb::Coord&)>& makeEdit,
                    const Exec& exec);
  /// Every value, also the background, becomes map(value).
  void map(const std::function<double(double)>& map);
};

/// "painting … takes too many voxels" with the edge that they have.
Error tooManyVoxels(const Lattice& lattice);

}  // namespace sherd
