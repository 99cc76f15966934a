#include <fmt/format.h>

#include <cmath>

#include "beta/layers.h"
#include "geometry/box_tree.h"
#include "geometry/point_triangle.h"

namespace sherd {
namespace {

/// A stroke's path in pieces no longer than its radius takes, so that their boxes follow it closely.
struct Path {
  std::vector<std::array<Vec3, 2>> pieces;
  std::vector<Box> boxes;

  static Result<Path> of(const Stroke& stroke, std::size_t number) {
    constexpr double kMost = 1u << 22;
    Path path;
    const auto& points = stroke.points;
    for (std::size_t i = 0; i + 1 < std::max(points.size(), std::size_t{2}); ++i) {
      const Vec3 &a = points[i], &b = points[std::min(i + 1, points.size() - 1)];
      const double parts = std::max(1.0, std::ceil((b - a).norm() / (2 * stroke.radius)));
      if (static_cast<double>(path.pieces.size()) + parts > kMost)
        return failure(
            fmt::format("stroke {} is more than {:.0f} times as long as its radius", number, 2 * kMost),
            "give it a larger radius", "strokes");
      for (double k = 0; k < parts; ++k) path.add(a + k / parts * (b - a), a + (k + 1) / parts * (b - a));
    }
    return path;
  }
  void add(const Vec3& a, const Vec3& b) {
    pieces.push_back({a, b});
    boxes.emplace_back();
    boxes.back().add(a);
    boxes.back().add(b);
  }
  double distance(std::size_t piece, const Vec3& p) const {
    return (p - closestOnSegment(p, pieces[piece][0], pieces[piece][1])).norm();
  }
};

Box grown(Box box, double by) {
  box.low.array() -= by;
  box.high.array() += by;
  return box;
}

Blocks blocksNear(const Path& path, const Lattice& lattice, double radius, const Exec& exec) {
  Blocks blocks;
  const double reach = radius + lattice.blockRadius();
  for (std::size_t piece = 0; piece < path.pieces.size() && !blocks.tooMany() && !exec.cancelled(); ++piece) {
    const Box box = lattice.indexBox(grown(path.boxes[piece], radius));
    blocks.add(box.low, box.high, [&](const openvdb::Coord& origin) {
      return path.distance(piece, lattice.blockCentre(origin)) <= reach;
    });
  }
  return blocks;
}

Result<void> paint(Canvas& canvas, const Stroke& stroke, std::size_t number, const Exec& exec) {
  SHERD_ASSIGN(const Path path, Path::of(stroke, number));
  const Lattice lattice = canvas.lattice();
  const Blocks blocks = blocksNear(path, lattice, stroke.radius, exec);
  const BoxTree tree(path.boxes);
  const auto strokeIn = [&](const openvdb::Coord& origin) -> Canvas::Edit {
    std::vector<std::size_t> near;
    tree.visitOverlaps(grown(lattice.blockBox(origin), stroke.radius),
                       [&](Index piece) { near.push_back(at(piece)); });
    return [&, near = std::move(near)](const openvdb::Coord& c, double value, bool) -> std::optional<double> {
      double distance = stroke.radius;
      for (const std::size_t piece : near)
        distance = std::min(distance, path.distance(piece, lattice.metres(c)));
      const double strength = stroke.strengthAt(distance);
      if (strength == 0) return std::nullopt;
      const double wanted = blended(stroke.blend, value, stroke.value);
      return strength == 1 ? wanted : value + strength * (wanted - value);
    };
  };
  return canvas.edit(blocks, strokeIn, exec);
}

}  // namespace

Result<void> paintStrokes(Canvas& canvas, std::span<const Stroke> strokes, const Exec& exec) {
  const double step = canvas.lattice().longestStep();
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (strokes[i].radius < step)
      exec.warn(
          fmt::format("stroke {} has a radius of {:.3g} m, less than a voxel of {:.3g} m: it may miss all "
                      "of them; make `voxel` smaller",
                      i + 1, strokes[i].radius, step));
    SHERD_CHECK(paint(canvas, strokes[i], i + 1, exec));
  }
  return {};
}

}  // namespace sherd
