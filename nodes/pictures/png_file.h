// Pictures as files.
#pragma once

#include <string>

#include "base/result.h"
#include "types/picture.h"

namespace sherd {

/// Writes `picture` as a PNG, whole or not at all, and creates its directory where that is missing; a file
/// that holds the same picture already is left alone. The error says what is in the way.
Result<void> writePng(const Picture& picture, const std::string& file);

}  // namespace sherd
