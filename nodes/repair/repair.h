// Makes a surface bound a solid: finds what is wrong with it, says where, and mends it.
//
// Rungs of a ladder, each taken only where the surface isn't sound after the ones before; a sound surface
// costs its inspection and comes back bit for bit:
//   1. Faces that are there twice and faces of no area go (clean.h); nothing moves.
//   2. Cracks are closed: vertices of open edges nearer than `crack` are joined, and open edges split at
//   vertices
//      that lie on them (stitch.h).
//   3. Faces are turned to agree with their neighbours, holes filled (holes.h), and parts turned that are
//   inside
//      out (shells.h). A part within the solid that faces outward bounds nothing: `innerShells` says what
//      becomes of it.
//   4. Open parts that bound nothing: those on a solid are left out where they are small or lie in it
//   (sheets.h),
//      the others (leaves, cloth, fins) get the thickness `leaf`, and where they stand on a solid, reach into
//      it, so that they become one body with it (thicken.h).
//   5. Where it meets itself, the surface becomes the boundary of what it winds around, cut exactly and
//   rounded to
//      doubles (hull.h). Rounding is checked: what meets after it is cut again, a few times.
//   6. Solids that touch in an edge or a vertex are drawn apart by at most 1e-6 of the diagonal (separate.h).
//   7. As the last resort the surface is made anew from a level set (rebuild.h).
// Rungs 1–3, 5 and 6 leave the visible surface where it is (holes are visible: large ones are warned of), 4
// and 7 don't and say so in a warning, 7 with the Hausdorff distance. Triangles that no rung touches keep
// their positions and attributes bit for bit. Attributes of new corners are interpolated in the triangle of
// the given surface that they lie in; faces over a hole take those of the hole's border.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "geometry/inspect_surface.h"
#include "types/tri_mesh.h"

namespace sherd {

struct RepairParams {
  enum class Mode {
    Auto,    ///< mends what is wrong
    Strict,  ///< refuses whatever is wrong
    Rebuild  ///< the level set at once
  };
  enum class InnerShells {
    Solid,  ///< a part within the solid that faces outward is left out
    Void    ///< it is turned, to be the wall of a void
  };
  Mode mode = Mode::Auto;
  InnerShells innerShells = InnerShells::Solid;
  double crack = 1e-5;      ///< ≥ 0, of the diagonal: open edges this close are one
  double smallHole = 0.05;  ///< ≥ 0, of the diagonal: larger holes are filled too, but warned of; sheets of
                            ///< less than its square that hang on the solid or touch it are left out
  double leaf = 0.01;       ///< > 0, of the diagonal: thickness that parts without a solid behind them get
  int resolution = 128;  ///< ≥ 8: voxels along the diagonal that the level set starts with; up to 8 times as
                         ///< many where thin parts need them
};

enum class RepairStage { None, Mended, Hull, LevelSet };

struct RepairReport {
  SurfaceReport found;                    ///< in the given surface, places in the file's coordinates
  std::vector<std::string> done;          ///< what was done, one line each, as told to the user
  RepairStage stage = RepairStage::None;  ///< the farthest that was needed
  bool visible = false;                   ///< the visible surface changed: a leaf, a large hole, a level set
  double hausdorff = 0;                   ///< m; of the level set, else 0
  double relativeHausdorff = 0;           ///< of the diagonal of the given surface
};

struct Repaired {
  TriMesh mesh;  ///< sound: inspectSurface() finds nothing
  RepairReport report;
};

/// `mesh`: any triangles, as long as indices are in range. What was done is said through exec, too: warnings
/// tell of what changes the visible surface. Errors: Strict and something is wrong, with every defect, its
/// count and first place; coordinates that are not finite; no triangles; nothing enclosed. Named in errors:
/// mesh.source, or "the mesh". Cost of a sound surface O(n log n); of others, that and exact constructions
/// where it meets itself.
Result<Repaired> repair(TriMesh mesh, const RepairParams& params, const Exec& exec);

/// One word: "none", "mended", "hull", "level set".
std::string nameOf(RepairStage stage);

}  // namespace sherd
