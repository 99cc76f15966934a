#include "tessellate/polygon.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Loop = std::vector<Index>;

constexpr double kGoodAngle = 0.0625;  ///< squared sine of a least angle that needs no flips

class Plane {
 public:
  explicit Plane(std::span<const PlanarCorner> corners) : corners_(corners) {}

  /// +1 for a left turn, −1 for a right turn, 0 where the three are on one line.
  int turn(Index a, Index b, Index c) const {
    const PlanarCorner &p = corners_[at(a)], &q = corners_[at(b)], &r = corners_[at(c)];
    if ((p.lines & q.lines & r.lines) != 0) return 0;
    const double left = (p.point.x() - r.point.x()) * (q.point.y() - r.point.y()),
                 right = (p.point.y() - r.point.y()) * (q.point.x() - r.point.x());
    // Shewchuk's bound for the first stage (Adaptive precision floating-point arithmetic, 1997).
    if (std::abs(left - right) > 4e-16 * (std::abs(left) + std::abs(right)) + 1e-290)
      return left > right ? 1 : -1;
    return static_cast<int>(CGAL::orientation(Kernel::Point_2(p.point.x(), p.point.y()),
                                              Kernel::Point_2(q.point.x(), q.point.y()),
                                              Kernel::Point_2(r.point.x(), r.point.y())));
  }
  bool inClosedTriangle(Index a, Index b, Index c, Index p) const {
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
  }
  /// Squared sine of the least angle, negative where the triangle is turned over, 0 where it is flat.
  double quality(Index a, Index b, Index c) const {
    const Vec2 u = point(b) - point(a), v = point(c) - point(a), w = point(c) - point(b);
    const double area2 = u.x() * v.y() - u.y() * v.x();
    const double x = u.squaredNorm(), y = v.squaredNorm(), z = w.squaredNorm();
    // The two longest sides enclose the least angle.
    const double longest = std::max({x, y, z}), least = std::min({x, y, z});
    const double middle = std::max(std::min(x, y), std::min(std::max(x, y), z));
    return least > 0 ? area2 / longest * (std::abs(area2) / middle) : 0;
  }
  const Vec2& point(Index i) const { return corners_[at(i)].point; }
  std::uint32_t lines(Index i) const { return corners_[at(i)].lines; }
  std::uint32_t linesOfSides(Index a, Index b, Index c) const {
    return (lines(a) & lines(b)) | (lines(b) & lines(c)) | (lines(c) & lines(a));
  }

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

/// What lies across a triangle's sides: triangle · 3 + side, −1 for nothing.
using Links = std::vector<std::array<Index, 3>>;

/// Cuts ears off one loop, best first.
class EarCutter {
 public:
  void cut(const Plane& plane, const Loop& loop, PolygonTriangulation& out, Links& links) {
    plane_ = &plane;
    loop_ = loop;
    across_.assign(loop.size(), -1);
    quality_.resize(loop.size());
    points_.resize(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) points_[i] = plane.point(loop[i]);
    judgeAll();
    bool stale = false;  // are there ears judged before another ear was cut?
    while (loop_.size() > 3) {
      std::size_t best = bestEar();
      if (quality_[best] < 0 && stale) {
        judgeAll();
        stale = false;
        best = bestEar();
      }
      if (quality_[best] < 0) {
        best = leastBad();
        ++out.forced;
      }
      remove(best, out, links);
      stale = true;
    }
    if (plane_->turn(loop_[0], loop_[1], loop_[2]) <= 0) ++out.forced;
    emit(1, out, links);
    link(links, across_[2], static_cast<Index>(3 * out.triangles.size() - 1));
  }

 private:
  std::size_t previous(std::size_t i) const { return i == 0 ? loop_.size() - 1 : i - 1; }
  std::size_t next(std::size_t i) const { return i + 1 == loop_.size() ? 0 : i + 1; }
  Index before(std::size_t i) const { return loop_[previous(i)]; }
  Index after(std::size_t i) const { return loop_[next(i)]; }

  void judgeAll() {
    for (std::size_t i = 0; i < loop_.size(); ++i) quality_[i] = judge(i);
  }

  /// The ear's quality, or −1 where it is none.
  double judge(std::size_t i) const {
    const Index a = before(i), b = loop_[i], c = after(i);
    if (a == c || plane_->turn(a, b, c) <= 0) return -1;
    const Vec2 &p = points_[previous(i)], &q = points_[i], &r = points_[next(i)];
    const Vec2 low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
    const std::uint32_t sides = plane_->linesOfSides(a, b, c);
    for (std::size_t k = 0; k < loop_.size(); ++k) {
      const Vec2& x = points_[k];
      const Index corner = loop_[k];
      // Without branches, which would go either way.
      const bool isBeyond = (x.x() < low.x()) | (x.x() > high.x()) | (x.y() < low.y()) | (x.y() > high.y());
      // Rounding may have put a corner on one of the ear's sides beyond it.
      if (isBeyond && (plane_->lines(corner) & sides) == 0) continue;
      if (corner != a && corner != b && corner != c && plane_->inClosedTriangle(a, b, c, corner)) return -1;
    }
    return std::max(0.0, plane_->quality(a, b, c));
  }
  std::size_t bestEar() const {
    return static_cast<std::size_t>(std::max_element(quality_.begin(), quality_.end()) - quality_.begin());
  }
  std::size_t leastBad() const {
    std::size_t best = 0;
    double most = -1e300;
    for (std::size_t i = 0; i < loop_.size(); ++i) {
      const double q = before(i) == after(i) ? -1e200 : plane_->quality(before(i), loop_[i], after(i));
      if (q > most) most = q, best = i;
    }
    return best;
  }

  static void link(Links& links, Index one, Index other) {
    if (one >= 0) links[at(one / 3)][at(one % 3)] = other;
    if (other >= 0) links[at(other / 3)][at(other % 3)] = one;
  }

  void emit(std::size_t i, PolygonTriangulation& out, Links& links) const {
    const auto first = static_cast<Index>(3 * out.triangles.size());
    out.triangles.push_back({before(i), loop_[i], after(i)});
    links.push_back({-1, -1, -1});
    link(links, across_[previous(i)], first);
    link(links, across_[i], first + 1);
  }

  void remove(std::size_t i, PolygonTriangulation& out, Links& links) {
    emit(i, out, links);
    across_[previous(i)] = static_cast<Index>(3 * out.triangles.size() - 1);
    const auto gone = static_cast<std::ptrdiff_t>(i);
    loop_.erase(loop_.begin() + gone);
    across_.erase(across_.begin() + gone);
    quality_.erase(quality_.begin() + gone);
    points_.erase(points_.begin() + gone);
    const std::size_t n = loop_.size();
    for (const std::size_t k : {(i + n - 1) % n, i % n}) quality_[k] = judge(k);
  }

  const Plane* plane_ = nullptr;
  Loop loop_;
  std::vector<Index> across_;  ///< per slot: the side of a triangle beyond the edge to the next, −1 for none
  std::vector<double> quality_;
  std::vector<Vec2> points_;
};

/// Flips inner edges while that enlarges the least angle beside them.
class EdgeFlipper {
 public:
  void run(const Plane& plane, std::vector<Triangle>& triangles, Links& links) {
    const bool goodAlready = std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
      return plane.quality(t[0], t[1], t[2]) > kGoodAngle;
    });
    if (goodAlready) return;
    open_.clear();
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (Index side = 0; side < 3; ++side)
        if (links[t][at(side)] > static_cast<Index>(3 * t)) open_.push_back(static_cast<Index>(3 * t) + side);
    // Rounding could let flips go in circles.
    std::size_t left = 64 * triangles.size();
    while (!open_.empty() && left-- > 0) {
      const Index side = open_.back();
      open_.pop_back();
      if (links[at(side / 3)][at(side % 3)] >= 0) tryFlip(plane, triangles, links, side);
    }
  }

 private:
  void tryFlip(const Plane& plane, std::vector<Triangle>& triangles, Links& links, Index side) {
    const Index other = links[at(side / 3)][at(side % 3)];
    Triangle &left = triangles[at(side / 3)], &right = triangles[at(other / 3)];
    const std::size_t i = at(side % 3), j = at(other % 3);
    const Index a = left[i], b = left[(i + 1) % 3], c = left[(i + 2) % 3], d = right[(j + 2) % 3];
    if (c == d) return;
    const double now = std::min(plane.quality(a, b, c), plane.quality(b, a, d));
    const double then = std::min(plane.quality(d, b, c), plane.quality(c, a, d));
    if (then <= now * (1 + 1e-9) + 1e-300) return;
    if (plane.turn(d, b, c) <= 0 || plane.turn(c, a, d) <= 0) return;
    const Index bc = links[at(side / 3)][(i + 1) % 3], ca = links[at(side / 3)][(i + 2) % 3],
                ad = links[at(other / 3)][(j + 1) % 3], db = links[at(other / 3)][(j + 2) % 3];
    left = {d, b, c};
    right = {c, a, d};
    const Index l = 3 * (side / 3), r = 3 * (other / 3);
    const std::array<std::array<Index, 2>, 5> pairs{
        {{l, db}, {l + 1, bc}, {l + 2, r + 2}, {r, ca}, {r + 1, ad}}};
    for (const auto& [own, beyond] : pairs) {
      links[at(own / 3)][at(own % 3)] = beyond;
      if (beyond < 0) continue;
      links[at(beyond / 3)][at(beyond % 3)] = own;
      if (own != l + 2) open_.push_back(own);
    }
  }

  std::vector<Index> open_;  ///< sides to look at
};

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

struct PolygonTriangulator::Workspace {
  PolygonTriangulation result;
  Links links;
  EarCutter ears;
  EdgeFlipper flipper;

  void withHoles(const Plane& plane, std::span<const PlanarCorner> corners, std::span<const Loop> loops) {
    std::vector<Loop> outers, holes;
    for (const Loop& loop : loops) (loopArea2(corners, loop) >= 0 ? outers : holes).push_back(loop);
    if (outers.empty())
      outers.swap(holes);  // all areas rounded away: the triangles are as flat as the region
    std::vector<std::vector<Loop>> holesOf(outers.size());
    for (const Loop& hole : holes) {
      std::size_t owner = 0;
      for (std::size_t o = 0; o < outers.size() && outers.size() > 1; ++o)
        if (pointInLoop(plane, outers[o], plane.point(hole[0]))) owner = o;
      holesOf[owner].push_back(hole);
    }
    for (std::size_t o = 0; o < outers.size(); ++o) {
      for (std::size_t h = 0; h < holesOf[o].size(); ++h)
        if (!bridgeHole(plane, outers[o], holesOf[o][h], std::span(holesOf[o]).subspan(h + 1)))
          ++result.forced;
      ears.cut(plane, outers[o], result, links);
    }
  }
};

PolygonTriangulator::PolygonTriangulator() : workspace_(std::make_unique<Workspace>()) {}
PolygonTriangulator::~PolygonTriangulator() = default;
PolygonTriangulator::PolygonTriangulator(PolygonTriangulator&&) noexcept = default;
PolygonTriangulator& PolygonTriangulator::operator=(PolygonTriangulator&&) noexcept = default;

const PolygonTriangulation& PolygonTriangulator::triangulate(std::span<const PlanarCorner> corners,
                                                             std::span<const Loop> loops) {
  Workspace& w = *workspace_;
  w.result.triangles.clear();
  w.result.forced = 0;
  const Plane plane(corners);
  if (loops.size() == 1 && loops[0].size() == 3) {
    w.result.triangles.push_back({loops[0][0], loops[0][1], loops[0][2]});
    return w.result;
  }
  if (loops.size() == 1 && loops[0].size() == 4 && splitQuad(plane, loops[0], w.result.triangles))
    return w.result;
  w.links.clear();
  if (loops.size() == 1)
    w.ears.cut(plane, loops[0], w.result, w.links);
  else
    w.withHoles(plane, corners, loops);
  w.flipper.run(plane, w.result.triangles, w.links);
  return w.result;
}

}  // namespace sherd
