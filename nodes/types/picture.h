// A picture as it travels on wires.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"

namespace sherd {

/// Rows from the top, three bytes (sRGB) per pixel: rgb has 3 · width · height of them.
struct Picture {
  static constexpr const char* typeName = "Picture";
  static constexpr int archiveVersion = 1;
  int width = 0, height = 0;  ///< pixels
  std::vector<std::uint8_t> rgb;
  friend bool operator==(const Picture&, const Picture&) = default;

  /// Of the first of the three bytes of the pixel in column x, row y.
  std::size_t offset(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
  /// Both sides are at least one pixel, and there are as many bytes as they ask for.
  bool complete() const { return width > 0 && height > 0 && rgb.size() == offset(0, height); }
};

void hashValue(Hasher& hasher, const Picture& picture);
std::size_t byteSize(const Picture& picture);
void saveValue(ArchiveWriter& to, const Picture& picture);
/// Nothing where the number of bytes isn't that of the sides.
std::optional<Picture> loadValue(ArchiveReader& from, std::type_identity<Picture>);

}  // namespace sherd
