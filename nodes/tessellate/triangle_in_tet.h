// One surface triangle against the sheet polygons of one tetrahedron.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "geometry/approx.h"
#include "tessellate/envelope.h"
#include "tessellate/symbolic_sign.h"

namespace sherd {

/// The tetrahedron's barycentric coordinates (times six volumes) as doubles, and its nodes' site values.
struct TetFrame {
  std::array<Vec3, 4> corners;
  std::array<Vec3, 4> base, inward;  ///< coordinate i of a point p is inward[i] · (p − base[i])
  double longest = 0;                ///< m, largest extent along an axis
  double error = 0;                  ///< of a coordinate, per metre of ‖p − base‖₁
  std::array<const double*, 4> g{};

  TetFrame(const TetMesh& tets, const SiteValues& values, Index tet);

  std::array<Approx, 4> coordinates(const Vec3& point) const;
  /// g_plus − g_minus, times six volumes, at a point with these coordinates.
  Approx difference(const std::array<Approx, 4>& coordinates, Index plus, Index minus) const;
  AffineFunction differenceFunction(Index plus, Index minus) const;
  static AffineFunction cornerFunction(int corner);
  /// Sign of g_plus − g_minus at a surface vertex, with ties.
  int sign(const Vec3& vertex, const std::array<Approx, 4>& coordinates, Index plus, Index minus) const;
};

/// g_front − g_back in a tetrahedron, times six volumes, as one plane: a first and cheap look.
struct SheetPlane {
  Vec3 base, normal;
  double offset = 0, error = 0, errorAtBase = 0;

  SheetPlane(const TetFrame& frame, Index back, Index front);
  Approx value(const Vec3& point) const {
    const Vec3 d = point - base;
    return {normal.dot(d) + offset, error * d.cwiseAbs().sum() + errorAtBase};
  }
  /// Do the points certainly lie on one side?
  bool misses(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 p = a - base, q = b - base, r = c - base;
    const double x = normal.dot(p) + offset, y = normal.dot(q) + offset, z = normal.dot(r) + offset;
    const double reach = std::max({p.cwiseAbs().sum(), q.cwiseAbs().sum(), r.cwiseAbs().sum()});
    const double bound = error * reach + errorAtBase;
    return std::min({x, y, z}) > bound || std::max({x, y, z}) < -bound;
  }
};

/// An end of a segment: on side `side` of the triangle, or else on the polygon's edge number `slot`.
struct SegmentEnd {
  int side = -1;
  Index slot = -1;
};

class TriangleInTet {
 public:
  TriangleInTet(const TetFrame& frame, const Triangle& corners, std::span<const Vec3> positions);

  /// Finds the segment in which the triangle meets the polygon between `back` and `front` with these edge
  /// lines, directed so that the back cell is on its left; false where they miss each other.
  bool meets(Index back, Index front, std::span<const SheetEdgeLine> lines, SegmentEnd& from, SegmentEnd& to);

  /// As meets() does first: takes this polygon for what follows.
  void take(Index back, Index front, std::span<const SheetEdgeLine> lines);

  /// Sign of g_front − g_back of the last polygon at a corner.
  int signAtCorner(std::size_t corner) const { return signs_[corner]; }
  /// Weights of the corners in an end of the last polygon's segment, so that the point that they give is off
  /// by no more than `tolerance` (m) and the rounding of its coordinates.
  std::array<double, 3> weights(const SegmentEnd& end, double tolerance) const;

 private:
  static constexpr int kSheet = -1;  ///< the function g_front − g_back; from 0 on an edge line's

  Approx value(int function, std::size_t corner) const;
  AffineFunction affine(int function) const;
  int determinantSign(std::span<const std::size_t> corners, std::span<const int> functions) const;
  int signAtEnd(const SegmentEnd& end, int function) const;

  const TetFrame& frame_;
  std::array<Vec3, 3> vertices_;
  std::array<std::array<Approx, 4>, 3> coordinates_;
  Index back_ = -1, front_ = -1;
  std::span<const SheetEdgeLine> lines_;
  std::array<Approx, 3> sheet_;
  std::array<int, 3> signs_{};
};

}  // namespace sherd
