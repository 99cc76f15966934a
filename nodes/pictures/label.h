// Words on a picture, in a bitmap font of 5 × 7 dots.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pictures/light.h"
#include "types/picture.h"

namespace sherd {

using Rgb = std::array<std::uint8_t, 3>;  ///< sRGB

Rgb toRgb(const Colour& colour);
/// Sets one pixel; one outside of the picture is left out.
void paint(Picture& picture, int x, int y, const Rgb& colour);

/// From the left of one character to that of the next, and from line to line, in dots.
constexpr int kCharacterDots = 6, kLineDots = 10;

/// Width of a line of UTF-8, pixels, with dots of `scale` × `scale` pixels.
int textWidth(std::string_view text, int scale);

/// Draws a line of UTF-8. Printable ASCII has letters; any other character is a hollow box, a space a gap.
/// (x, y) is the upper left corner; what falls outside of the picture is left out.
void drawText(Picture& picture, int x, int y, std::string_view text, int scale, const Rgb& colour);

/// `text` (UTF-8) in lines of at most `columns` characters, broken at spaces where there are any, else
/// anywhere. Where it needs more than `most` lines its middle is left out: the last line is then "..." and
/// the text's end, by which labels differ. columns ≥ 4, most ≥ 1. O(length).
std::vector<std::string> wrapText(std::string_view text, int columns, int most);

}  // namespace sherd
