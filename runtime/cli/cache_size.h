// How large the cache may be, and sizes as text.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "graph/variables.h"

namespace sherd {

/// "1000", "64K", "500M", "2.5G", "1T", also with "B" or "iB" behind: bytes, by powers of 1024. The error is
/// of `port`.
Result<std::uint64_t> parseSize(const std::string& text, const std::string& port);

/// "100 bytes", "1.5 MiB".
std::string sizeText(std::uint64_t bytes);

/// The bound of the cache: `typed` as the value of `option`, else $SHERD_CACHE_SIZE, else 10 GiB.
Result<std::uint64_t> cacheSize(const std::string& typed, const std::string& option,
                                const Environment& environment);

}  // namespace sherd
