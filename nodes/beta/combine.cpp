#include <openvdb/tools/Interpolation.h>

#include "beta/layers.h"

namespace sherd {
namespace {

/// The other field, seen from the canvas's lattice.
class Other {
 public:
  Other(const Canvas& canvas, const ScalarGrid::Impl& impl)
      : grid_(*impl.grid), frame_(impl.frame), lattice_(canvas.lattice()), background_(grid_.background()) {
    isSame_ = impl.frame.up == canvas.frame.up && impl.frame.metresPerUnit == canvas.frame.metresPerUnit &&
              grid_.transform() == canvas.grid->transform();
  }
  double background() const { return static_cast<double>(background_); }

  /// Blocks of the canvas that what is painted of the other field reaches into.
  Blocks blocks(const Exec& exec) const {
    Blocks blocks;
    visitActive(grid_.tree(), [&](const openvdb::CoordBBox& box) {
      if (blocks.tooMany() || exec.cancelled()) return;
      const int more = isSame_ ? 0 : 1;  // as far as linear interpolation does
      Box index;
      for (int corner = 0; corner < 8; ++corner)
        index.add(fromOther(openvdb::Vec3d(corner & 1 ? box.max().x() + more : box.min().x() - more,
                                           corner & 2 ? box.max().y() + more : box.min().y() - more,
                                           corner & 4 ? box.max().z() + more : box.min().z() - more)));
      blocks.add(index.low, index.high);
    });
    return blocks;
  }

  struct Sample {
    double value;
    bool isPainted;
  };
  Sample at(const openvdb::Coord& c, const openvdb::FloatGrid::ConstUnsafeAccessor& accessor) const {
    float value = background_;
    if (isSame_) {
      const bool isPainted = accessor.probeValue(c, value);
      return {static_cast<double>(value), isPainted};
    }
    const Vec3 p = frame_.toFile(lattice_.metres(c));
    const openvdb::Vec3d index = grid_.worldToIndex(openvdb::Vec3d(p.x(), p.y(), p.z()));
    const bool isPainted = openvdb::tools::BoxSampler::sample(accessor, index, value);
    return {static_cast<double>(value), isPainted};
  }
  openvdb::FloatGrid::ConstUnsafeAccessor accessor() const { return grid_.getConstUnsafeAccessor(); }

 private:
  Vec3 fromOther(const openvdb::Vec3d& index) const {
    const openvdb::Vec3d world = grid_.indexToWorld(index);
    return lattice_.index(frame_.toMetres(Vec3(world.x(), world.y(), world.z())));
  }

  const openvdb::FloatGrid& grid_;
  FileFrame frame_;
  Lattice lattice_;
  float background_;
  bool isSame_ = false;
};

}  // namespace

Result<void> combine(Canvas& canvas, const ScalarGrid& other, Blend blend, const Exec& exec) {
  const Other field(canvas, other.impl());
  const Blocks blocks = field.blocks(exec);
  // What the other field isn't painted over meets its background, except where that would replace it.
  const openvdb::FloatGrid::ConstPtr before = canvas.grid;
  if (blend != Blend::Replace) {
    canvas.grid = before->deepCopy();
    canvas.map([&](double value) { return blended(blend, value, field.background()); });
  }
  const auto otherIn = [&](const openvdb::Coord&) -> Canvas::Edit {
    return [&, there = before->getConstUnsafeAccessor(), accessor = field.accessor()](
               const openvdb::Coord& c, double, bool) -> std::optional<double> {
      const Other::Sample sample = field.at(c, accessor);
      if (!sample.isPainted) return std::nullopt;
      if (blend == Blend::Replace) return sample.value;
      float own = before->background();
      if (!there.probeValue(c, own)) own = before->background();
      return blended(blend, static_cast<double>(own), sample.value);
    };
  };
  return canvas.edit(blocks, otherIn, exec);
}

}  // namespace sherd
