// What of the surface each tetrahedron holds, and how much of it is inside.
#pragma once

#include <span>

#include "base/exec.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Fills heldBegin and held: the surface triangles that touch each tetrahedron. Separating axes with a margin
/// of rounding: never misses one. Cost O(triangles log tets).
void holdTriangles(TetMesh& cage, std::span<const Vec3> positions, std::span<const Triangle> triangles,
                   const Exec& exec);

/// Fills insideFraction from held: the volume of (solid ∩ tetrahedron), by the divergence theorem, three
/// times.
///
///   3 V(S ∩ T) = Σ over surface triangles clipped to T of ∫ (x − p)·n dA + h A(S ∩ F)
///   2 A(S ∩ F) = Σ over segments of the surface in F of ∫ (x − q)·m ds + k L(S ∩ E)
///     L(S ∩ E) = Σ over crossings of E of ± their distance from r + [other end inside] |E|
///
/// with p a corner of T, F the face opposite p and h its distance, q a corner of F, E the edge of F opposite
/// q and k its distance, r an end of E: faces through p, edges through q and the end r contribute nothing.
/// Exact up to rounding; which segments and crossings there are is decided so that neighbouring triangles
/// agree. Needs a cage that encloses the surface.
void fillInsideFractions(TetMesh& cage, std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         const Exec& exec);

/// Dihedral angles and volumes from the filled fields.
TetQuality measureQuality(const TetMesh& cage, std::span<const Vec3> positions,
                          std::span<const Triangle> triangles);

}  // namespace sherd
