// Signs and zeros of small determinants of functions that are affine in a tetrahedron, exact in the given
// doubles and never zero: the last stage of the predicates of the exact cells.
//
// Functions h: barycentric coordinates of the tetrahedron (times six volumes), and differences of site values
// g_plus − g_minus (site_values.h; times the same where points of the surface are concerned). Points: nodes
// of the tetrahedron, or vertices of the surface.
//
// Ties are those of one configuration in general position, however degenerate the input: the surface as a
// whole is thought of as moved by an infinitely small t = (t_x, t_y, t_z), t_x ≫ t_y ≫ t_z > 0, and the site
// values as lowered by still smaller ε_j by rank. A column h_c of a determinant over surface vertices becomes
// h_c + ∇h_c·t + (its ε), the same in every row, so that the determinant is linear in what is small:
//
//   det' = det + Σ_c (∇h_c·t + ε_c) det(column c ← 1)
//
// (two columns of ones make 0). The first of its coefficients that is not zero has the sign, in the order
// det, t_x, t_y, t_z, ε by rank. The same in the manner of Simulation of Simplicity (Edelsbrunner and Mücke
// 1990), with a translation instead of a displacement for each vertex: two parts of the surface that touch a
// sheet move to the same side.
#pragma once

#include <array>
#include <span>

#include "types/vec.h"

namespace sherd {

/// g_plus − g_minus by the values at the tetrahedron's four nodes, or the barycentric coordinate of corner
/// `corner`.
struct AffineFunction {
  int corner = -1;               ///< 0…3: that corner's barycentric coordinate; the rest is then unused
  Index plus = -1, minus = -1;   ///< ranks of sites
  const double* plusAt[4] = {};  ///< g of either at the nodes
  const double* minusAt[4] = {};
};

/// Sign of det[f_c(node_r)], rows by `nodes` (local corners 0…3), columns by `functions` (differences only);
/// as many of the one as of the other, at most four.
int nodeDeterminantSign(std::span<const int> nodes, std::span<const AffineFunction> functions);

/// Weights, summing to one, of the point of the simplex over `nodes` where all `functions` (one fewer;
/// differences only) vanish: the limit for small changes, which the caller knows to lie in the simplex. The
/// rest is 0.
std::array<double, 4> nodeWeights(std::span<const int> nodes, std::span<const AffineFunction> functions);

/// Sign of det[f_c(point_r)] for one to three vertices of the surface.
int vertexDeterminantSign(const std::array<Vec3, 4>& tet, std::span<const Vec3> points,
                          std::span<const AffineFunction> functions);

/// Weights, summing to one, of the point of the edge or triangle over `points` where all `functions` (one
/// fewer) vanish: the limit for small changes, which the caller knows to lie in it. The rest is 0.
std::array<double, 3> vertexWeights(const std::array<Vec3, 4>& tet, std::span<const Vec3> points,
                                    std::span<const AffineFunction> functions);

/// Orders the points at which edge pq (points[0], points[1]) meets f = 0 in one tetrahedron and g = 0 in
/// another, both between p and q: −1 where the first comes first seen from p, 0 only where f and g are one
/// plane.
int compareAlongEdge(std::span<const Vec3> points, const std::array<Vec3, 4>& tetOfF, const AffineFunction& f,
                     const std::array<Vec3, 4>& tetOfG, const AffineFunction& g);

/// On which side of the plane of triangle `other` the line f = g = 0 meets `triangle`: +1 in front (where its
/// corners turn counter-clockwise), −1 behind, 0 only where both are in one plane.
int sideOfMeeting(const std::array<Vec3, 4>& tet, const AffineFunction& f, const AffineFunction& g,
                  std::span<const Vec3> triangle, std::span<const Vec3> other);

}  // namespace sherd
