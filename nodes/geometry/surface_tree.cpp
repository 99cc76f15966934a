#include "geometry/surface_tree.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <vector>

#include "base/rng.h"

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 toPoint(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
Vec3 toVec(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct SurfaceTree::Impl {
  Triangles triangles;
  std::vector<Index> original;  ///< per kept triangle, its number in the input
  Tree tree;
  Box box;

  SurfacePoint locate(Triangles::const_iterator found, const Kernel::Point_3& point, double distance) const {
    SurfacePoint result;
    result.triangle = original[static_cast<std::size_t>(found - triangles.begin())];
    result.point = toVec(point);
    result.distance = distance;
    const Vec3 a = toVec((*found)[0]), b = toVec((*found)[1]), c = toVec((*found)[2]);
    const Vec3 normal = (b - a).cross(c - a);
    const double area2 = normal.squaredNorm();
    const double wb = (result.point - a).cross(c - a).dot(normal) / area2;
    const double wc = (b - a).cross(result.point - a).dot(normal) / area2;
    Vec3 w = Vec3(1 - wb - wc, wb, wc).cwiseMax(0.0);
    result.barycentric = w / w.sum();
    return result;
  }
};

SurfaceTree::SurfaceTree(std::span<const Vec3> positions, std::span<const Triangle> triangles)
    : impl_(std::make_unique<Impl>()) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Kernel::Triangle_3 triangle(toPoint(positions[at(triangles[t][0])]),
                                      toPoint(positions[at(triangles[t][1])]),
                                      toPoint(positions[at(triangles[t][2])]));
    if (triangle.is_degenerate()) continue;
    impl_->triangles.push_back(triangle);
    impl_->original.push_back(static_cast<Index>(t));
    for (int c = 0; c < 3; ++c) impl_->box.add(toVec(triangle[c]));
  }
  impl_->tree.insert(impl_->triangles.begin(), impl_->triangles.end());
  impl_->tree.build();
  impl_->tree.accelerate_distance_queries();
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;

SurfacePoint SurfaceTree::closest(const Vec3& query) const {
  const auto [point, found] = impl_->tree.closest_point_and_primitive(toPoint(query));
  return impl_->locate(found, point, (toVec(point) - query).norm());
}

std::optional<SurfacePoint> SurfaceTree::firstHit(const Vec3& origin, const Vec3& direction,
                                                  double beyond) const {
  const Vec3 unit = direction.normalized();
  const Kernel::Ray_3 ray(toPoint(origin), Kernel::Vector_3(unit.x(), unit.y(), unit.z()));
  std::vector<Tree::Intersection_and_primitive_id<Kernel::Ray_3>::Type> hits;
  impl_->tree.all_intersections(ray, std::back_inserter(hits));
  std::optional<SurfacePoint> best;
  for (const auto& [where, found] : hits) {
    const auto* point = boost::get<Kernel::Point_3>(&where);
    if (point == nullptr) continue;  // the ray runs within the triangle's plane: its neighbours are hit too
    const double distance = (toVec(*point) - origin).dot(unit);
    if (distance > beyond && (!best || distance < best->distance))
      best = impl_->locate(found, *point, distance);
  }
  return best;
}

bool SurfaceTree::contains(const Vec3& query) const {
  if ((query.array() <= impl_->box.low.array()).any() || (query.array() >= impl_->box.high.array()).any())
    return false;
  // Segments to points outside of the box, in fixed pseudo-random directions, until one meets no vertex, edge
  // or coplanar triangle; then the parity of its crossings is exact.
  const Kernel::Point_3 point = toPoint(query);
  Rng rng(0x5eed);
  const double reach = 2 * impl_->box.diagonal();
  std::vector<Tree::Primitive_id> crossed;
  for (int attempt = 0; attempt < 64; ++attempt) {
    Vec3 direction;
    do {
      direction = Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
    } while (direction.squaredNorm() < 0.01);
    const Kernel::Point_3 far = toPoint(query + reach * direction.normalized());
    crossed.clear();
    impl_->tree.all_intersected_primitives(Kernel::Segment_3(point, far), std::back_inserter(crossed));
    bool clean = true;
    for (const auto& id : crossed) {
      const Kernel::Triangle_3& t = *id;
      for (int i = 0; clean && i < 3; ++i)
        clean = CGAL::orientation(point, far, t[i], t[(i + 1) % 3]) != CGAL::COPLANAR;
      clean = clean && CGAL::orientation(t[0], t[1], t[2], point) != CGAL::COPLANAR;
    }
    if (clean) return crossed.size() % 2 == 1;
  }
  return false;  // on the surface: every segment from it meets a coplanar triangle
}

bool SurfaceTree::meets(const Vec3& a, const Vec3& b, const Vec3& c) const {
  return impl_->tree.do_intersect(Kernel::Triangle_3(toPoint(a), toPoint(b), toPoint(c)));
}

std::vector<Index> SurfaceTree::meeting(const Vec3& a, const Vec3& b, const Vec3& c) const {
  std::vector<Tree::Primitive_id> met;
  impl_->tree.all_intersected_primitives(Kernel::Triangle_3(toPoint(a), toPoint(b), toPoint(c)),
                                         std::back_inserter(met));
  std::vector<Index> triangles;
  for (const auto& id : met)
    triangles.push_back(impl_->original[static_cast<std::size_t>(id - impl_->triangles.begin())]);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace sherd
