#include "preview/colour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sherd {
namespace {

Colour fromOklab(float lightness, float a, float b) {
  const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
  const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
  const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
  const Eigen::Vector3f cubes(l * l * l, m * m * m, s * s * s);
  const Colour rgb(4.0767416621f * cubes[0] - 3.3077115913f * cubes[1] + 0.2309699292f * cubes[2],
                   -1.2684380046f * cubes[0] + 2.6097574011f * cubes[1] - 0.3413193965f * cubes[2],
                   -0.0041960863f * cubes[0] - 0.7034186147f * cubes[1] + 1.7076147010f * cubes[2]);
  return rgb.cwiseMax(0.f).cwiseMin(1.f);
}

/// Hue of piece i, in turns: multiples of the golden section never come close to each other.
float hueOf(std::size_t i) {
  const double turns = 0.08 + static_cast<double>(i) * (std::numbers::phi - 1);
  return static_cast<float>(turns - std::floor(turns));
}

}  // namespace

Colour fromOklch(float lightness, float chroma, float hue) {
  const float angle = 2 * std::numbers::pi_v<float> * hue;
  return fromOklab(lightness, chroma * std::cos(angle), chroma * std::sin(angle));
}

Colour pieceColour(std::size_t i) {
  static constexpr float kLightness[] = {0.68f, 0.78f, 0.58f};  // neighbours in hue differ in lightness
  return fromOklch(kLightness[i % 3], 0.125f, hueOf(i));
}

Colour crackColour(std::size_t i) { return fromOklch(0.94f, 0.03f, hueOf(i)); }

Colour neutralColour() { return {0.62f, 0.60f, 0.57f}; }

Colour energyColour(float t) {
  // Lightness rises evenly; hue turns from blue-violet over red to yellow.
  static constexpr float kStops[][3] = {// lightness, chroma, hue
                                        {0.24f, 0.12f, 0.785f}, {0.36f, 0.17f, 0.83f}, {0.48f, 0.19f, 0.95f},
                                        {0.60f, 0.20f, 1.06f},  {0.72f, 0.17f, 1.15f}, {0.84f, 0.16f, 1.24f},
                                        {0.96f, 0.09f, 1.29f}};
  constexpr int kLast = 6;
  const float x = std::clamp(t, 0.f, 1.f) * kLast;
  const int i = std::min(static_cast<int>(x), kLast - 1);
  const float f = x - static_cast<float>(i);
  float c[3];
  for (int k = 0; k < 3; ++k) c[k] = (1 - f) * kStops[i][k] + f * kStops[i + 1][k];
  return fromOklch(c[0], c[1], c[2]);
}

}  // namespace sherd
