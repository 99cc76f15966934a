#include "tessellate/polygon.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Loop = std::vector<Index>;

constexpr double kGoodAngle = 0.25;  ///< sine of a least angle that needs no flips

class Plane {
 public:
  explicit Plane(std::span<const PlanarCorner> corners) : corners_(corners) {}

  /// +1 for a left turn, −1 for a right turn, 0 where the three are on one line.
  int turn(Index a, Index b, Index c) const {
    const PlanarCorner &p = corners_[at(a)], &q = corners_[at(b)], &r = corners_[at(c)];
    if ((p.lines & q.lines & r.lines) != 0) return 0;
    return static_cast<int>(CGAL::orientation(Kernel::Point_2(p.point.x(), p.point.y()),
                                              Kernel::Point_2(q.point.x(), q.point.y()),
                                              Kernel::Point_2(r.point.x(), r.point.y())));
  }
  bool inClosedTriangle(Index a, Index b, Index c, Index p) const {
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
  }
  /// Sine of the least angle, negative where the triangle is turned over, 0 where it is flat.
  double quality(Index a, Index b, Index c) const {
    const Vec2 u = point(b) - point(a), v = point(c) - point(a), w = point(c) - point(b);
    const double area2 = u.x() * v.y() - u.y() * v.x();
    double sides[] = {u.squaredNorm(), v.squaredNorm(), w.squaredNorm()};
    std::sort(sides, sides + 3);
    return sides[0] > 0 ? area2 / std::sqrt(sides[1] * sides[2]) : 0;
  }
  const Vec2& point(Index i) const { return corners_[at(i)].point; }

  /// Do the open segments pq and rs, which share no corner, meet?
  bool segmentsMeet(Index p, Index q, Index r, Index s) const {
    const int a = turn(p, q, r), b = turn(p, q, s), c = turn(r, s, p), d = turn(r, s, q);
    if (a == 0 && b == 0) return overlapOnLine(p, q, r, s);
    return a * b <= 0 && c * d <= 0;
  }

 private:
  bool overlapOnLine(Index p, Index q, Index r, Index s) const {
    const Vec2 direction = point(q) - point(p);
    auto along = [&](Index i) { return (point(i) - point(p)).dot(direction); };
    const double low = std::min(along(r), along(s)), high = std::max(along(r), along(s));
    return high >= 0 && low <= along(q);
  }

  std::span<const PlanarCorner> corners_;
};

/// Does the direction from slot i of the loop towards corner `target` lead into the region on the loop's
/// left?
bool leadsInside(const Plane& plane, const Loop& loop, std::size_t i, Index target) {
  const Index before = loop[(i + loop.size() - 1) % loop.size()], here = loop[i],
              after = loop[(i + 1) % loop.size()];
  const bool leftOfIn = plane.turn(before, here, target) > 0, leftOfOut = plane.turn(here, after, target) > 0;
  return plane.turn(before, here, after) > 0 ? leftOfIn && leftOfOut : leftOfIn || leftOfOut;
}

bool blocked(const Plane& plane, const Loop& loop, Index p, Index q) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Index r = loop[i], s = loop[(i + 1) % loop.size()];
    if (r == p || r == q || s == p || s == q) continue;
    if (plane.segmentsMeet(p, q, r, s)) return true;
  }
  return false;
}

/// Joins a hole to the loop by the shortest bridge that meets nothing; false where there is none.
bool bridgeHole(const Plane& plane, Loop& outer, const Loop& hole, std::span<const Loop> others) {
  struct Bridge {
    double length;
    std::size_t from, to;
  };
  std::vector<Bridge> bridges;
  for (std::size_t i = 0; i < outer.size(); ++i)
    for (std::size_t j = 0; j < hole.size(); ++j)
      bridges.push_back({(plane.point(outer[i]) - plane.point(hole[j])).squaredNorm(), i, j});
  std::sort(bridges.begin(), bridges.end(), [](const Bridge& a, const Bridge& b) {
    return std::tuple(a.length, a.from, a.to) < std::tuple(b.length, b.from, b.to);
  });
  auto fits = [&](const Bridge& b) {
    const Index p = outer[b.from], q = hole[b.to];
    if (!leadsInside(plane, outer, b.from, q) || !leadsInside(plane, hole, b.to, p)) return false;
    if (blocked(plane, outer, p, q) || blocked(plane, hole, p, q)) return false;
    return std::none_of(others.begin(), others.end(), [&](const Loop& l) { return blocked(plane, l, p, q); });
  };
  const auto found = std::find_if(bridges.begin(), bridges.end(), fits);
  const Bridge& chosen = found != bridges.end() ? *found : bridges.front();
  Loop joined(outer.begin(), outer.begin() + static_cast<std::ptrdiff_t>(chosen.from) + 1);
  for (std::size_t k = 0; k <= hole.size(); ++k) joined.push_back(hole[(chosen.to + k) % hole.size()]);
  joined.insert(joined.end(), outer.begin() + static_cast<std::ptrdiff_t>(chosen.from), outer.end());
  outer = std::move(joined);
  return found != bridges.end();
}

/// Cuts ears off one loop, best first.
class EarCutter {
 public:
  EarCutter(const Plane& plane, const Loop& loop) : plane_(plane), loop_(loop), quality_(loop.size()) {}

  void cut(PolygonTriangulation& out) {
    bool stale = false;  // are there ears judged before another ear was cut?
    for (std::size_t i = 0; i < loop_.size(); ++i) quality_[i] = judge(i);
    while (loop_.size() > 3) {
      std::size_t best = bestEar();
      if (quality_[best] < 0 && stale) {
        for (std::size_t i = 0; i < loop_.size(); ++i) quality_[i] = judge(i);
        stale = false;
        best = bestEar();
      }
      if (quality_[best] < 0) {
        best = leastBad();
        ++out.forced;
      }
      emit(best, out);
      loop_.erase(loop_.begin() + static_cast<std::ptrdiff_t>(best));
      quality_.erase(quality_.begin() + static_cast<std::ptrdiff_t>(best));
      const std::size_t n = loop_.size();
      for (const std::size_t i : {(best + n - 1) % n, best % n}) quality_[i] = judge(i);
      stale = true;
    }
    if (plane_.turn(loop_[0], loop_[1], loop_[2]) <= 0) ++out.forced;
    emit(1, out);
  }

 private:
  Index before(std::size_t i) const { return loop_[(i + loop_.size() - 1) % loop_.size()]; }
  Index after(std::size_t i) const { return loop_[(i + 1) % loop_.size()]; }

  /// The ear's quality, or −1 where it is none.
  double judge(std::size_t i) const {
    const Index a = before(i), b = loop_[i], c = after(i);
    if (a == c || plane_.turn(a, b, c) <= 0) return -1;
    for (const Index p : loop_)
      if (p != a && p != b && p != c && plane_.inClosedTriangle(a, b, c, p)) return -1;
    return std::max(0.0, plane_.quality(a, b, c));
  }
  std::size_t bestEar() const {
    return static_cast<std::size_t>(std::max_element(quality_.begin(), quality_.end()) - quality_.begin());
  }
  std::size_t leastBad() const {
    std::size_t best = 0;
    double most = -1e300;
    for (std::size_t i = 0; i < loop_.size(); ++i) {
      const double q = before(i) == after(i) ? -1e200 : plane_.quality(before(i), loop_[i], after(i));
      if (q > most) most = q, best = i;
    }
    return best;
  }
  void emit(std::size_t i, PolygonTriangulation& out) const {
    out.triangles.push_back({before(i), loop_[i], after(i)});
  }

  const Plane& plane_;
  Loop loop_;
  std::vector<double> quality_;
};

/// One pass over all inner edges; returns whether any was flipped.
bool flipPass(const Plane& plane, std::vector<Triangle>& triangles,
              std::span<const std::pair<Index, Index>> fixed) {
  struct Side {
    Index low, high, opposite;
    std::size_t triangle;
    bool forward;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), triangles[t][(c + 2) % 3], t, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.low, a.high, a.triangle) < std::tuple(b.low, b.high, b.triangle);
  });
  std::vector<bool> touched(triangles.size(), false);
  bool any = false;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &s = sides[i], &t = sides[i + 1];
    if (s.low != t.low || s.high != t.high || s.forward == t.forward) continue;
    if (touched[s.triangle] || touched[t.triangle]) continue;
    if (std::binary_search(fixed.begin(), fixed.end(), std::pair(s.low, s.high))) continue;
    const Side &left = s.forward ? s : t, &right = s.forward ? t : s;
    const Index a = s.low, b = s.high, c = left.opposite, d = right.opposite;
    if (c == d || plane.turn(d, b, c) <= 0 || plane.turn(c, a, d) <= 0) continue;
    const double now = std::min(plane.quality(a, b, c), plane.quality(b, a, d));
    const double then = std::min(plane.quality(d, b, c), plane.quality(c, a, d));
    if (then <= now * (1 + 1e-9) + 1e-300) continue;
    triangles[left.triangle] = {d, b, c};
    triangles[right.triangle] = {c, a, d};
    touched[left.triangle] = touched[right.triangle] = any = true;
  }
  return any;
}

void flipToBetterAngles(const Plane& plane, std::span<const Loop> loops, std::vector<Triangle>& triangles) {
  if (triangles.size() < 2) return;
  const bool goodAlready = std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return plane.quality(t[0], t[1], t[2]) > kGoodAngle;
  });
  if (goodAlready) return;
  std::vector<std::pair<Index, Index>> fixed;
  for (const Loop& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      fixed.push_back(std::minmax(loop[i], loop[(i + 1) % loop.size()]));
  std::sort(fixed.begin(), fixed.end());
  for (std::size_t pass = 0; pass < 4 * triangles.size() && flipPass(plane, triangles, fixed); ++pass) {
  }
}

/// Splits a loop of four along the better of its diagonals; false where neither leaves two proper triangles.
bool splitQuad(const Plane& plane, const Loop& q, std::vector<Triangle>& out) {
  double best = 0;
  std::size_t from = 4;
  for (std::size_t i = 0; i < 2; ++i) {
    const Index a = q[i], b = q[i + 1], c = q[i + 2], d = q[(i + 3) % 4];
    if (a == c || b == d || plane.turn(a, b, c) <= 0 || plane.turn(a, c, d) <= 0) continue;
    const double worst = std::min(plane.quality(a, b, c), plane.quality(a, c, d));
    if (worst > best) best = worst, from = i;
  }
  if (from == 4) return false;
  out.push_back({q[from], q[from + 1], q[from + 2]});
  out.push_back({q[from], q[from + 2], q[(from + 3) % 4]});
  return true;
}

bool pointInLoop(const Plane& plane, const Loop& loop, const Vec2& p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = plane.point(loop[i]), &b = plane.point(loop[(i + 1) % loop.size()]);
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    inside ^= p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }
  return inside;
}

}  // namespace

double loopArea2(std::span<const PlanarCorner> corners, const std::vector<Index>& loop) {
  double sum = 0;
  const Vec2& o = corners[at(loop[0])].point;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec2 a = corners[at(loop[i])].point - o, b = corners[at(loop[i + 1])].point - o;
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

PolygonTriangulation triangulatePolygon(std::span<const PlanarCorner> corners, std::span<const Loop> loops) {
  PolygonTriangulation result;
  const Plane plane(corners);
  if (loops.size() == 1 && loops[0].size() == 3) {
    result.triangles.push_back({loops[0][0], loops[0][1], loops[0][2]});
    return result;
  }
  if (loops.size() == 1 && loops[0].size() == 4 && splitQuad(plane, loops[0], result.triangles))
    return result;
  std::vector<Loop> outers, holes;
  for (const Loop& loop : loops) {
    (loops.size() == 1 || loopArea2(corners, loop) >= 0 ? outers : holes).push_back(loop);
  }
  if (outers.empty()) outers.swap(holes);  // all areas rounded away: the triangles are as flat as the region
  std::vector<std::vector<Loop>> holesOf(outers.size());
  for (const Loop& hole : holes) {
    std::size_t owner = 0;
    for (std::size_t o = 0; o < outers.size() && outers.size() > 1; ++o)
      if (pointInLoop(plane, outers[o], plane.point(hole[0]))) owner = o;
    holesOf[owner].push_back(hole);
  }
  for (std::size_t o = 0; o < outers.size(); ++o) {
    Loop loop = outers[o];
    for (std::size_t h = 0; h < holesOf[o].size(); ++h) {
      const std::span<const Loop> others(holesOf[o].begin() + static_cast<std::ptrdiff_t>(h) + 1,
                                         holesOf[o].end());
      if (!bridgeHole(plane, loop, holesOf[o][h], others)) ++result.forced;
    }
    EarCutter(plane, loop).cut(result);
  }
  flipToBetterAngles(plane, loops, result.triangles);
  return result;
}

}  // namespace sherd
