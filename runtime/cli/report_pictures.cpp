#include "cli/report_pictures.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "cli/report_text.h"

namespace sherd {

EmbeddedPictures embedPictures(const std::vector<std::string>& files, std::uint64_t mostBytes) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  EmbeddedPictures embedded;
  std::uint64_t used = 0;
  for (const std::string& file : files) {
    std::error_code gone;
    const std::uint64_t size = std::filesystem::file_size(file, gone);
    if (gone) continue;
    if (size > mostBytes - used) {
      ++embedded.leftOut;
      continue;
    }
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!bytes.starts_with(kSignature)) continue;
    used += std::min<std::uint64_t>(bytes.size(), mostBytes - used);
    embedded.pictures.push_back({file, "data:image/png;base64," + base64(bytes)});
  }
  return embedded;
}

}  // namespace sherd
