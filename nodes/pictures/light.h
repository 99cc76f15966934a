// Colours as light, linear inside, and as bytes, sRGB outside.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace sherd {

using Colour = Eigen::Vector3f;  ///< linear RGB with sRGB primaries

/// Linear [0, 1] to an sRGB byte; what is outside is clamped.
std::uint8_t toSrgb(float linear);
/// The linear light of each sRGB byte; toSrgb of it is the byte again.
const std::array<float, 256>& linearOfSrgb();

}  // namespace sherd
