// One picture to judge a fracture by: side by side the object before, its pieces moved apart, and, where the
// strain energy is wired, that energy on the surface.
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
#include "types/picture.h"

namespace sherd {

struct PreviewParams {
  std::string file;  ///< the PNG; its directory is created where it is missing
  int width = 1600;  ///< pixels, of the whole picture, in [64, 16384]
  int height = 600;  ///< pixels, in [64, 16384]
  int samples = 8;   ///< per pixel, in [1, 1024]
  double explode =
      0.35;  ///< how far apart: each piece moves by this times (its centre − the body's centre), in [0, 4]
  bool before = true;  ///< a panel with the object before
};

/// Two panels, three with `energy` (may be null), without `before` one less. Pieces have one colour each;
/// crack faces are the pale version of it. The energy panel shows the energy's density, J/m³, on a
/// logarithmic scale up to its 99.5th percentile, over at most four decades. Fragments and energy must have
/// their tetrahedra and surface. Errors: parameters out of range, no pieces, Embree fails. Cost O(pixels ·
/// samples · log triangles).
Result<Picture> renderPreview(const Fragments& fragments, const EnergyField* energy,
                              const PreviewParams& params, const Exec& exec);

}  // namespace sherd
