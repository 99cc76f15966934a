#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <system_error>

#include "graph/graph.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

/// In full: the end is what tells one file from another.
std::string pathInQuotes(const fs::path& path) { return inQuotes(path.string(), path.string().size()); }

Error wrong(std::string what, std::string remedy) {
  return Error{std::move(what), std::move(remedy), {}, Error::Kind::Input};
}

/// The uppermost directory of a path that isn't there: where the path goes wrong.
fs::path firstMissing(fs::path folder) {
  std::error_code problem;
  while (folder.has_relative_path() && !fs::exists(folder.parent_path(), problem))
    folder = folder.parent_path();
  return folder;
}

/// The files beside a missing one, for a suggestion.
std::string nearFile(const fs::path& path) {
  constexpr std::size_t kMostRead = 2000;
  std::error_code problem;
  const fs::path folder = path.parent_path();
  if (!fs::is_directory(folder, problem))
    return "correct the path: there is no directory " + pathInQuotes(firstMissing(folder)) + " either";
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, problem), end; !problem && it != end && names.size() < kMostRead;
       it.increment(problem))
    names.push_back(it->path().filename().string());
  const std::string near = closest(path.filename().string(), names);
  return near.empty() ? "name a file that exists" : "did you mean " + inQuotes(near) + "?";
}

Result<void> checkInputFile(const fs::path& path) {
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  if (!fs::exists(status)) return wrong("there is no file " + pathInQuotes(path), nearFile(path));
  if (fs::is_directory(status)) return wrong(pathInQuotes(path) + " is a directory", "name a file");
  if (::access(path.c_str(), R_OK) != 0)
    return wrong(pathInQuotes(path) + " can't be read: " + std::strerror(errno), "allow reading it");
  return {};
}

/// Whether a directory is there and can be written into, or can be made.
Result<void> checkOutputDirectory(const fs::path& path) {
  std::error_code problem;
  for (fs::path folder = path;; folder = folder.parent_path()) {
    const fs::file_status status = fs::status(folder, problem);
    if (fs::is_directory(status)) {
      if (::access(folder.c_str(), W_OK | X_OK) == 0) return {};
      return wrong(
          "the directory " + pathInQuotes(folder) + " can't be written into: " + std::strerror(errno),
          "choose another one or allow writing");
    }
    if (fs::exists(status))
      return wrong(pathInQuotes(folder) + " is there and is no directory",
                   "choose another path or remove it");
    if (folder == folder.parent_path())
      return wrong(pathInQuotes(path) + " can't be made", "choose another path");
  }
}

Result<void> checkOutputFile(const fs::path& path) {
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  if (fs::is_directory(status)) return wrong(pathInQuotes(path) + " is a directory", "name a file");
  if (fs::exists(status) && ::access(path.c_str(), W_OK) != 0)
    return wrong(pathInQuotes(path) + " can't be overwritten: " + std::strerror(errno),
                 "choose another file");
  return checkOutputDirectory(path.parent_path());
}

/// Nodes of one type that own one directory would delete each other's files; a file has one owner in any
/// case.
std::string ownerKey(const Graph::Node& node, const ParamInfo& info, const std::string& path) {
  if (info.kind == ParamKind::OutputFile) return "file " + path;
  return info.kind == ParamKind::OutputDirectory ? "directory " + node.type->name + ' ' + path
                                                 : std::string();
}

}  // namespace

void checkFiles(const Graph& graph, const std::vector<int>& nodes, Diagnostics& diagnostics) {
  std::map<std::string, std::string> owners;
  for (const int i : nodes) {
    const Graph::Node& node = graph.nodes[static_cast<std::size_t>(i)];
    if (node.type == nullptr) continue;
    for (const ParamInfo& info : node.type->params) {
      bool wired = false;
      for (const Graph::Wire& wire : node.wiredParams) wired = wired || wire.to == info.name;
      const auto* text = wired ? nullptr : std::get_if<std::string>(&node.params.at(info.name));
      if (text == nullptr || text->empty()) continue;
      Result<void> checked;
      if (info.kind == ParamKind::InputFile) checked = checkInputFile(*text);
      if (info.kind == ParamKind::OutputFile) checked = checkOutputFile(*text);
      if (info.kind == ParamKind::OutputDirectory) checked = checkOutputDirectory(*text);
      const std::string where = graph.nameOf(i, info.name);
      if (!checked.ok()) diagnostics.add(graph.originOf(i, info.name), where, checked.error());
      const std::string key = ownerKey(node, info, *text);
      if (key.empty()) continue;
      const auto [owner, isFirst] = owners.emplace(key, where);
      if (!isFirst)
        diagnostics.add(graph.originOf(i, info.name), where, owner->second + " writes to the same path",
                        "give each a path of its own");
    }
  }
}

}  // namespace sherd
