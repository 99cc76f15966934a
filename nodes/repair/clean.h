// Faces that are there twice, and faces that are no faces.
#pragma once

#include <span>

#include "base/exec.h"
#include "geometry/inspect_surface.h"
#include "repair/patchwork.h"

namespace sherd {

/// Leaves out triangles with the same three corners as an earlier one, however they face. Of several one
/// stays, except where the rest is closed along all three edges without it: such faces are a wall between two
/// parts that have it in common. Counts those left out, placed at the first. Cost O(n log n).
Defect dropDuplicates(Patchwork& surface);

/// Leaves out pairs of triangles with the same three corners that face opposite ways: winding numbers stay.
void cancelOpposite(Patchwork& surface);

/// Rounds the corners of the triangles in `pairs` to multiples of `spacing` (m) and joins what is then one
/// vertex.
void coarsen(Patchwork& surface, std::span<const std::array<Index, 2>> pairs, double spacing);

/// Leaves out triangles whose corners lie on one line (exact) and makes the gap up by splitting the faces
/// across the longest side at the corner between its ends. Nothing moves: the split faces lie where they lay.
/// Counts those left out. Cost O(n log n) for each row of such triangles side by side.
Defect dropFlat(Patchwork& surface, const Exec& exec);

}  // namespace sherd
