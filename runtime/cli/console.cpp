#include "cli/console.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace sherd {

void printDiagnostics(const Diagnostics& diagnostics, std::ostream& err) {
  const auto all = diagnostics.sorted();
  for (const Diagnostic& diagnostic : all) err << diagnostic.text() << '\n';
  if (diagnostics.count() > all.size()) err << "… and " << diagnostics.count() - all.size() << " more\n";
}

std::string durationText(double ms) {
  if (ms < 9.95) return fmt::format("{:.1f} ms", ms);
  if (ms < 9950) return fmt::format("{:.0f} ms", ms);
  if (ms < 120e3) return fmt::format("{:.1f} s", ms / 1000);
  const auto seconds = static_cast<long long>(ms / 1000);
  if (seconds < 7200) return fmt::format("{} min {} s", seconds / 60, seconds % 60);
  return fmt::format("{} h {} min", seconds / 3600, seconds / 60 % 60);
}

std::string shownPath(const std::string& path) {
  std::error_code problem;
  const auto current = std::filesystem::current_path(problem);
  if (problem) return path;
  const std::string relative = std::filesystem::path(path).lexically_relative(current).string();
  return relative.empty() || relative.size() >= path.size() ? path : relative;
}

std::string countText(std::size_t count, const std::string& noun) {
  return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

}  // namespace sherd
