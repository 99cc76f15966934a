// Words on the picture, in a bitmap font of 5 × 7 dots.
#pragma once

#include <string_view>

#include "preview/shading.h"

namespace sherd {

/// Width of a line of text, pixels, with dots of `scale` × `scale` pixels.
int textWidth(std::string_view text, int scale);

/// Draws lower-case letters, digits and a few signs; other characters leave a gap. (x, y) is the upper left
/// corner; what falls outside of the canvas is left out.
void drawText(Canvas& canvas, int x, int y, std::string_view text, int scale, const Colour& colour);

}  // namespace sherd
