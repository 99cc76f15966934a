// Pictures inside of the report.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sherd {

/// Of the files; in the page they take a third more.
constexpr std::uint64_t kMostPictureBytes = 20'000'000;

struct EmbeddedPicture {
  std::string file;  ///< as given
  std::string uri;   ///< data:image/png;base64,…
};

struct EmbeddedPictures {
  std::vector<EmbeddedPicture> pictures;
  std::size_t leftOut = 0;  ///< that would have gone beyond the limit
};

/// Reads PNG files in their order. Those that are gone, or aren't PNG files, are passed over; one that would
/// go beyond `mostBytes` in all is left out and counted, and smaller ones after it are still taken.
EmbeddedPictures embedPictures(const std::vector<std::string>& files, std::uint64_t mostBytes);

}  // namespace sherd
