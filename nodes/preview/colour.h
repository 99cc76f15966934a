// Colours: linear light inside, sRGB outside, Oklab (Ottosson 2020) where they have to look evenly spaced.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "types/vec.h"

namespace sherd {

using Colour = Eigen::Vector3f;  ///< linear RGB with sRGB primaries

/// From lightness [0, 1], chroma [0, 0.3] and hue (turns). Clamped to what sRGB shows.
Colour fromOklch(float lightness, float chroma, float hue);

/// Colour of piece i: hues a golden angle apart, so that any number of them are told apart as well as can be.
Colour pieceColour(std::size_t i);
/// Its crack faces: pale, nearly white.
Colour crackColour(std::size_t i);

/// Perceptually ordered from dark indigo (0) over red to pale yellow (1).
Colour energyColour(float t);

/// Linear [0, 1] to an sRGB byte.
std::uint8_t toSrgb(float linear);

}  // namespace sherd
