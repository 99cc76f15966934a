// Pictures as files.
#pragma once

#include <string>
#include <string_view>

#include "base/exec.h"
#include "base/result.h"
#include "types/picture.h"

namespace sherd {

/// Writes `picture` as a PNG, whole or not at all, and creates its directory where that is missing; a file
/// that holds the same picture already is left alone. The error says what is in the way.
Result<void> writePng(const Picture& picture, const std::string& file);

/// Pixels above which a picture is refused: half a GiB.
inline constexpr double kMostPixels = 1 << 28;

/// From the bytes of a PNG: of any depth (sixteen bits are rounded to eight), grey, with a palette or of
/// colours, interlaced or not. Values are those of the file, whatever it says of gamma; transparency is left
/// out, since what is painted by a picture are numbers. Errors: no PNG, damaged or cut off, more than
/// kMostPixels, cancelled.
Result<Picture> readPng(std::string_view content, const Exec& exec);

}  // namespace sherd
