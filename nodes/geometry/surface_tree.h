// Closest points, rays and inside tests on a triangle surface (CGAL AABB tree, exact predicates).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

struct SurfacePoint {
  Index triangle = -1;
  Vec3 point = Vec3::Zero();        ///< m
  Vec3 barycentric = Vec3::Zero();  ///< in the triangle, sums to 1
  double distance = 0;              ///< m, from the query (along the ray, for rays)
};

/// Holds copies of what it needs. Building costs O(n log n); a query O(log n) on usual surfaces. Queries are
/// safe from several threads at once. Degenerate triangles are left out.
class SurfaceTree {
 public:
  SurfaceTree(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  ~SurfaceTree();
  SurfaceTree(SurfaceTree&&) noexcept;

  /// The closest point of the surface. Needs at least one triangle.
  SurfacePoint closest(const Vec3& query) const;
  /// The first hit of the ray (direction of any length) farther than `beyond` metres from its origin.
  std::optional<SurfacePoint> firstHit(const Vec3& origin, const Vec3& direction, double beyond = 0) const;
  /// Is the point strictly inside the closed surface (odd number of crossings)? Exact on the given doubles.
  bool contains(const Vec3& query) const;
  /// Does the closed triangle abc meet the surface, even in a point? Exact on the given doubles.
  bool meets(const Vec3& a, const Vec3& b, const Vec3& c) const;
  /// The surface's triangles that it meets, ascending.
  std::vector<Index> meeting(const Vec3& a, const Vec3& b, const Vec3& c) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
