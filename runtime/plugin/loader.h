// Finds node packs and loads them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "graph/registry.h"
#include "plugin/plugin.h"

namespace sherd {

/// Why a pack with this handshake can't be used, or nothing wrong.
Result<void> checkHandshake(const std::string& path, const PluginHandshake& handshake);

/// Loads one pack and adds its types. It stays loaded until the process ends, since its types live in it.
Result<void> loadPack(const std::string& path, Registry& registry);

/// The packs to load: those named in `searchPath` (the value of SHERD_NODE_PATH: files, or directories whose
/// *_nodes.so are taken, separated by colons), then lib/sherd_nodes.so beside the directory of the program.
/// Of two with the same file name the first counts. An Error for an entry that isn't there, or where there is
/// no pack at all.
Result<std::vector<std::string>> findPacks(const std::string& searchPath,
                                           const std::filesystem::path& programDirectory);

/// The directory of the running program.
std::filesystem::path programDirectory();
/// The folder of assets: `variable` (the value of SHERD_ASSETS) if it isn't empty, else the first that exists
/// of
/// ../assets, ../../assets and ../share/sherd/assets as seen from the program's directory; else empty.
std::filesystem::path findAssets(const std::string& variable, const std::filesystem::path& programDirectory);

}  // namespace sherd
