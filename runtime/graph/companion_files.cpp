#include "graph/companion_files.h"

#include <cctype>
#include <filesystem>
#include <map>
#include <mutex>

namespace sherd {
namespace {

struct Finders {
  std::mutex mutex;
  std::map<std::string, CompanionFinder> byExtension;
};

Finders& finders() {
  static Finders all;
  return all;
}

}  // namespace

void setCompanionFiles(const std::string& extension, CompanionFinder finder) {
  const std::lock_guard lock(finders().mutex);
  finders().byExtension[extension] = finder;
}

std::vector<std::string> companionFiles(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  CompanionFinder finder = nullptr;
  {
    const std::lock_guard lock(finders().mutex);
    const auto found = finders().byExtension.find(extension);
    if (found != finders().byExtension.end()) finder = found->second;
  }
  return finder == nullptr ? std::vector<std::string>() : finder(path);
}

}  // namespace sherd
