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

/// Fills insideFraction from held, by geometry/tet_share.h: exact up to rounding. Needs a cage that encloses
/// the surface.
void fillInsideFractions(TetMesh& cage, std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         const Exec& exec);

/// Dihedral angles and volumes from the filled fields.
TetQuality measureQuality(const TetMesh& cage, std::span<const Vec3> positions,
                          std::span<const Triangle> triangles);

}  // namespace sherd
