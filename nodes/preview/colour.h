// The colours of what is shown: Oklab (Ottosson 2020) where they have to look evenly spaced.
#pragma once

#include "pictures/light.h"
#include "types/vec.h"

namespace sherd {

/// From lightness [0, 1], chroma [0, 0.3] and hue (turns). Clamped to what sRGB shows.
Colour fromOklch(float lightness, float chroma, float hue);

/// Colour of piece i: hues a golden angle apart, so that any number of them are told apart as well as can be.
Colour pieceColour(std::size_t i);
/// Its crack faces: pale, nearly white.
Colour crackColour(std::size_t i);

/// A warm grey, for what has no colour to tell of.
Colour neutralColour();

/// Perceptually ordered from dark indigo (0) over red to pale yellow (1).
Colour energyColour(float t);

}  // namespace sherd
