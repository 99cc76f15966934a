#include "pictures/light.h"

#include <algorithm>
#include <cmath>

namespace sherd {

std::uint8_t toSrgb(float linear) {
  const float x = std::clamp(linear, 0.f, 1.f);
  const float s = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

const std::array<float, 256>& linearOfSrgb() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const double s = static_cast<double>(i) / 255;
      linear[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return linear;
  }();
  return table;
}

}  // namespace sherd
