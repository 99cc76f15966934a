// The part of one tetrahedron that lies inside a closed surface: its volume, and the integrals over it that
// quadratic elements need.
//
// With p a corner of T, F the face opposite p and h its distance, q a corner of F, E the edge of F opposite q
// and k its distance, r an end of E, the divergence theorem gives, three times,
//
//   3 V(S ∩ T) = Σ over surface triangles clipped to T of ∫ (x − p)·n dA + h A(S ∩ F)
//   2 A(S ∩ F) = Σ over segments of the surface in F of ∫ (x − q)·m ds + k L(S ∩ E)
//     L(S ∩ E) = Σ over crossings of E of ± their distance from r + [other end inside] |E|
//
// (faces through p, edges through q and the end r contribute nothing). Every term is the signed volume of a
// tetrahedron: (p, a piece of the surface), (p, q, a segment), (p, q, r, a crossing); so that any
// polynomial's integral over S ∩ T is the sum of its integrals over them.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "geometry/clipping.h"
#include "types/vec.h"

namespace sherd {

/// ∫ ξ_i ξ_j / volume, ξ the barycentric coordinates; its entries add up to the share of the volume.
using ShareProducts = Eigen::Matrix4d;

/// Of a whole tetrahedron.
ShareProducts wholeProducts();

/// The surface as one tetrahedron sees it. `held` (of both functions): the triangles that touch it;
/// `lastInside`: is its last corner inside the solid? Exact up to rounding; which segments and crossings
/// there are is decided so that neighbouring triangles agree. Cost O(held).
class TetShare {
 public:
  /// corners: positively oriented.
  TetShare(const std::array<Vec3, 4>& corners, std::span<const Vec3> positions,
           std::span<const Triangle> triangles);

  /// Volume of the part inside.
  double volume(std::span<const Index> held, bool lastInside) const;
  ShareProducts products(std::span<const Index> held, bool lastInside) const;

 private:
  class Sum;
  using Segment = std::array<Vec3, 2>;
  struct Clip {
    double begin, end;  ///< shares of a segment's length
  };
  Polygon clipped(const Triangle& t) const;
  Vec3 onFace(Index a, Index b, const Vec3& unit) const;
  std::optional<Segment> segment(const Triangle& t, const Vec3& unit) const;
  double faceArea(std::span<const Index> held, const Vec3& unit, bool lastInside) const;
  std::optional<Clip> clipToFace(const Segment& s, const Vec3& unit) const;
  double segmentFlux(const Segment& s, const Vec3& unit) const;
  double crossing(const Segment& s, const Vec3& along, const Vec3& outward) const;

  std::array<Vec3, 4> corner_;  ///< p, q, r, and the other end of E
  std::array<Vec3, 4> normal_;  ///< of the faces opposite, outward
  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
};

}  // namespace sherd
