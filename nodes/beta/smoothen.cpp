#include <fmt/format.h>

#include <array>
#include <cmath>

#include "beta/layers.h"

namespace sherd {
namespace {

/// Weights of the voxels −n … n, which sum to 1.
std::vector<double> gaussian(double deviation) {
  const int n = static_cast<int>(std::ceil(3 * deviation));
  std::vector<double> weights;
  double sum = 0;
  for (int i = -n; i <= n; ++i) {
    weights.push_back(std::exp(-0.5 * (i / deviation) * (i / deviation)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// A line of a block's voxels along one axis, smoothed.
class Line {
 public:
  Line(std::span<const double> weights, int axis)
      : weights_(weights), axis_(axis), values_(weights.size() + 7) {}

  std::array<double, 8> smoothed(openvdb::Coord start,
                                 const openvdb::FloatGrid::ConstUnsafeAccessor& accessor, float background) {
    const int reach = static_cast<int>(weights_.size() / 2);
    start[axis_] -= reach;
    for (double& there : values_) {
      float value = background;
      if (!accessor.probeValue(start, value)) value = background;
      there = static_cast<double>(value);
      ++start[axis_];
    }
    std::array<double, 8> result;
    for (std::size_t i = 0; i < 8; ++i) result[i] = mean(std::span(values_).subspan(i, weights_.size()));
    return result;
  }

 private:
  /// From the first value on, so that equal ones stay as they are to the last bit.
  double mean(std::span<const double> values) const {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += weights_[i] * (values[i] - values[0]);
    return values[0] + sum;
  }

  std::span<const double> weights_;
  int axis_;
  std::vector<double> values_;
};

Result<void> smoothenAlong(Canvas& canvas, int axis, double deviation, const Exec& exec) {
  const std::vector<double> weights = gaussian(deviation);
  openvdb::Coord margin(0);
  margin[axis] = static_cast<int>(weights.size() / 2);
  Blocks blocks;
  blocks.addActive(canvas.grid->tree(), margin);
  const openvdb::FloatGrid::ConstPtr before = canvas.grid;
  const float background = before->background();
  canvas.grid = openvdb::FloatGrid::create(*before);  // all but the voxels
  canvas.grid->setTree(std::make_shared<openvdb::FloatTree>(background));
  const auto lineIn = [&](const openvdb::Coord& origin) -> Canvas::Edit {
    std::array<std::array<double, 8>, 64> lines;
    const auto accessor = before->getConstUnsafeAccessor();
    Line line(weights, axis);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int n = 0; n < 64; ++n) {
      openvdb::Coord start = origin;
      start[u] += n / 8, start[v] += n % 8;
      lines[static_cast<std::size_t>(n)] = line.smoothed(start, accessor, background);
    }
    return [=](const openvdb::Coord& c, double, bool) -> std::optional<double> {
      const openvdb::Coord at = c - origin;
      const double value =
          lines[static_cast<std::size_t>(8 * at[u] + at[v])][static_cast<std::size_t>(at[axis])];
      if (static_cast<float>(value) == background) return std::nullopt;
      return value;
    };
  };
  return canvas.edit(blocks, lineIn, exec);
}

}  // namespace

Result<void> smoothen(Canvas& canvas, double deviation, const Exec& exec) {
  constexpr double kWidest = 256, kNarrowest = 0.1;  // voxels
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = deviation / canvas.lattice().step(axis);
    if (voxels > kWidest)
      return failure(fmt::format("smoothing over {:.3g} m is {:.0f} voxels wide, and {:.0f} are the most",
                                 deviation, voxels, kWidest),
                     "make it smaller, or paint with larger voxels", "smooth");
    if (voxels > kNarrowest) SHERD_CHECK(smoothenAlong(canvas, axis, voxels, exec));
  }
  return {};
}

}  // namespace sherd
