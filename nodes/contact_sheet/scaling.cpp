#include "contact_sheet/scaling.h"

#include <algorithm>
#include <cmath>

#include "pictures/light.h"

namespace sherd {
namespace {

/// One source pixel's share in a pixel of the target.
struct Share {
  int source = 0;
  float weight = 0;
};

/// For each of `to` target pixels the source pixels that it covers; the weights of each add up to 1.
std::vector<std::vector<Share>> sharesOf(int from, int to) {
  std::vector<std::vector<Share>> shares(static_cast<std::size_t>(to));
  // In units of 1 / (from · to), so that the borders are exact.
  for (std::int64_t t = 0; t < to; ++t) {
    const std::int64_t begin = t * from, end = begin + from;
    for (std::int64_t s = begin / to; s * to < end; ++s) {
      const std::int64_t covered = std::min(end, (s + 1) * to) - std::max(begin, s * to);
      shares[static_cast<std::size_t>(t)].push_back(
          {static_cast<int>(s), static_cast<float>(static_cast<double>(covered) / from)});
    }
  }
  return shares;
}

/// Adds `weight` times the row, scaled to the width of `columns`, to `sums`.
void addRow(const std::uint8_t* row, const std::vector<std::vector<Share>>& columns, float weight,
            std::vector<Colour>& sums) {
  const std::array<float, 256>& linear = linearOfSrgb();
  for (std::size_t x = 0; x < columns.size(); ++x) {
    Colour sum = Colour::Zero();
    for (const Share& share : columns[x]) {
      const std::uint8_t* pixel = row + 3 * static_cast<std::ptrdiff_t>(share.source);
      sum += share.weight * Colour(linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]);
    }
    sums[x] += weight * sum;
  }
}

}  // namespace

PictureSize fittedSize(const Picture& picture, const PictureSize& box) {
  const double scale = std::min({1.0, static_cast<double>(box.width) / picture.width,
                                 static_cast<double>(box.height) / picture.height});
  const auto scaled = [scale](int side) { return std::max(1, static_cast<int>(std::lround(scale * side))); };
  return {scaled(picture.width), scaled(picture.height)};
}

Picture scaledDown(const Picture& picture, const PictureSize& size) {
  if (size.width == picture.width && size.height == picture.height) return picture;
  const auto columns = sharesOf(picture.width, size.width), rows = sharesOf(picture.height, size.height);
  Picture scaled{size.width, size.height, {}};
  scaled.rgb.reserve(scaled.offset(0, size.height));
  std::vector<Colour> sums(columns.size());
  for (const std::vector<Share>& row : rows) {
    std::fill(sums.begin(), sums.end(), Colour::Zero());
    for (const Share& share : row)
      addRow(picture.rgb.data() + picture.offset(0, share.source), columns, share.weight, sums);
    for (const Colour& sum : sums)
      for (int c = 0; c < 3; ++c) scaled.rgb.push_back(toSrgb(sum[c]));
  }
  return scaled;
}

}  // namespace sherd
