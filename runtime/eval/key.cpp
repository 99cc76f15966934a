#include "eval/key.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "graph/param.h"

namespace sherd {

Result<Digest> FileDigests::of(const std::string& path) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(path); found != known_.end()) return found->second;
  }
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
  const Digest digest = hasher.digest();
  const std::lock_guard lock(mutex_);
  return known_.emplace(path, digest).first->second;
}

Result<Digest> resultKey(const NodeType& type, const ParamValues& params, const Outputs& inputs,
                         FileDigests& files) {
  Hasher hasher;
  hasher.add(std::string_view(type.name)).add(type.version).add(type.implementation);
  for (const ParamInfo& info : type.params) {
    const ParamValue& value = params.at(info.name);
    hasher.add(std::string_view(info.name));
    const std::string* path = info.kind == ParamKind::InputFile ? std::get_if<std::string>(&value) : nullptr;
    if (path != nullptr && !path->empty()) {
      auto content = files.of(*path);
      if (!content.ok()) {
        Error error = content.error();
        error.port = info.name;
        return error;
      }
      hasher.add(*content).add(std::string_view(std::filesystem::path(*path).filename().native()));
    } else {
      hashParam(hasher, value);
    }
  }
  for (const auto& [port, output] : inputs) hasher.add(std::string_view(port)).add(output.digest);
  return hasher.digest();
}

}  // namespace sherd
