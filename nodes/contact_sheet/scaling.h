// Making pictures smaller.
#pragma once

#include "types/picture.h"

namespace sherd {

/// A size in pixels.
struct PictureSize {
  int width = 0, height = 0;
};

/// The size of `picture` (complete) when it is made to fit into `box` with its proportions kept, at least
/// 1 × 1 and never larger than it is.
PictureSize fittedSize(const Picture& picture, const PictureSize& box);

/// `picture` (complete) at `size`, in [1, its own] per side: each pixel is the mean light over the area that
/// it covers. At its own size it is unchanged. O(pixels of the picture).
Picture scaledDown(const Picture& picture, const PictureSize& size);

}  // namespace sherd
