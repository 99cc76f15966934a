// Exact predicates on numbered points, with a consistent answer for every degenerate case.
//
// Orientations are those of the given doubles, exact (CGAL's filtered predicates). Where four points are
// coplanar the answer is that of infinitely small displacements, so that any set of answers belongs to one
// set of points in general position: two surfaces that touch, or share a plane, cut each other cleanly all
// the same. For two bodies of points the first is thought of as moved as a whole by (t, t², t³), t → 0; where
// that decides nothing, and for one body, each point is displaced by its number (Simulation of Simplicity,
// Edelsbrunner and Mücke 1990).
#pragma once

#include <span>

#include "types/vec.h"

namespace sherd {

class ExactPoints {
 public:
  /// Keeps a reference to `points`, whose order numbers them. Finite coordinates.
  explicit ExactPoints(std::span<const Vec3> points) : points_(points) {}
  /// The points below `firstFixed` are the body that is moved.
  ExactPoints(std::span<const Vec3> points, Index firstFixed) : points_(points), firstFixed_(firstFixed) {}

  const Vec3& operator[](Index i) const { return points_[at(i)]; }

  /// +1 where det[b−a, c−a, d−a] > 0 after displacement, else −1. The four numbers differ.
  int orientation(Index a, Index b, Index c, Index d) const;

  /// On which side of triangle t the point p lies: +1 in front (where its corners turn counter-clockwise), −1
  /// behind.
  int side(const Triangle& t, Index p) const { return orientation(t[0], t[1], t[2], p); }

  /// Does the segment pq cross the triangle? All five numbers differ. Never "just touches".
  bool crosses(Index p, Index q, const Triangle& t) const;

  /// Orders the crossings of segment pq with the planes of two triangles that it crosses: −1 where s comes
  /// first seen from p, +1 where t does, 0 where both lie at the very same point (of the given doubles; for
  /// two bodies, one of the segment and the other of the triangles, also after the move).
  int compareCrossings(Index p, Index q, const Triangle& s, const Triangle& t) const;

  /// The point where pq crosses the triangle's plane, rounded; the same for (p, q) and (q, p). Lies on the
  /// segment, and keeps a coordinate that both ends, or all corners of the triangle, share.
  Vec3 crossing(Index p, Index q, const Triangle& t) const;

 private:
  bool isMoved(Index i) const { return i < firstFixed_; }

  std::span<const Vec3> points_;
  Index firstFixed_ = 0;
};

}  // namespace sherd
