// Between the surface as given, in metres, and as it is meshed, in its own unit.
#pragma once

#include "base/result.h"
#include "tetrahedralize/cage_field.h"
#include "types/tet_mesh.h"
#include "types/tri_mesh.h"

namespace sherd {

/// Centred and scaled, with its shells. Errors: no triangles; a vertex that is not finite, by its number;
/// what splitShells refuses; no volume; inside out.
Result<UnitSurface> checkedUnitSurface(const TriMesh& mesh);

/// A mesh of the unit box in metres, nodes and tetrahedra along a Morton curve.
TetMesh toMetres(const Tetrahedra& mesh, const UnitSurface& surface);

}  // namespace sherd
