// The solid that a sheet stands on.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/surface_tree.h"
#include "repair/patchwork.h"

namespace sherd {

/// The triangles of a surface but for those of sheets, as what a sheet hangs on, lies on or lies in. Closed,
/// however it faces. Holds copies of what it needs. Queries cost O(log n) on usual surfaces.
class Footing {
 public:
  /// `isSheet` for each triangle of `surface`. At least one is none.
  Footing(const Patchwork& surface, const std::vector<bool>& isSheet);

  double diagonal() const { return box_.diagonal(); }  ///< m
  /// Is the point no farther than `distance` (m) from the solid's surface?
  bool isNear(const Vec3& p, double distance) const;
  /// Is the point in the solid or on it?
  bool holds(const Vec3& p) const;

  /// How far a point of a sheet's border has to be moved so that a slab of `thickness` (m) around the sheet,
  /// whose normal there is `normal`, overlaps the solid rather than touching it: zero where the solid is half
  /// a thickness away or more, or lies flat under the sheet; else along the mean normal of the solid's faces
  /// at the nearest point, into the solid.
  Vec3 reach(const Vec3& p, const Vec3& normal, double thickness) const;

 private:
  /// Of unit length; the faces' at the nearest point, each direction counted once.
  Vec3 normalAt(const Vec3& nearest) const;

  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;
  Box box_;
  SurfaceTree tree_;
  std::vector<Box> boxes_;
  BoxTree boxTree_;
};

}  // namespace sherd
