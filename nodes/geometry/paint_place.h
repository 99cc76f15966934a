// Words for paint that misses the body.
#pragma once

#include <string>

#include "types/scalar_grid.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Where the field's painted voxels lie and where the body, and what may be the reason that these don't meet:
/// a unit of 1000 or 100 times too much or too little, the other axis up, or paint finer than the
/// tetrahedra. Begins with "the paint lies". The field is no constant.
std::string placeOfPaint(const ScalarGrid& field, const TetMesh& body);

}  // namespace sherd
