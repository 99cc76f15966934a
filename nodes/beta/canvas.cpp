#include "beta/canvas.h"

#include <fmt/format.h>

#include <cmath>

#include "base/parallel.h"

namespace sherd {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatTree;

constexpr int kEdge = static_cast<int>(Canvas::Leaf::DIM);
static_assert(kEdge == 8);

Lattice::Lattice(const openvdb::math::Transform& transform, const FileFrame& frame) {
  const auto place = [&](double i, double j, double k) {
    const openvdb::Vec3d world = transform.indexToWorld(openvdb::Vec3d(i, j, k));
    return frame.toMetres(Vec3(world.x(), world.y(), world.z()));
  };
  origin_ = place(0, 0, 0);
  axes_.col(0) = place(1, 0, 0) - origin_;
  axes_.col(1) = place(0, 1, 0) - origin_;
  axes_.col(2) = place(0, 0, 1) - origin_;
  inverse_ = axes_.inverse();
  for (const double y : {-3.5, 3.5})
    for (const double z : {-3.5, 3.5})
      blockRadius_ = std::max(blockRadius_, (axes_ * Vec3(3.5, y, z)).norm());
}

Box Lattice::blockBox(const Coord& origin) const {
  Box box;
  for (int corner = 0; corner < 8; ++corner)
    box.add(metres(origin.offsetBy(corner & 1 ? 7 : 0, corner & 2 ? 7 : 0, corner & 4 ? 7 : 0)));
  return box;
}

Box Lattice::indexBox(const Box& metres) const {
  Box box;
  for (int corner = 0; corner < 8; ++corner)
    box.add(index(Vec3(corner & 1 ? metres.high.x() : metres.low.x(),
                       corner & 2 ? metres.high.y() : metres.low.y(),
                       corner & 4 ? metres.high.z() : metres.low.z())));
  return box;
}

void Blocks::add(const Vec3& low, const Vec3& high, const std::function<bool(const Coord&)>& isWanted) {
  // Far beyond, where blocks cannot be numbered, there are too many on the way.
  constexpr double kFarthest = 1e9;
  constexpr double kMostLookedAt = 1u << 24;
  const Vec3 first = (low.array() / kEdge).floor(), last = (high.array() / kEdge).floor();
  const bool isNear =
      low.allFinite() && high.allFinite() && low.minCoeff() > -kFarthest && high.maxCoeff() < kFarthest;
  const bool isFew =
      isNear && (last - first + Vec3::Ones()).prod() <= (isWanted ? kMostLookedAt : double(kMost));
  tooMany_ = tooMany_ || !isFew;
  if (tooMany_) return;
  const Eigen::Vector3i from = first.cast<int>(), to = last.cast<int>();
  for (int i = from.x(); i <= to.x(); ++i)
    for (int j = from.y(); j <= to.y(); ++j)
      for (int k = from.z(); k <= to.z(); ++k) {
        const Coord origin(i * kEdge, j * kEdge, k * kEdge);
        if (!isWanted || isWanted(origin)) origins_.insert(origin);
      }
  tooMany_ = origins_.size() > kMost;
}

void Blocks::addActive(const FloatTree& tree, const Coord& margin) {
  const Vec3 more(margin.x(), margin.y(), margin.z());
  visitActive(tree, [&](const CoordBBox& box) {
    if (tooMany_) return;
    add(Vec3(box.min().x(), box.min().y(), box.min().z()) - more,
        Vec3(box.max().x(), box.max().y(), box.max().z()) + more);
  });
}

void visitActive(const FloatTree& tree, const std::function<void(const CoordBBox&)>& visit) {
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
    if (!leaf->isEmpty()) visit(leaf->getNodeBoundingBox());
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) visit(tile.getBoundingBox());
}

Result<void> Canvas::edit(const Blocks& blocks, const std::function<Edit(const Coord&)>& makeEdit,
                          const Exec& exec) {
  if (blocks.tooMany()) return tooManyVoxels(lattice());
  // The tree's shape changes here, by one thread; later each block changes by itself.
  std::vector<Leaf*> leaves;
  for (const Coord& origin : blocks.list()) {
    if (exec.cancelled()) return cancelledError();
    leaves.push_back(grid->tree().touchLeaf(origin));
  }
  const double outside = static_cast<double>(background());
  parallelFor(exec, leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end && !exec.cancelled(); ++l) {
      Leaf& leaf = *leaves[l];
      const Edit change = makeEdit(leaf.origin());
      for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const bool isOn = leaf.isValueOn(i);
        const double value = isOn ? static_cast<double>(leaf.getValue(i)) : outside;
        if (const auto changed = change(leaf.offsetToGlobalCoord(i), value, isOn))
          leaf.setValueOn(i, static_cast<float>(*changed));
      }
    }
  });
  if (exec.cancelled()) return cancelledError();
  return {};
}

void Canvas::map(const std::function<double(double)>& map) {
  const auto mapped = [&](float value) { return static_cast<float>(map(static_cast<double>(value))); };
  for (auto value = grid->beginValueOn(); value; ++value) value.setValue(mapped(*value));
  grid->tree().root().setBackground(mapped(background()), /*updateChildNodes=*/false);
}

Error tooManyVoxels(const Lattice& lattice) {
  return failure(fmt::format("painting this with voxels of {:.3g} m takes more than {} million of them",
                             lattice.longestStep(), Blocks::kMost * 512 / 1000000),
                 "make `voxel` larger, or paint a smaller region", "voxel");
}

}  // namespace sherd
