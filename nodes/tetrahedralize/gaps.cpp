#include "tetrahedralize/gaps.h"

#include <cmath>
#include <optional>
#include <set>

#include "base/parallel.h"
#include "geometry/surface_tree.h"
#include "tetrahedralize/surface_patches.h"

namespace sherd {
namespace {

constexpr double kFacing = -0.5;  ///< cosine between the normals of surfaces that face each other

struct Look {
  Vec3 from, normal;
  Index triangle;
};

Vec3 unitNormal(const RefinedSurface& s, std::size_t t) {
  const Triangle& v = s.triangles[t];
  const Vec3& a = s.positions[at(v[0])];
  return (s.positions[at(v[1])] - a).cross(s.positions[at(v[2])] - a).normalized();
}

/// Centroids of triangles; of many in a cell that look the same way, one is taken.
std::vector<Look> spreadLooks(const RefinedSurface& s, double spacing) {
  std::vector<Look> looks;
  std::set<std::array<int, 4>> taken;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const Triangle& v = s.triangles[t];
    const Vec3 p = (s.positions[at(v[0])] + s.positions[at(v[1])] + s.positions[at(v[2])]) / 3;
    const Vec3 normal = unitNormal(s, t);
    if (!(normal.squaredNorm() > 0.5)) continue;  // a triangle without area
    Eigen::Index axis;
    normal.cwiseAbs().maxCoeff(&axis);
    const int side = static_cast<int>(2 * axis + (normal[axis] > 0 ? 1 : 0));
    const Eigen::Vector3i cell = (p / spacing).array().floor().matrix().cast<int>();
    if (taken.insert({cell.x(), cell.y(), cell.z(), side}).second)
      looks.push_back({p, normal, static_cast<Index>(t)});
  }
  return looks;
}

}  // namespace

std::vector<Gap> findGaps(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          const GapSearch& search, const Exec& exec) {
  const RefinedSurface surface = refineLongEdges(positions, triangles, 1.5 * search.spacing);
  const SurfaceTree tree(surface.positions, surface.triangles);
  const std::vector<Look> looks = spreadLooks(surface, search.spacing);
  std::vector<std::optional<SurfacePoint>> seen(looks.size());
  parallelFor(exec, looks.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto hit = tree.firstHit(looks[i].from, looks[i].normal, 1e-7 * search.spacing);
      if (hit && hit->distance <= search.widest &&
          unitNormal(surface, at(hit->triangle)).dot(looks[i].normal) < kFacing)
        seen[i] = hit;
    }
  });
  SurfacePatches patches(surface.positions, surface.triangles, search.spacing, search.touching);
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < looks.size() && !exec.cancelled(); ++i)
    if (seen[i])
      gaps.push_back({looks[i].from, seen[i]->point, seen[i]->distance,
                      patches.distance(looks[i].triangle, seen[i]->triangle, search.farthest)});
  return gaps;
}

}  // namespace sherd
