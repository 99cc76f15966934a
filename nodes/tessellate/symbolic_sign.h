// Signs and zeros of small determinants of functions that are affine in a tetrahedron, exact in the given
// doubles and never zero: the last stage of the predicates of the exact cells.
//
// Functions: barycentric coordinates of the tetrahedron (times six volumes), and differences of site values
// g_plus − g_minus (site_values.h; times the same where points of the surface are concerned). Points: nodes
// of the tetrahedron, or vertices of the surface. Where a determinant of the given doubles is zero, its sign
// is that under displacements of the surface's vertices, ordered by their numbers, and infinitely smaller
// changes of the site values, ordered by rank (Simulation of Simplicity, Edelsbrunner and Mücke 1990). All
// answers therefore belong to one configuration in general position, however degenerate the input.
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

/// A vertex of the surface.
struct SurfaceVertex {
  Index index;  ///< orders displacements
  Vec3 point;
};

/// Sign of det[f_c(vertex_r)] for one to three vertices.
int vertexDeterminantSign(const std::array<Vec3, 4>& tet, std::span<const SurfaceVertex> vertices,
                          std::span<const AffineFunction> functions);

/// Weights, summing to one, of the point of the edge or triangle over `vertices` where all `functions` (one
/// fewer) vanish: the limit for small displacements, which the caller knows to lie in it. The rest is 0.
std::array<double, 3> vertexWeights(const std::array<Vec3, 4>& tet, std::span<const SurfaceVertex> vertices,
                                    std::span<const AffineFunction> functions);

/// Orders the points at which edge pq (vertices[0], vertices[1], ascending) meets f = 0 in one tetrahedron
/// and g = 0 in another, both between p and q: −1 where the first comes first seen from p, 0 where they are
/// the same point of the given doubles.
int compareAlongEdge(std::span<const SurfaceVertex> vertices, const std::array<Vec3, 4>& tetOfF,
                     const AffineFunction& f, const std::array<Vec3, 4>& tetOfG, const AffineFunction& g);

/// Orders the points at which the line f = g = 0 meets two triangles, along the direction ∇g × ∇f: −1 where
/// the first comes first, 0 where they are the same point of the given doubles.
int compareAlongLine(const std::array<Vec3, 4>& tet, const AffineFunction& f, const AffineFunction& g,
                     std::span<const SurfaceVertex> first, std::span<const SurfaceVertex> second);

}  // namespace sherd
