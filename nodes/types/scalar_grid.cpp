#include <openvdb/tools/Interpolation.h>

#include <mutex>
#include <sstream>

#include "base/parallel.h"
#include "types/scalar_grid_vdb.h"
#include "types/value_bytes.h"

namespace sherd {
namespace {

using openvdb::FloatGrid;
using openvdb::FloatTree;

/// Leaves as whole blocks (their inactive voxels hold the background), then tiles; both in the tree's own
/// order, which is that of their coordinates.
void hashVoxels(Hasher& hasher, const FloatTree& tree) {
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    const openvdb::Coord origin = leaf->origin();
    hasher.add(origin.x()).add(origin.y()).add(origin.z());
    hasher.bytes(&leaf->getValueMask(), sizeof leaf->getValueMask());
    hasher.bytes(leaf->buffer().data(), FloatTree::LeafNodeType::SIZE * sizeof(float));
  }
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    hasher.add(box.min().x()).add(box.min().y()).add(box.min().z()).add(box.max().x());
    const float value = *tile;
    hasher.bytes(&value, sizeof value);
  }
}

/// True when no active voxel differs from the background.
bool onlyBackground(const FloatGrid& grid) {
  for (auto value = grid.cbeginValueOn(); value; ++value)
    if (*value != grid.background()) return false;
  return true;
}

}  // namespace

Digest contentOf(const ScalarGrid::Impl& impl) {
  Hasher hasher;
  hasher.add(impl.name);
  hashBits(hasher, impl.frame);
  hashBits(hasher, impl.constant);
  hasher.add(impl.grid != nullptr);
  if (impl.grid == nullptr) return hasher.digest();
  std::ostringstream frame;
  impl.grid->transform().write(frame);
  impl.grid->writeMeta(frame);
  const float background = impl.grid->background();
  hasher.add(frame.str()).bytes(&background, sizeof background);
  hashVoxels(hasher, impl.grid->tree());
  return hasher.digest();
}

void initializeOpenVdb() {
  // initialize() is guarded by itself, but not against exceptions of two threads at once.
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

ScalarGrid ScalarGrid::constant(double value) {
  auto impl = std::make_shared<Impl>();
  impl->constant = value;
  impl->content = contentOf(*impl);
  return ScalarGrid(std::move(impl));
}

ScalarGrid scalarGridOf(FloatGrid::Ptr grid, std::string name, const FileFrame& frame) {
  auto impl = std::make_shared<ScalarGrid::Impl>();
  impl->name = std::move(name);
  impl->frame = frame;
  if (onlyBackground(*grid)) {
    impl->constant = static_cast<double>(grid->background());
    impl->content = contentOf(*impl);
    return ScalarGrid(std::move(impl));
  }
  const float background = grid->background();
  for (auto value = grid->beginValueOff(); value; ++value) value.setValue(background);
  impl->grid = std::move(grid);
  impl->content = contentOf(*impl);
  return ScalarGrid(std::move(impl));
}

const std::string& ScalarGrid::name() const { return impl_->name; }
bool ScalarGrid::isConstant() const { return impl_->grid == nullptr; }

void ScalarGrid::sample(std::span<const Vec3> points, std::span<double> out) const {
  if (isConstant()) {
    std::fill(out.begin(), out.end(), impl_->constant);
    return;
  }
  const FloatGrid& grid = *impl_->grid;
  const double background = static_cast<double>(grid.background());
  // Trilinear samples reach one voxel beyond the active ones; farther out there is nothing to look up, and
  // the index might not fit a Coord.
  openvdb::CoordBBox active = grid.evalActiveVoxelBoundingBox();
  active.expand(1);
  const openvdb::BBoxd reach(active.min().asVec3d(), active.max().asVec3d());
  parallelFor(Exec{}, points.size(), 2048, [&](std::size_t begin, std::size_t end) {
    const auto accessor = grid.getConstUnsafeAccessor();
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 world = impl_->frame.toFile(points[i]);
      const openvdb::Vec3d index = grid.worldToIndex(openvdb::Vec3d(world.x(), world.y(), world.z()));
      out[i] = reach.isInside(index)
                   ? static_cast<double>(openvdb::tools::BoxSampler::sample(accessor, index))
                   : background;
    }
  });
}

double ScalarGrid::background() const {
  return isConstant() ? impl_->constant : static_cast<double>(impl_->grid->background());
}

Box ScalarGrid::activeBox() const {
  Box box;
  if (isConstant()) return box;
  const openvdb::CoordBBox active = impl_->grid->evalActiveVoxelBoundingBox();
  if (active.empty()) return box;
  const openvdb::BBoxd index(active.min().asVec3d(), active.max().asVec3d());
  for (int corner = 0; corner < 8; ++corner) {
    const auto end = [&](int axis) { return (corner >> axis & 1 ? index.max() : index.min())[axis]; };
    const openvdb::Vec3d world = impl_->grid->indexToWorld(openvdb::Vec3d(end(0), end(1), end(2)));
    box.add(impl_->frame.toMetres(Vec3(world.x(), world.y(), world.z())));
  }
  return box;
}

void hashValue(Hasher& hasher, const ScalarGrid& grid) { hasher.add(grid.impl().content); }

std::size_t byteSize(const ScalarGrid& grid) {
  return sizeof(ScalarGrid::Impl) + (grid.isConstant() ? 0 : grid.impl().grid->memUsage());
}

}  // namespace sherd
