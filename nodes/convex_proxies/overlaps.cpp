#include "convex_proxies/overlaps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "convex_proxies/clipped.h"
#include "geometry/convex_hull.h"

namespace sherd {
namespace {

std::vector<CutPlane> planesOf(const ConvexHull& hull) {
  std::vector<CutPlane> planes;
  for (const Triangle& t : hull.triangles) {
    const Vec3& a = hull.positions[at(t[0])];
    const Vec3 n = (hull.positions[at(t[1])] - a).cross(hull.positions[at(t[2])] - a);
    const double largest = n.cwiseAbs().maxCoeff();
    if (largest > 0) planes.push_back({a, (n / largest).normalized()});
  }
  return planes;
}

constexpr std::size_t kMostCorners = 96;  ///< of a hull that others are clipped by

struct Solid {
  const ConvexHull* hull;
  Box box;
  std::vector<CutPlane> planes;
};

/// Planes that cut most of the hull off first, so that the others find little left.
std::vector<std::size_t> deepestFirst(const std::vector<CutPlane>& planes, const ConvexHull& hull) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : hull.positions) middle += p / static_cast<double>(hull.positions.size());
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < planes.size(); ++i) order.emplace_back(-planes[i].height(middle), i);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> sorted;
  for (const auto& [depth, i] : order) sorted.push_back(i);
  return sorted;
}

double shared(const Solid& a, const Solid& b) {
  if (a.hull->volume <= 0 || b.hull->volume <= 0 || !a.box.overlaps(b.box)) return 0;
  const auto separates = [](const std::vector<CutPlane>& planes, const ConvexHull& other) {
    return std::any_of(planes.begin(), planes.end(), [&](const CutPlane& plane) {
      return std::all_of(other.positions.begin(), other.positions.end(),
                         [&](const Vec3& p) { return plane.height(p) >= 0; });
    });
  };
  if (separates(a.planes, *b.hull) || separates(b.planes, *a.hull)) return 0;
  ClippedSolid both(a.hull->positions, a.hull->triangles);
  for (const std::size_t i : deepestFirst(b.planes, *a.hull)) {
    if (both.within(b.planes[i])) continue;
    both = both.clipped(b.planes[i]);
    if (both.empty()) return 0;
  }
  return std::max(0.0, both.volume());
}

double shared(const std::vector<Solid>& as, const std::vector<Solid>& bs, const Exec& exec) {
  double volume = 0;
  for (const Solid& a : as)
    for (const Solid& b : bs) {
      if (exec.cancelled()) return 0;
      volume += shared(a, b);
    }
  return volume;
}

/// The hull of the corners that lie farthest in evenly spread directions (a Fibonacci lattice on the sphere).
ConvexHull reduced(const ConvexHull& hull) {
  if (hull.positions.size() <= kMostCorners) return hull;
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < kMostCorners; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(kMostCorners),
                 angle = std::numbers::pi * (1 + std::sqrt(5.0)) * static_cast<double>(i);
    const Vec3 direction(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
    corners.push_back(
        *std::max_element(hull.positions.begin(), hull.positions.end(),
                          [&](const Vec3& p, const Vec3& q) { return p.dot(direction) < q.dot(direction); }));
  }
  Result<HullMesh> mesh = convexHull(corners);
  if (!mesh.ok()) return hull;
  ConvexHull small;
  small.positions = std::move(mesh->positions);
  small.triangles = std::move(mesh->triangles);
  small.volume = mesh->volume;
  return small;
}

Solid solidOf(const ConvexHull& hull) { return {&hull, boxOf(hull.positions), planesOf(hull)}; }

}  // namespace

double sharedVolume(const ConvexHull& a, const ConvexHull& b) { return shared(solidOf(a), solidOf(b)); }

void measureOverlaps(std::vector<PieceProxy>& pieces, const Exec& exec) {
  std::vector<std::vector<ConvexHull>> hulls(pieces.size());
  std::vector<std::vector<Solid>> solids(pieces.size());
  std::vector<Box> boxes(pieces.size());
  parallelFor(exec, pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (const ConvexHull& hull : pieces[p].hulls)
        if (!exec.cancelled()) hulls[p].push_back(reduced(hull));
      for (const ConvexHull& hull : hulls[p]) {
        solids[p].push_back(solidOf(hull));
        for (const Vec3& x : hull.positions) boxes[p].add(x);
      }
    }
  });
  if (exec.cancelled()) return;
  // Each pair is clipped in one order, whichever piece asks, so that both are told the same volume.
  std::vector<std::vector<std::pair<std::size_t, double>>> withLater(pieces.size());
  parallelFor(exec, pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t q = p + 1; q < pieces.size() && !exec.cancelled(); ++q) {
        if (!boxes[p].overlaps(boxes[q])) continue;
        const double volume = shared(solids[p], solids[q], exec);
        if (volume > 0) withLater[p].emplace_back(q, volume);
      }
  });
  for (PieceProxy& p : pieces) p.overlap = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (const auto& [q, volume] : withLater[p]) {
      pieces[p].overlap += volume;
      pieces[q].overlap += volume;
    }
}

}  // namespace sherd
