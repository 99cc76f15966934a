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
  Body(std::span<const Vec3> positions, std::span<const Triangle> all, const Shell& shell)
      : positions_(positions) {
    for (const Index t : shell.triangles) {
      triangles.push_back(all[at(t)]);
      for (const Index v : triangles.back()) box.add(positions[at(v)]);
    }
  }
  const SurfaceTree& tree() {
    if (!tree_) tree_.emplace(positions_, triangles);
    return *tree_;
  }
  std::vector<Triangle> triangles;
  Box box;

 private:
  std::span<const Vec3> positions_;
  std::optional<SurfaceTree> tree_;
};

double distanceTo(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.low).cwiseMin(box.high)).norm();
}

double distanceBetween(const Box& a, const Box& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).norm();
}

/// Looks from a body to another, splitting triangles in four until they are small against the gap.
class LookBetween {
 public:
  LookBetween(Body& to, double touching, double widest, std::size_t most)
      : to_(to), touching_(touching), widest_(widest), most_(most) {}

  void from(const Vec3& a, const Vec3& b, const Vec3& c) {
    if (touches || gaps.size() > most_) return;
    const Vec3 middle = (a + b + c) / 3;
    const double radius = std::sqrt(
        std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()}));
    if (distanceTo(to_.box, middle) > widest_ + radius) return;
    const SurfacePoint nearest = to_.tree().closest(middle);
    if (nearest.distance > widest_ + radius) return;
    touches = nearest.distance <= touching_;
    if (radius <= 0.5 * nearest.distance) {
      if (nearest.distance <= widest_)
        gaps.push_back({middle, nearest.point, nearest.distance, std::numeric_limits<double>::infinity()});
      return;
    }
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    from(a, ab, ca);
    from(ab, b, bc);
    from(ca, bc, c);
    from(ab, bc, ca);
  }

  std::vector<Gap> gaps;
  bool touches = false;

 private:
  Body& to_;
  double touching_, widest_;
  std::size_t most_;
};

}  // namespace

BodyGaps gapsBetweenBodies(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           const std::vector<Shell>& shells, double touching, double widest, std::size_t most,
                           const Exec& exec) {
  std::vector<Body> bodies;
  for (const Shell& shell : shells)
    if (shell.volume > 0) bodies.emplace_back(positions, triangles, shell);
  BodyGaps found;
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = 0; b < bodies.size() && !exec.cancelled(); ++b) {
      if (a == b || distanceBetween(bodies[a].box, bodies[b].box) > widest) continue;
      LookBetween look(bodies[b], touching, widest, most);
      for (const Triangle& t : bodies[a].triangles)
        look.from(positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]);
      if (look.touches) continue;
      found.isTooMany = found.isTooMany || look.gaps.size() > most;
      found.gaps.insert(found.gaps.end(), look.gaps.begin(), look.gaps.end());
    }
  for (const Gap& gap : found.gaps)
    if (!found.narrowest || gap.width < found.narrowest->width) found.narrowest = gap;
  found.isTooMany = found.isTooMany || found.gaps.size() > most;
  return found;
}

}  // namespace sherd
