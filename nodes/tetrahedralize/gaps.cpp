#include "tetrahedralize/gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

namespace {

/// A shell with what is asked of it.
class Body {
 public:
  Body(std::span<const Vec3> positions, std::span<const Triangle> triangles, const Shell& shell)
      : positions_(positions) {
    for (const Index t : shell.triangles) {
      own_.push_back(triangles[at(t)]);
      for (const Index v : own_.back()) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const Index v : vertices) box.add(positions[at(v)]);
  }
  const SurfaceTree& tree() {
    if (!tree_) tree_.emplace(positions_, own_);
    return *tree_;
  }
  std::vector<Index> vertices;
  Box box;

 private:
  std::span<const Vec3> positions_;
  std::vector<Triangle> own_;
  std::optional<SurfaceTree> tree_;
};

double distanceTo(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.low).cwiseMin(box.high)).norm();
}

double distanceBetween(const Box& a, const Box& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).norm();
}

}  // namespace

std::optional<Gap> narrowestBetweenBodies(std::span<const Vec3> positions,
                                          std::span<const Triangle> triangles,
                                          const std::vector<Shell>& shells, double touching,
                                          const Exec& exec) {
  std::vector<Body> bodies;
  for (const Shell& shell : shells)
    if (shell.volume > 0) bodies.emplace_back(positions, triangles, shell);
  std::optional<Gap> best;
  const auto isNarrower = [&](double width) { return !best || width < best->width; };
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = 0; b < bodies.size() && !exec.cancelled(); ++b) {
      if (a == b || !isNarrower(distanceBetween(bodies[a].box, bodies[b].box))) continue;
      for (const Index v : bodies[a].vertices) {
        const Vec3& p = positions[at(v)];
        if (!isNarrower(distanceTo(bodies[b].box, p))) continue;
        const SurfacePoint nearest = bodies[b].tree().closest(p);
        if (nearest.distance > touching && isNarrower(nearest.distance))
          best = Gap{p, nearest.point, nearest.distance, std::numeric_limits<double>::infinity()};
      }
    }
  return best;
}

}  // namespace sherd
