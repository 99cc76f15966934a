// Light: what a panel's pixels look like.
#pragma once

#include <cstdint>
#include <vector>

#include "base/exec.h"
#include "preview/camera.h"
#include "preview/scene.h"

namespace sherd {

/// Where a panel stands in the picture, pixels.
struct PanelFrame {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Linear pixels of the whole picture, rows from the top.
struct PixelBuffer {
  int width = 0, height = 0;
  std::vector<Colour> pixels;
  Colour& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// What lies behind everything, at height v in [0, 1] from the top.
Colour backdrop(float v);

/// Draws `scene`, standing on a ground at its lowest point, into `frame` of `canvas`.
void drawPanel(const Scene& scene, const Camera& camera, const PanelFrame& frame, int samples,
               PixelBuffer& canvas, const Exec& exec);

}  // namespace sherd
