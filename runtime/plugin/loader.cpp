#include "plugin/loader.h"

#include <dlfcn.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::string inQuotes(const fs::path& path) { return '"' + path.string() + '"'; }

Error inPack(const std::string& path, const Error& error) {
  return failure("node pack " + inQuotes(path) + ": " + error.what, error.remedy);
}

Result<std::vector<fs::path>> packsIn(const fs::path& entry) {
  std::error_code problem;
  if (fs::is_regular_file(entry, problem)) return std::vector<fs::path>{entry};
  if (!fs::is_directory(entry, problem))
    return failure("SHERD_NODE_PATH names " + inQuotes(entry) + ", which isn't there",
                   "name node packs or directories of them, separated by colons");
  std::vector<fs::path> packs;
  for (fs::directory_iterator it(entry, problem), end; !problem && it != end; it.increment(problem))
    if (it->path().filename().string().ends_with("_nodes.so")) packs.push_back(it->path());
  std::sort(packs.begin(), packs.end());
  return packs;
}

}  // namespace

Result<void> checkHandshake(const std::string& path, const PluginHandshake& handshake) {
  const std::string name = "node pack " + inQuotes(path);
  const char* remedy = "build it anew against this program";
  if (handshake.magic != kPluginMagic) return failure(name + " has a handshake of another kind", remedy);
  if (handshake.abi != kPluginAbi)
    return failure(name + " is built for ABI " + std::to_string(handshake.abi) + ", this program has ABI " +
                       std::to_string(kPluginAbi),
                   remedy);
  if (std::string_view(handshake.build) != kHandshake.build)
    return failure(name + " is built with " + handshake.build + ", this program with " + kHandshake.build,
                   remedy);
  if (std::string_view(handshake.version) != kHandshake.version)
    return failure(
        name + " is built for sherd " + handshake.version + ", this is sherd " + kHandshake.version, remedy);
  if (handshake.layoutCount != kHandshake.layoutCount)
    return failure(name + " is built against other headers than this program", remedy);
  for (std::size_t i = 0; i < kHandshake.layoutCount; ++i) {
    const PluginLayout &theirs = handshake.layouts[i], &ours = kHandshake.layouts[i];
    if (theirs.bytes != ours.bytes || std::string_view(theirs.name) != ours.name)
      return failure(name + " is built against other headers than this program: " + theirs.name + " has " +
                         std::to_string(theirs.bytes) + " bytes there, and " + ours.name + ' ' +
                         std::to_string(ours.bytes) + " here",
                     remedy);
  }
  return {};
}

Result<void> loadPack(const std::string& path, Registry& registry) {
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* reason = ::dlerror();
    return failure("node pack " + inQuotes(path) + " can't be loaded: " + (reason == nullptr ? "" : reason),
                   "build it anew");
  }
  const auto* handshake = static_cast<const PluginHandshake*>(::dlsym(library, "sherd_pack_handshake"));
  if (handshake == nullptr)
    return failure(inQuotes(path) + " is no node pack", "it would have to use SHERD_NODE_PACK");
  SHERD_CHECK(checkHandshake(path, *handshake));
  auto* add = reinterpret_cast<RegisterPack*>(::dlsym(library, "sherd_pack_register"));
  if (add == nullptr)
    return failure(inQuotes(path) + " registers no nodes", "it would have to use SHERD_NODE_PACK");
  Error error;
  if (add(registry, error)) return {};
  return inPack(path, error);
}

Result<std::vector<std::string>> findPacks(const std::string& searchPath, const fs::path& programDirectory) {
  std::vector<std::string> packs;
  std::set<std::string> names;
  auto take = [&](const fs::path& pack) {
    if (names.insert(pack.filename().string()).second) packs.push_back(pack.string());
  };
  for (std::size_t begin = 0; begin < searchPath.size();) {
    const std::size_t end = std::min(searchPath.find(':', begin), searchPath.size());
    if (end > begin) {
      SHERD_ASSIGN(const std::vector<fs::path> found, packsIn(searchPath.substr(begin, end - begin)));
      for (const fs::path& pack : found) take(pack);
    }
    begin = end + 1;
  }
  const fs::path own = (programDirectory / ".." / "lib" / "sherd_nodes.so").lexically_normal();
  std::error_code problem;
  if (fs::exists(own, problem)) take(own);
  if (packs.empty())
    return failure("there is no node pack " + inQuotes(own),
                   "build the target sherd_nodes, or name a pack in SHERD_NODE_PATH");
  return packs;
}

fs::path programDirectory() {
  std::error_code problem;
  return fs::read_symlink("/proc/self/exe", problem).parent_path();
}

fs::path findAssets(const std::string& variable, const fs::path& programDirectory) {
  std::error_code problem;
  if (!variable.empty()) return fs::absolute(variable, problem).lexically_normal();
  for (const char* place : {"../assets", "../../assets", "../share/sherd/assets"}) {
    const fs::path folder = fs::canonical(programDirectory / place, problem);
    if (!problem && fs::is_directory(folder, problem)) return folder;
  }
  return {};
}

}  // namespace sherd
