#include "eval/key.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "graph/companion_files.h"
#include "graph/param.h"

namespace sherd {

Result<Digest> digestOfFile(const std::string& path) {
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem))
    return failure('"' + path + "\" is a directory", "name a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return failure("\"" + path + "\" can't be opened: " + std::strerror(errno), "name a file that exists");
  constexpr std::size_t kBlock = std::size_t{1}
                                 << 20;  // part of the digest: blocks are hashed with their lengths
  std::vector<char> block(kBlock);
  Hasher hasher;
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(kBlock));
    hasher.bytes(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) return failure("\"" + path + "\" can't be read to its end");
  return hasher.digest();
}

Result<Digest> FileDigests::of(const std::string& path) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(path); found != known_.end()) return found->second;
  }
  // The identity is taken before reading: a file that changes meanwhile is read again next time.
  const FileIdentity identity = FileIdentity::of(path);
  std::optional<Digest> digest;
  if (disk_ != nullptr && identity.exists()) digest = disk_->fileDigest(path, identity);
  if (!digest) {
    SHERD_ASSIGN(digest, digestOfFile(path));
    if (disk_ != nullptr && identity.exists()) disk_->setFileDigest(path, identity, *digest);
  }
  const std::lock_guard lock(mutex_);
  return known_.emplace(path, *digest).first->second;
}

namespace {

/// Names are taken from where the file lies, so that a folder may move as a whole. One that is missing
/// counts, too: it may come.
void addCompanions(Hasher& hasher, const std::string& path, FileDigests& files) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const std::string& companion : companionFiles(path)) {
    const auto content = files.of(companion);
    const std::string name = std::filesystem::path(companion).lexically_relative(folder).string();
    hasher.add(std::string_view(name.empty() ? companion : name)).add(content.ok());
    if (content.ok()) hasher.add(*content);
  }
}

}  // namespace

Result<Digest> recipeWithFiles(const Graph::Node& node, const ParamValues& params, FileDigests& files) {
  if (!node.readsFiles) return node.recipe;
  Hasher hasher;
  hasher.add(node.recipe);
  for (const ParamInfo& info : node.type->params) {
    const std::string* path =
        info.kind == ParamKind::InputFile ? std::get_if<std::string>(&params.at(info.name)) : nullptr;
    if (path == nullptr || path->empty()) continue;
    auto content = files.of(*path);
    if (!content.ok()) {
      Error error = content.error();
      error.port = info.name;
      return error;
    }
    hasher.add(std::string_view(info.name)).add(*content);
    hasher.add(std::string_view(std::filesystem::path(*path).filename().native()));
    addCompanions(hasher, *path, files);
  }
  return hasher.digest();
}

WiredFiles wiredFilesOf(const Graph::Node& node, const ParamValues& params) {
  WiredFiles files;
  for (const Graph::Wire& wire : node.wiredParams) {
    const ParamInfo& info = node.type->params[static_cast<std::size_t>(wire.to)];
    const std::string* path =
        info.kind == ParamKind::InputFile ? std::get_if<std::string>(&params.at(info.name)) : nullptr;
    if (path != nullptr && !path->empty()) files.emplace_back(info.name, *path);
  }
  return files;
}

Digest resultKey(const Digest& recipe, std::span<const KeyInput> inputs) {
  return digestOf(recipe, std::as_bytes(inputs));
}

Digest labelDigest(const Graph& graph, const Graph::Node& node, const Graph::Wire& wire, bool isParam) {
  if (isParam || !node.type->inputs[static_cast<std::size_t>(wire.to)].gathers) return {};
  const Graph::Node& source = graph.nodes[static_cast<std::size_t>(wire.node)];
  return Hasher()
      .add(std::string_view(graph.contexts[static_cast<std::size_t>(source.context)].label))
      .digest();
}

}  // namespace sherd
