#include "embed/convexity.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include "geometry/solid.h"

namespace sherd {

Result<double> convexHullVolume(std::span<const Vec3> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  try {
    std::vector<Kernel::Point_3> input;
    input.reserve(points.size());
    for (const Vec3& p : points) input.emplace_back(p.x(), p.y(), p.z());
    if (input.size() < 4) return 0.0;
    Mesh hull;
    CGAL::convex_hull_3(input.begin(), input.end(), hull);
    std::vector<Vec3> positions;
    for (const auto v : hull.vertices()) {
      const auto& p = hull.point(v);
      positions.emplace_back(p.x(), p.y(), p.z());
    }
    std::vector<Triangle> triangles;
    for (const auto f : hull.faces()) {
      Triangle triangle{};
      std::size_t c = 0;
      for (const auto v : hull.vertices_around_face(hull.halfedge(f)))
        if (c < 3) triangle[c++] = static_cast<Index>(v.idx());
      if (c == 3) triangles.push_back(triangle);
    }
    return triangles.size() < 4 ? 0.0 : std::abs(solidVolume(positions, triangles));
  } catch (const std::exception& e) {
    return failure(std::string("the convex hull could not be computed: ") + e.what(), {}, "metric");
  }
}

}  // namespace sherd
