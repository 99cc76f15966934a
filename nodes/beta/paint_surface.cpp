// Painting by what stands on a surface: each voxel near it takes the value of the closest point.
#include "beta/layers.h"
#include "geometry/box_tree.h"
#include "geometry/point_triangle.h"

namespace sherd {
namespace {

/// Weights of a triangle's corners at one of its points; of a flat triangle, at its nearest corner.
Vec3 weightsAt(const std::array<Vec3, 3>& corners, const Vec3& p) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (normal.squaredNorm() > 0) {
    const double b = normal.dot((p - corners[0]).cross(corners[2] - corners[0])) / normal.squaredNorm();
    const double c = normal.dot((corners[1] - corners[0]).cross(p - corners[0])) / normal.squaredNorm();
    return {1 - b - c, b, c};
  }
  Eigen::Index nearest = 0;
  Vec3((p - corners[0]).squaredNorm(), (p - corners[1]).squaredNorm(), (p - corners[2]).squaredNorm())
      .minCoeff(&nearest);
  return Vec3::Unit(nearest);
}

class PaintedSurface {
 public:
  PaintedSurface(const TriMesh& mesh, const SurfaceChannel& channel) : mesh_(mesh), channel_(channel) {
    for (const Triangle& t : mesh.triangles) {
      boxes_.emplace_back();
      for (const Index v : t) boxes_.back().add(mesh.positions[at(v)]);
    }
    tree_.emplace(boxes_);
  }
  std::span<const Box> boxes() const { return boxes_; }

  /// Triangles that may lie within `band` of a point in the block, ascending.
  std::vector<Index> near(const openvdb::Coord& block, const Lattice& lattice, double band) const {
    const double reach = band + lattice.blockRadius();
    const Vec3 centre = lattice.blockCentre(block);
    Box box = lattice.blockBox(block);
    box.low.array() -= band;
    box.high.array() += band;
    std::vector<Index> found;
    tree_->visitOverlaps(box, [&](Index t) {
      if (distance(centre, t) <= reach) found.push_back(t);
    });
    std::sort(found.begin(), found.end());
    return found;
  }
  double distance(const Vec3& p, Index t) const {
    const auto corners = cornersOf(t);
    return (p - closestOnTriangle(p, corners[0], corners[1], corners[2])).norm();
  }
  /// The channel at the closest point of these triangles, in [0, 1]; nothing beyond `band`, or where it says
  /// so.
  std::optional<double> channelAt(const Vec3& p, std::span<const Index> triangles, double band) const {
    Index best = -1;
    double least = band * band;
    Vec3 point = Vec3::Zero();
    for (const Index t : triangles) {
      const Box& box = boxes_[at(t)];
      if ((p - p.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm() > least) continue;
      const auto corners = cornersOf(t);
      const Vec3 q = closestOnTriangle(p, corners[0], corners[1], corners[2]);
      const double distance2 = (p - q).squaredNorm();
      if (distance2 > least || (best >= 0 && distance2 == least)) continue;
      best = t, least = distance2, point = q;
    }
    if (best < 0) return std::nullopt;
    const std::optional<double> value = channel_(best, weightsAt(cornersOf(best), point));
    if (!value) return std::nullopt;
    return std::clamp(*value, 0.0, 1.0);
  }

 private:
  std::array<Vec3, 3> cornersOf(Index t) const {
    const Triangle& v = mesh_.triangles[at(t)];
    return {mesh_.positions[at(v[0])], mesh_.positions[at(v[1])], mesh_.positions[at(v[2])]};
  }

  const TriMesh& mesh_;
  const SurfaceChannel& channel_;
  std::vector<Box> boxes_;
  std::optional<BoxTree> tree_;
};

/// Blocks that have points within `band` of the surface.
Blocks blocksAlong(const PaintedSurface& surface, const Lattice& lattice, double band, const Exec& exec) {
  Blocks blocks;
  const double reach = band + lattice.blockRadius();
  for (std::size_t t = 0; t < surface.boxes().size() && !blocks.tooMany() && !exec.cancelled(); ++t) {
    Box box = surface.boxes()[t];
    box.low.array() -= band;
    box.high.array() += band;
    const Box index = lattice.indexBox(box);
    blocks.add(index.low, index.high, [&](const openvdb::Coord& origin) {
      return surface.distance(lattice.blockCentre(origin), static_cast<Index>(t)) <= reach;
    });
  }
  return blocks;
}

}  // namespace

Result<void> paintSurface(Canvas& canvas, const TriMesh& mesh, const SurfaceChannel& channel,
                          const PaintBetaParams& params, double band, const Exec& exec) {
  const PaintedSurface surface(mesh, channel);
  const Lattice lattice = canvas.lattice();
  const Blocks blocks = blocksAlong(surface, lattice, band, exec);
  const auto colorIn = [&](const openvdb::Coord& origin) -> Canvas::Edit {
    auto near = surface.near(origin, lattice, band);
    return [&, near = std::move(near)](const openvdb::Coord& c, double value, bool) -> std::optional<double> {
      const auto at = surface.channelAt(lattice.metres(c), near, band);
      if (!at) return std::nullopt;
      return blended(params.blend, value, params.low + *at * (params.high - params.low));
    };
  };
  return canvas.edit(blocks, colorIn, exec);
}

}  // namespace sherd
