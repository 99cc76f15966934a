// Writes scalar fields into an OpenVDB file, for other programs and for ReadVDB.
//
// Each field becomes one grid of floats with its transform, background, class and other metadata; a constant
// becomes a grid with that background and no voxels. Stored as half, a value v keeps |error| ≤ 2⁻¹¹ |v|, or
// 2⁻²⁵ where that is more; the background too.
//
// Space. A grid stays in the unit and the axes that it came in (of the file that it was read from, or of the
// mesh that it was painted on), so that it lies where that mesh lies; `up` and `unit` choose others, by
// changing its transform and no voxel.
//
// The file has the index of grids that OpenVDB's File reads and is packed by Blosc where OpenVDB has it. The
// same fields give the same bytes: what would be a random tag of the file is made from its content.
#pragma once

#include <span>
#include <string>

#include "base/exec.h"
#include "base/result.h"
#include "types/scalar_grid.h"

namespace sherd {

struct WriteVdbParams {
  enum class Precision { Float, Half };
  enum class GridClass {
    Same,      ///< as it was read or painted
    Fog,       ///< density: background 0 by custom
    LevelSet,  ///< signed distances in a narrow band; the background is its half width
  };
  enum class Up { Same, Y, Z };

  std::string file;  ///< its directory is created where it is missing
  std::string name;  ///< of the first grid in the file; empty: the field's own, else "beta"
  Precision precision = Precision::Float;
  GridClass gridClass = GridClass::Same;
  Up up = Up::Same;
  double unit = 0;  ///< m per unit of the file's space, ≥ 0; 0: the grid's own
};

/// `grids`: one or more. The file appears whole or not at all, and one that holds the same is left alone. A
/// level set's inside, which ScalarGrid holds as active values of −background, becomes inactive again.
/// Errors: two grids of one name; a value that a half can't hold (beyond ±65504), with its voxel; a level set
/// with a background that is not above zero; other axes for a grid that follows a camera's frustum; a file
/// that can't be written. Cost O(stored voxels).
Result<void> writeVdb(std::span<const ScalarGrid> grids, const WriteVdbParams& params, const Exec& exec);

}  // namespace sherd
