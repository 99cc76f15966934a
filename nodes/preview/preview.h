// One picture to judge a fracture by: side by side the object before, its pieces moved apart, and, where the
// strain energy is wired, that energy on the surface.
//
// Rays by Embree in single precision about the body's centre, at the body's size, so that neither tiny nor
// huge nor far-off bodies lose detail. A soft key light with shadows, a sky with occlusion, and a ground that
// only shows the body's shadow. Samples are low-discrepancy points that depend on the pixel alone, so
// the picture is the same for any number of threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/fragments.h"

namespace sherd {

/// Rows from the top, three bytes (sRGB) per pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

struct PreviewParams {
  std::string file;  ///< the PNG; its directory is created where it is missing
  int width = 1600;  ///< pixels, of the whole picture, in [64, 16384]
  int height = 600;  ///< pixels, in [64, 16384]
  int samples = 8;   ///< per pixel, in [1, 1024]
  double explode =
      0.35;  ///< how far apart: each piece moves by this times (its centre − the body's centre), in [0, 4]
};

/// Two panels, three with `energy` (may be null). Pieces have one colour each; crack faces are the pale
/// version of it. The energy panel shows the energy's density, J/m³, on a logarithmic scale up to its 99.5th
/// percentile, over at most four decades. Fragments and energy must have their tetrahedra and surface.
/// Errors: parameters out of range, no pieces, Embree fails. Cost O(pixels · samples · log triangles).
Result<Image> renderPreview(const Fragments& fragments, const EnergyField* energy,
                            const PreviewParams& params, const Exec& exec);

/// Writes `image` as a PNG, whole or not at all; a file that holds the same picture already is left alone.
Result<void> writePng(const Image& image, const std::string& file);

}  // namespace sherd
