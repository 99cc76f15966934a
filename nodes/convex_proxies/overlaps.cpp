#include "convex_proxies/overlaps.h"

#include <algorithm>

#include "base/parallel.h"
#include "convex_proxies/clipped.h"

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

struct Solid {
  const ConvexHull* hull;
  Box box;
  std::vector<CutPlane> planes;
};

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
  for (const CutPlane& plane : b.planes) {
    if (both.within(plane)) continue;
    both = both.clipped(plane);
    if (both.empty()) return 0;
  }
  return std::max(0.0, both.volume());
}

Solid solidOf(const ConvexHull& hull) { return {&hull, boxOf(hull.positions), planesOf(hull)}; }

}  // namespace

double sharedVolume(const ConvexHull& a, const ConvexHull& b) { return shared(solidOf(a), solidOf(b)); }

void measureOverlaps(std::vector<PieceProxy>& pieces, const Exec& exec) {
  std::vector<std::vector<Solid>> solids(pieces.size());
  std::vector<Box> boxes(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (const ConvexHull& hull : pieces[p].hulls) {
      solids[p].push_back(solidOf(hull));
      for (const Vec3& x : hull.positions) boxes[p].add(x);
    }
  // Each pair is clipped in one order, whichever piece asks, so that both are told the same volume.
  std::vector<std::vector<std::pair<std::size_t, double>>> withLater(pieces.size());
  parallelFor(exec, pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t q = p + 1; q < pieces.size() && !exec.cancelled(); ++q) {
        if (!boxes[p].overlaps(boxes[q])) continue;
        double volume = 0;
        for (const Solid& a : solids[p])
          for (const Solid& b : solids[q]) volume += shared(a, b);
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
