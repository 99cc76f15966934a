// Which tetrahedra a painted field protects (protect.h).
#pragma once

#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/scalar_grid.h"
#include "types/tet_mesh.h"

namespace sherd {

struct ProtectedTets {
  std::vector<char> isProtected;  ///< per tetrahedron
  double highest = 0;             ///< of the field, as sampled
};

Result<ProtectedTets> protectedTets(const TetMesh& tets, const ScalarGrid& field, double threshold,
                                    const Exec& exec);

}  // namespace sherd
