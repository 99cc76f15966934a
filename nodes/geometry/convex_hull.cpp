#include "geometry/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "geometry/disjoint_sets.h"
#include "geometry/solid.h"

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

bool inOnePlane(const std::vector<Point>& points) {
  std::size_t i = 0;
  while (i < points.size() && points[i] == points[0]) ++i;
  std::size_t j = i + 1;
  while (j < points.size() && CGAL::collinear(points[0], points[i], points[j])) ++j;
  std::size_t k = j + 1;
  while (k < points.size() && CGAL::coplanar(points[0], points[i], points[j], points[k])) ++k;
  return k >= points.size();
}

/// Quickhull's order of vertices and facets, its triangles within a flat facet, and which points within
/// facets it keeps, depend on the addresses of what it allocates. Brings its result into one form for one
/// hull.
class Canonical {
 public:
  explicit Canonical(const Mesh& mesh) {
    for (const auto v : mesh.vertices()) points_.push_back(mesh.point(v));
    std::vector<Index> order(points_.size()), number(points_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return points_[at(a)] < points_[at(b)]; });
    std::vector<Point> sorted;
    for (std::size_t i = 0; i < order.size(); ++i) {
      number[at(order[i])] = static_cast<Index>(i);
      sorted.push_back(points_[at(order[i])]);
    }
    points_ = std::move(sorted);
    for (const auto face : mesh.faces()) {
      std::vector<Index> ring;
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(face)))
        ring.push_back(number[static_cast<std::size_t>(v.idx())]);
      for (std::size_t c = 2; c < ring.size(); ++c) triangles_.push_back({ring[0], ring[c - 1], ring[c]});
    }
  }

  HullMesh run(bool flat) {
    gatherFacets();
    std::vector<Triangle> fans;
    for (auto& [facet, next] : boundary_) addFan(next, flat, fans);
    std::sort(fans.begin(), fans.end());
    HullMesh hull;
    hull.flat = flat;
    std::vector<Index> number(points_.size(), -1);
    for (const Triangle& t : fans)
      for (const Index v : t) number[at(v)] = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<Index>(hull.positions.size());
      hull.positions.emplace_back(points_[v].x(), points_[v].y(), points_[v].z());
    }
    for (const Triangle& t : fans)
      hull.triangles.push_back({number[at(t[0])], number[at(t[1])], number[at(t[2])]});
    if (!flat) hull.volume = solidVolume(hull.positions, hull.triangles);
    return hull;
  }

 private:
  using Sides = std::map<std::pair<Index, Index>, Index>;  ///< directed edge to triangle

  Index tip(Index t, Index a, Index b) const {
    for (const Index v : triangles_[at(t)])
      if (v != a && v != b) return v;
    return a;
  }

  /// Joins triangles of one plane; keeps per facet its boundary, from each corner to the next.
  void gatherFacets() {
    Sides sides;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        sides[{triangles_[t][c], triangles_[t][(c + 1) % 3]}] = static_cast<Index>(t);
    DisjointSets facets(std::max(triangles_.size(), std::size_t{1}));
    for (const auto& [edge, t] : sides) {
      const auto& [a, b] = edge;
      const auto other = sides.find({b, a});
      if (a > b || other == sides.end()) continue;
      if (CGAL::coplanar(points_[at(a)], points_[at(b)], points_[at(tip(t, a, b))],
                         points_[at(tip(other->second, a, b))]))
        facets.join(at(t), at(other->second));
    }
    for (const auto& [edge, t] : sides) {
      const auto other = sides.find({edge.second, edge.first});
      const std::size_t facet = facets.find(at(t));
      if (other == sides.end() || facets.find(at(other->second)) != facet)
        boundary_[facet][edge.first] = edge.second;
    }
  }

  void addFan(std::map<Index, Index>& next, bool flat, std::vector<Triangle>& fans) const {
    std::vector<Index> loop{next.begin()->first};
    for (Index v = next.at(loop[0]); v != loop[0] && loop.size() <= next.size(); v = next.at(v))
      loop.push_back(v);
    std::vector<Index> ring;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::size_t n = loop.size();
      if (!CGAL::collinear(points_[at(loop[(i + n - 1) % n])], points_[at(loop[i])],
                           points_[at(loop[(i + 1) % n])]))
        ring.push_back(loop[i]);
    }
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    for (std::size_t c = 2; c < ring.size(); ++c) {
      fans.push_back({ring[0], ring[c - 1], ring[c]});
      if (flat) fans.push_back({ring[0], ring[c], ring[c - 1]});
    }
  }

  std::vector<Point> points_;  ///< ascending
  std::vector<Triangle> triangles_;
  std::map<std::size_t, std::map<Index, Index>> boundary_;  ///< per facet
};

}  // namespace

Result<HullMesh> convexHull(std::span<const Vec3> points) {
  std::vector<Point> input;
  input.reserve(points.size());
  for (const Vec3& p : points) {
    if (!p.allFinite())
      return failure("a point of the convex hull is not a finite number", "repair the surface");
    input.emplace_back(p.x(), p.y(), p.z());
  }
  if (input.empty()) return HullMesh{.positions = {}, .triangles = {}, .flat = true};
  try {
    Mesh mesh;
    CGAL::convex_hull_3(input.begin(), input.end(), mesh);
    return Canonical(mesh).run(inOnePlane(input));
  } catch (const std::exception& e) {
    return failure(std::string("the convex hull could not be computed: ") + e.what());
  }
}

}  // namespace sherd
