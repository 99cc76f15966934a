#include "geometry/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>

#include "base/parallel.h"
#include "geometry/box_tree.h"

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

constexpr std::size_t kBlock = 1024;  ///< triangles per block: what the limit counts for

/// The surface in CGAL's terms.
struct Soup {
  std::vector<Point> points;
  std::span<const Triangle> triangles;
  std::vector<bool> flat;

  const Point& corner(Index t, int c) const {
    return points[at(triangles[at(t)][static_cast<std::size_t>(c % 3)])];
  }
  Kernel::Triangle_3 triangle(Index t) const { return {corner(t, 0), corner(t, 1), corner(t, 2)}; }
};

std::vector<Point> toPoints(std::span<const Vec3> positions) {
  std::vector<Point> points;
  points.reserve(positions.size());
  for (const Vec3& p : positions) points.emplace_back(p.x(), p.y(), p.z());
  return points;
}

/// Triangles abc and bad share edge ab. They overlap where they are folded onto each other in one plane.
bool foldedTogether(const Point& a, const Point& b, const Point& c, const Point& d) {
  return CGAL::orientation(a, b, c, d) == CGAL::COPLANAR &&
         CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
}

/// Triangles s and t share one corner (numbers i and j). What they have in common is convex and holds that
/// corner; if it is more, it reaches the edge opposite the corner in one of the two.
bool meetBeyondCorner(const Soup& soup, Index s, int i, Index t, int j) {
  const Kernel::Triangle_3 first = soup.triangle(s), second = soup.triangle(t);
  // Most pairs are neighbours on a smooth surface: the rest of one lies strictly on one side of the other.
  const auto side = CGAL::orientation(second[0], second[1], second[2], soup.corner(s, i + 1));
  if (side != CGAL::COPLANAR &&
      side == CGAL::orientation(second[0], second[1], second[2], soup.corner(s, i + 2)))
    return false;
  const Kernel::Segment_3 opposite(soup.corner(s, i + 1), soup.corner(s, i + 2));
  if (CGAL::do_intersect(opposite, second)) return true;
  return CGAL::do_intersect(Kernel::Segment_3(soup.corner(t, j + 1), soup.corner(t, j + 2)), first);
}

bool intersect(const Soup& soup, Index s, Index t) {
  int shared = 0, ofS = 0, ofT = 0;  // sums of the shared corners' numbers
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (soup.triangles[at(s)][static_cast<std::size_t>(i)] ==
          soup.triangles[at(t)][static_cast<std::size_t>(j)])
        ++shared, ofS += i, ofT += j;
  if (shared == 3) return false;
  if (shared == 0) return CGAL::do_intersect(soup.triangle(s), soup.triangle(t));
  if (shared == 1) return meetBeyondCorner(soup, s, ofS, t, ofT);
  const int apex = 3 - ofS;  // the corner that is not shared
  return foldedTogether(soup.corner(s, apex + 1), soup.corner(s, apex + 2), soup.corner(s, apex),
                        soup.corner(t, 3 - ofT));
}

/// What one block of triangles meets among those with higher numbers.
struct Block {
  std::vector<std::array<Index, 2>> pairs;
  bool more = false;
};

std::vector<Block> meetings(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                            const Exec& exec, std::size_t limit) {
  Soup soup{toPoints(positions), triangles, std::vector<bool>(triangles.size(), false)};
  for (const Index t : zeroAreaTriangles(positions, triangles)) soup.flat[at(t)] = true;
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
    for (const Index v : triangles[t]) boxes[t].add(positions[at(v)]);
  const BoxTree tree(boxes);

  std::vector<Block> blocks((triangles.size() + kBlock - 1) / kBlock);
  parallelFor(exec, triangles.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    Block& found = blocks[begin / kBlock];
    for (std::size_t i = begin; i < end && !found.more && !exec.cancelled(); ++i) {
      const auto s = static_cast<Index>(i);
      if (soup.flat[i]) continue;
      tree.visitOverlaps(boxes[i], [&](Index t) {
        if (t <= s || soup.flat[at(t)] || found.more || !intersect(soup, s, t)) return;
        found.pairs.push_back({s, t});
        found.more = found.pairs.size() >= limit;
      });
    }
  });
  for (Block& block : blocks) std::sort(block.pairs.begin(), block.pairs.end());
  return blocks;
}

}  // namespace

SelfIntersections findSelfIntersections(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                        const Exec& exec, std::size_t limit) {
  SelfIntersections result;
  for (const Block& block : meetings(positions, triangles, exec, limit)) {
    if (result.pairs == 0 && !block.pairs.empty()) result.first = block.pairs[0];
    result.pairs += block.pairs.size();
    result.more = result.more || block.more;
  }
  return result;
}

IntersectingPairs intersectingPairs(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                    const Exec& exec, std::size_t limit) {
  IntersectingPairs result;
  for (const Block& block : meetings(positions, triangles, exec, limit)) {
    result.pairs.insert(result.pairs.end(), block.pairs.begin(), block.pairs.end());
    result.more = result.more || block.more;
  }
  return result;
}

bool trianglesMeet(std::span<const Vec3> positions, const Triangle& s, const Triangle& t) {
  std::array<Triangle, 2> pair{s, t};
  Soup soup{{}, pair, {}};
  std::vector<Index> corners;
  for (Triangle& triangle : pair)
    for (Index& v : triangle) {
      const auto known = std::find(corners.begin(), corners.end(), v);
      const auto number = static_cast<Index>(known - corners.begin());
      if (known == corners.end()) {
        const Vec3& p = positions[at(v)];
        soup.points.emplace_back(p.x(), p.y(), p.z());
        corners.push_back(v);
      }
      v = number;
    }
  return intersect(soup, 0, 1);
}

std::vector<Index> zeroAreaTriangles(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  const std::vector<Point> points = toPoints(positions);
  std::vector<Index> flat;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (CGAL::collinear(points[at(a)], points[at(b)], points[at(c)])) flat.push_back(static_cast<Index>(t));
  }
  return flat;
}

}  // namespace sherd
