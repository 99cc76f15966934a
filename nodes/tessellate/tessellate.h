// Tessellate: cuts the body's surface into closed pieces along the sheets between the cells (paper section
// 4).
//
// Cells are either `exact`, the lower envelope of the distances in each tetrahedron (envelope.h), or the
// paper's four `canonical` schemes (canonical.h), which see no cell that is nearest at no node. Sheets are
// clipped by the fine surface, and the surface by them. Where the paper calls a general 2D triangulator with
// hole points displaced by 1e-7 m, inside and outside are decided here by exact predicates and followed from
// edge to edge, and every new vertex is what two numbered elements intersect in, computed once and shared.
//
// Promised of the result: every piece is closed and coherently oriented, and one connected solid, which may
// hold voids; every crack triangle has exactly one twin of the opposite direction with the same three
// vertices; surface triangles that no sheet crosses are passed through; identical for any thread count; and
// volumes add up to the source's within rounding.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "types/fragments.h"
#include "types/partition.h"

namespace sherd {

enum class CellMode { Exact, Canonical };
/// What the pieces' skin is: the body's own surface, or the tetrahedral mesh's (nothing is clipped then).
enum class SurfaceMode { Original, Conforming };

struct TessellateParams {
  CellMode cells = CellMode::Exact;
  SurfaceMode surface = SurfaceMode::Original;
  /// Connected parts of a cell smaller than this share of the body's volume join the neighbour with which
  /// they share the largest area. In [0, 1).
  double minVolume = 1e-5;
  double minVolumeAbsolute = 0;  ///< the same in m³; the larger of the two counts. ≥ 0
};

/// `cells.embedding->tets` encloses its surface, which is closed and free of self-intersections. Errors:
/// cancelled; a surface that does not allow a closed cut. Cost O(surface) for a copy of it, plus O(n log n)
/// for n triangles near a sheet.
Result<Fragments> tessellate(const Partition& cells, const TessellateParams& params, const Exec& exec);

}  // namespace sherd
