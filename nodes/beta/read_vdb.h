// Reads a painted scalar field (toughness β and the like) from an OpenVDB file.
//
// Accepted are grids of float, of float stored as half, and of double (rounded to float: seven digits are
// more than a painted field holds). Outside of its active voxels a grid has its background value;
// only a level set's inside, which is inactive too, keeps the values that the file has for it.
#pragma once

#include <string>

#include "base/exec.h"
#include "base/result.h"
#include "types/scalar_grid.h"
#include "types/tri_mesh.h"

namespace sherd {

struct ReadVdbParams {
  std::string file;
  std::string grid;  ///< its name in the file; empty: the first one of floats or doubles, by name
  double unit = 1;   ///< m per unit of the grid's world space, > 0: what LoadMesh has for the mesh
  FileFrame::Up up = FileFrame::Up::Y;
};

/// Errors, each listing the grids that the file holds where it could be read that far: no such file, no VDB
/// file or a damaged one, no grid of that name, no grid of floats, NaN or infinity in a grid (with the
/// voxel). Says which grid was taken where the file holds several. Cost O(stored voxels).
Result<ScalarGrid> readVdb(const ReadVdbParams& params, const Exec& exec);

}  // namespace sherd
