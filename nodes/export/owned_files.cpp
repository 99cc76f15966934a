#include "export/owned_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/partial_file.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;
using Entries = std::map<std::string, std::string>;

bool present(const std::string& path) {
  std::error_code code;
  return fs::exists(fs::symlink_status(path, code));
}

Result<Entries> readManifest(const std::string& path) {
  if (!present(path)) return Entries{};
  std::ifstream in(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!in || !json.is_object() || !json.contains("files") || !json["files"].is_object())
    return failure("'" + path + "', which lists the files of the last export, cannot be read",
                   "remove it and the old pieces beside it, or choose another directory");
  Entries entries;
  for (const auto& [name, digest] : json["files"].items())
    if (OwnedFiles::canBeOurs(name)) entries[name] = digest.is_string() ? digest.get<std::string>() : "";
  return entries;
}

/// Removes a file or a symbolic link; never a directory. True when something was there.
Result<bool> removeFile(const std::string& path) {
  std::error_code code;
  const auto status = fs::symlink_status(path, code);
  if (!fs::exists(status) || fs::is_directory(status)) return false;
  if (!fs::remove(path, code) && code)
    return failure("cannot remove '" + path + "' of the last export: " + code.message(),
                   "remove it by hand, or choose another directory");
  return true;
}

/// "pieces_texture_01_brick.png", in letters that are safe in any directory.
bool isTexture(const std::string& name) {
  const std::string prefix = "pieces_texture_";
  return name.starts_with(prefix) && name.size() > prefix.size() &&
         std::isdigit(static_cast<unsigned char>(name[prefix.size()])) &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.' || c == '-'; });
}

}  // namespace

bool OwnedFiles::canBeOurs(const std::string& name) {
  if (name == "proxies.json" || name == "proxies.obj") return true;
  if (name == "pieces.json" || name == "pieces.glb" || name == "pieces.mtl") return true;
  if (isTexture(name)) return true;
  const std::string prefix = "piece_";
  if (name.compare(0, prefix.size(), prefix) != 0) return false;
  // Pieces of pieces are piece_0003_0001 and so on.
  const auto isDigit = [&](std::size_t k) {
    return k < name.size() && std::isdigit(static_cast<unsigned char>(name[k]));
  };
  std::size_t i = prefix.size();
  while (isDigit(i) || (i > prefix.size() && name[i] == '_' && isDigit(i + 1))) ++i;
  const std::string rest = name.substr(i);
  if (i > prefix.size() && rest == "_hulls.obj") return true;
  return i > prefix.size() &&
         (rest == "_surface.obj" || rest == "_crack.obj" || rest == "_surface.ply" || rest == "_crack.ply");
}

std::string OwnedFiles::path(const std::string& name) const { return (fs::path(directory_) / name).string(); }

Result<OwnedFiles> OwnedFiles::open(std::string directory, std::vector<std::string> names,
                                    std::string manifest) {
  OwnedFiles files;
  files.manifest_ = std::move(manifest);
  files.directory_ = std::move(directory);
  files.names_ = std::move(names);
  // What is there, before the manifest: another process may be listing and writing these very files just now.
  std::vector<std::string> there;
  for (const std::string& name : files.names_)
    if (present(files.path(name))) there.push_back(name);
  SHERD_ASSIGN(files.listed_, readManifest(files.path(files.manifest_)));
  for (const std::string& name : there)
    if (!files.listed_.contains(name))
      return failure(fmt::format("'{}' exists already and is not of an earlier export into this directory",
                                 files.path(name)),
                     "move it away, or choose another directory");
  return files;
}

Result<void> OwnedFiles::claim() const {
  const bool known =
      std::all_of(names_.begin(), names_.end(), [&](const auto& n) { return listed_.contains(n); });
  if (known) return {};
  Entries all = listed_;
  for (const std::string& name : names_) all.try_emplace(name, "");
  return write(all);
}

Result<void> OwnedFiles::withdraw(const std::string& name) const {
  const auto gone = removeFile(path(name));
  return gone.ok() ? Result<void>{} : gone.error();
}

Result<std::size_t> OwnedFiles::commit(const std::vector<Digest>& digests) const {
  Entries now;
  for (std::size_t i = 0; i < names_.size(); ++i) now[names_[i]] = digests[i].hex();
  std::size_t removed = 0;
  SHERD_CHECK(removeAbandoned(directory_, [&](const std::string& name) {
    return name == manifest_ || listed_.contains(name) || now.contains(name);
  }));
  for (const auto& [name, digest] : listed_) {
    if (now.contains(name)) continue;
    SHERD_ASSIGN(const bool gone, removeFile(path(name)));
    removed += gone;
  }
  SHERD_CHECK(write(now));
  return removed;
}

Result<void> OwnedFiles::write(const Entries& entries) const {
  nlohmann::ordered_json json;
  json["format"] = 1;
  json["about"] =
      "Files that sherd wrote here, with digests of their content. The next export into this directory "
      "replaces "
      "or removes them and touches no others.";
  json["files"] = entries;
  const auto written = writeFileAtomically(path(manifest_), json.dump(1) + "\n");
  return written.ok() ? Result<void>{} : written.error();
}

}  // namespace sherd
