// Closed surfaces clipped by half spaces, for volumes and for the points of what is left.
#pragma once

#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// Keeps the side normal · (x − origin) ≤ 0.
struct CutPlane {
  Vec3 origin;
  Vec3 normal;  ///< unit
  double height(const Vec3& x) const { return normal.dot(x - origin); }
  CutPlane turned() const { return {origin, -normal}; }
};

/// Convex polygons, one after the other.
struct PolygonList {
  std::vector<Vec3> corners;
  std::vector<std::size_t> ends;  ///< per polygon: one past its last corner

  std::size_t size() const { return ends.size(); }
  std::span<const Vec3> polygon(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return {corners.data() + begin, ends[i] - begin};
  }
};

/// What a closed surface and half spaces have in common, as a chain of oriented polygons. Sections are closed
/// by fans of triangles (caps, one per plane), which may reach out of the solid and over each other; their
/// signs make volumes right. Where a plane crosses a cap, only the ends of their common segments count, so
/// that the number of polygons does not multiply with the number of cuts.
class ClippedSolid {
 public:
  ClippedSolid(std::span<const Vec3> positions, std::span<const Triangle> triangles);

  /// The part on the plane's kept side. Cost O(polygons), and a sort of what it crosses.
  ClippedSolid clipped(const CutPlane& plane) const;
  /// m³. Exact up to rounding.
  double volume() const;
  /// The surface itself, without sections. Polygons within a cutting plane are not among them.
  const PolygonList& skin() const { return skin_; }
  const std::vector<CutPlane>& planes() const { return planes_; }
  /// Does the plane cut nothing off?
  bool within(const CutPlane& plane) const;
  bool empty() const;
  /// Of the surface and of all caps.
  std::size_t polygons() const;

 private:
  ClippedSolid() = default;
  PolygonList skin_;
  std::vector<PolygonList> caps_;  ///< one per plane
  Vec3 reference_ = Vec3::Zero();  ///< that volumes are summed about
  double size_ = 0;
  std::vector<CutPlane> planes_;
};

}  // namespace sherd
