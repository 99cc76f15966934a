#include "cli/cache_size.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <iterator>

#include "eval/disk_store.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

constexpr const char* kSizes = "write a number of bytes, or one with K, M, G or T, such as 500M or 2.5G";

}  // namespace

std::string sizeText(std::uint64_t bytes) {
  static constexpr const char* kUnits[] = {"KiB", "MiB", "GiB", "TiB"};
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  double size = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  while (size >= 1023.95 && unit + 1 < std::size(kUnits)) {
    size /= 1024;
    ++unit;
  }
  return fmt::format("{:.1f} {}", size, kUnits[unit]);
}

Result<std::uint64_t> parseSize(const std::string& text, const std::string& port) {
  const Error wrong{inQuotes(text) + " is no size", kSizes, port, Error::Kind::Input};
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc() || !(number >= 0)) return wrong;
  std::string unit(rest, end);
  for (const std::string suffix : {"iB", "B"})
    if (unit.ends_with(suffix) && (unit.size() > suffix.size() || suffix == "B")) {
      unit.resize(unit.size() - suffix.size());
      break;
    }
  static const std::string kUnits = "KMGT";
  if (unit.size() > 1) return wrong;
  if (!unit.empty()) {
    const std::size_t power =
        kUnits.find(static_cast<char>(std::toupper(static_cast<unsigned char>(unit[0]))));
    if (power == std::string::npos) return wrong;
    for (std::size_t i = 0; i <= power; ++i) number *= 1024;
  }
  if (number > 9e18) return wrong;
  return static_cast<std::uint64_t>(number);
}

Result<std::uint64_t> cacheSize(const std::string& typed, const std::string& option,
                                const Environment& environment) {
  if (!typed.empty()) return parseSize(typed, option);
  const std::string set = environment.variable("SHERD_CACHE_SIZE").value_or("");
  if (set.empty()) return DiskStoreOptions::kMostBytes;
  const auto size = parseSize(set, "");
  if (size.ok()) return size;
  return Error{"the environment variable SHERD_CACHE_SIZE is " + inQuotes(set) + ", which is no size",
               kSizes,
               {},
               Error::Kind::Input};
}

}  // namespace sherd
