// One picture to judge a fracture by: side by side the object before, its pieces moved apart, and, where they
// are wired, the strain energy and the painted fragility β on the surface and the cells on the tetrahedra,
// which can be cut open by a plane.
//
// Rays by Embree in single precision about the body's centre, at the body's size, so that neither tiny nor
// huge nor far-off bodies lose detail. A soft key light with shadows, a sky with occlusion, and a ground that
// only shows the body's shadow. Samples are low-discrepancy points that depend on the pixel alone, so
// the picture is the same for any number of threads.
#pragma once

#include <string>

#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/fragments.h"
#include "types/partition.h"
#include "types/picture.h"
#include "types/scalar_grid.h"

namespace sherd {

enum class Slice { None, X, Y, Z };

struct PreviewParams {
  std::string file;  ///< the PNG; its directory is created where it is missing
  int width = 1600;  ///< pixels, of the whole picture, in [64, 16384]
  int height = 600;  ///< pixels, in [64, 16384]
  int samples = 8;   ///< per pixel, in [1, 1024]
  double explode =
      0.35;  ///< how far apart: each piece moves by this times (its centre − the body's centre), in [0, 4]
  bool before = true;         ///< a panel with the object before
  Slice slice = Slice::None;  ///< across which axis the tetrahedra are cut open
  double sliceAt = 0.5;       ///< where, in the body's bounding box, in [0, 1]
};

/// What there is to show; all but the pieces may be null.
struct PreviewInput {
  const Fragments* pieces = nullptr;
  const EnergyField* energy = nullptr;
  const ScalarGrid* beta = nullptr;
  const Partition* cells = nullptr;
};

/// Panels, in this order: the object before (unless left out), the pieces, and with what is wired the energy
/// on the surface, β on the surface, the cells on the tetrahedra. With a slice the cells' panel shows them
/// cut open, what lies beyond the plane (towards +axis, where the camera is) taken away, and the energy has
/// one more panel like that, in the same colours. Pieces have one colour each; crack faces are the pale
/// version of it. The energy panels show the energy's density, J/m³, on a logarithmic scale up to its 99.5th
/// percentile, over at most four decades; β's colours go evenly from its least to its greatest value; one
/// value everywhere is a neutral grey. All must have their tetrahedra and surface. Errors: parameters out of
/// range, no pieces, a slice with neither energy nor cells, a β that isn't finite, Embree fails. Cost
/// O(pixels · samples · log triangles).
Result<Picture> renderPreview(const PreviewInput& input, const PreviewParams& params, const Exec& exec);

inline Result<Picture> renderPreview(const Fragments& pieces, const EnergyField* energy,
                                     const PreviewParams& params, const Exec& exec) {
  return renderPreview({.pieces = &pieces, .energy = energy}, params, exec);
}

}  // namespace sherd
