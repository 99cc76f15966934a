#include "repair/holes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <map>

#include "geometry/edge_table.h"

namespace sherd {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

/// Where the facets that close the surface have to run, as a list of edges to leave each vertex by.
class Borders {
 public:
  explicit Borders(const Patchwork& surface) {
    const EdgeTable edges = buildEdgeTable(surface.triangles, surface.positions.size());
    std::vector<int> balance(edges.ends.size(), 0);  // uses from ends[0] to ends[1], minus those back
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c)
        balance[at(edges.ofTriangle[t][static_cast<std::size_t>(c)])] +=
            edges.forward(surface.triangles, static_cast<Index>(t), c) ? 1 : -1;
    for (std::size_t e = 0; e < balance.size(); ++e) {
      const auto [a, b] = edges.ends[e];
      for (int k = 0; k < std::abs(balance[e]); ++k) balance[e] > 0 ? leave(b, a) : leave(a, b);
    }
    if (leaving_.empty()) return;
    // What lies at the border: for the attributes, and for how the filling goes on from there.
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const Triangle& v = surface.triangles[t];
        if (leaving_.contains(v[c]) && leaving_.contains(v[(c + 1) % 3]))
          across_.try_emplace({v[(c + 1) % 3], v[c]}, v[(c + 2) % 3]);
        if (leaving_.contains(surface.triangles[t][c]))
          beside_.try_emplace(surface.triangles[t][c], originOf(surface.facets[t], c),
                              surface.facets[t].from);
      }
  }

  /// The next closed walk without a vertex that comes twice; empty when there is none left.
  std::vector<Index> next() {
    if (path_.empty()) {
      const auto start =
          std::find_if(leaving_.begin(), leaving_.end(), [](const auto& l) { return !l.second.empty(); });
      if (start == leaving_.end()) return {};
      path_.push_back(start->first);
    }
    for (;;) {
      const Index to = take(path_.back());
      const auto again = std::find(path_.begin(), path_.end(), to);
      if (again == path_.end()) {
        path_.push_back(to);
        continue;
      }
      std::vector<Index> loop(again, path_.end());
      path_.erase(again + 1, path_.end());
      if (path_.size() == 1 && leaving_.at(to).empty()) path_.clear();
      return loop;
    }
  }
  /// The third corner of the face that borders on the way from a to b.
  Index across(Index a, Index b) const { return across_.at({a, b}); }
  const std::pair<CornerOrigin, Index>& beside(Index v) const { return beside_.at(v); }

 private:
  void leave(Index from, Index to) { leaving_[from].push_back(to); }
  Index take(Index from) {
    std::vector<Index>& ways = leaving_.at(from);
    const Index to = ways.back();
    ways.pop_back();
    return to;
  }

  std::map<Index, std::vector<Index>> leaving_;
  std::vector<Index> path_;  ///< walked, and not yet part of a loop
  std::map<std::array<Index, 2>, Index> across_;
  std::map<Index, std::pair<CornerOrigin, Index>> beside_;
};

/// Where no Delaunay triangulation holds a filling, CGAL takes time with the third power.
constexpr std::size_t kLongBorder = 500;

/// Triangles between corners 0 … n − 1 of the loop, along its direction.
std::vector<Triangle> strip(const std::vector<Vec3>& loop) {
  std::vector<Triangle> triangles;
  std::size_t low = 0, high = loop.size() - 1;
  while (high - low > 1) {
    const bool up = (loop[low + 1] - loop[high]).squaredNorm() <= (loop[low] - loop[high - 1]).squaredNorm();
    const std::size_t middle = up ? low + 1 : high - 1;
    triangles.push_back({static_cast<Index>(low), static_cast<Index>(middle), static_cast<Index>(high)});
    (up ? low : high) = middle;
  }
  return triangles;
}

/// `third`: for each edge of the loop the third corner of the face on its other side.
std::vector<Triangle> triangulated(const std::vector<Vec3>& loop, const std::vector<Vec3>& third) {
  if (loop.size() == 3) return {{0, 1, 2}};
  if (loop.size() > kLongBorder) return strip(loop);
  std::vector<Point> points, beyond;
  for (const Vec3& p : loop) points.emplace_back(p.x(), p.y(), p.z());
  for (const Vec3& p : third) beyond.emplace_back(p.x(), p.y(), p.z());
  std::vector<CGAL::Triple<int, int, int>> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, beyond, std::back_inserter(found));
  if (found.size() + 2 != loop.size()) return strip(loop);
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : found) {
    triangles.push_back({a, b, c});
    std::sort(triangles.back().begin(), triangles.back().end());  // along the loop
  }
  return triangles;
}

}  // namespace

std::vector<Hole> fillHoles(Patchwork& surface, const Exec& exec) {
  std::vector<Hole> holes;
  Borders borders(surface);
  for (auto loop = borders.next(); !loop.empty() && !exec.cancelled(); loop = borders.next()) {
    if (loop.size() < 3) continue;  // there and back
    std::vector<Vec3> points, third;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      points.push_back(surface.positions[at(loop[k])]);
      third.push_back(surface.positions[at(borders.across(loop[k], loop[(k + 1) % loop.size()]))]);
    }
    holes.push_back({loop.size(), boxOf(points).diagonal(), points[0]});
    for (const Triangle& t : triangulated(points, third)) {
      const Triangle corners{loop[at(t[0])], loop[at(t[1])], loop[at(t[2])]};
      Facet facet;
      for (std::size_t c = 0; c < 3; ++c) facet.base[c] = borders.beside(corners[c]).first;
      facet.from = borders.beside(corners[0]).second;
      facet.isNew = true;
      surface.add(corners, facet);
    }
  }
  return holes;
}

}  // namespace sherd
