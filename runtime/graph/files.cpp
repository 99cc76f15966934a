#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <system_error>

#include "graph/graph.h"
#include "graph/param.h"
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

/// `path` with what is there of it freed from links, so that no link leads out of a folder unseen.
fs::path resolved(const fs::path& path) {
  std::error_code problem;
  fs::path result = fs::weakly_canonical(path, problem);
  return problem ? path.lexically_normal() : result;
}

bool isInside(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end() || (std::next(end) == folder.end() && end->empty());
}

class FileChecker {
 public:
  FileChecker(const Graph& graph, const std::vector<std::string>& allowed, Diagnostics& diagnostics)
      : graph_(graph), diagnostics_(diagnostics) {
    for (const std::string& folder : allowed) allowed_.push_back(resolved(folder));
  }

  void check(int i) {
    const Graph::Node& node = graph_.nodes[static_cast<std::size_t>(i)];
    if (node.type == nullptr) return;
    for (std::size_t p = 0; p < node.type->params.size(); ++p) {
      const ParamInfo& info = node.type->params[p];
      if (!isPath(info.kind)) continue;
      const bool wired = std::any_of(node.wiredParams.begin(), node.wiredParams.end(),
                                     [&](const Graph::Wire& wire) { return wire.to == static_cast<int>(p); });
      const auto* text = wired ? nullptr : std::get_if<std::string>(&node.params.at(info.name));
      if (text == nullptr || text->empty()) continue;
      checkPath(i, info, *text);
      if (info.kind == ParamKind::InputFile) continue;
      checkPlace(i, info, *text);
      checkOwner(i, info, *text);
    }
  }

 private:
  void complain(int i, const ParamInfo& info, Error error) {
    diagnostics_.add(graph_.originOf(i, info.name), graph_.nameOf(i, info.name), std::move(error));
  }

  /// Each path of each kind once: a thousand frames that read one file look at it once.
  void checkPath(int i, const ParamInfo& info, const std::string& path) {
    if (!seen_.emplace(info.kind, path).second) return;
    Result<void> checked;
    if (info.kind == ParamKind::InputFile) checked = checkInputFile(path);
    if (info.kind == ParamKind::OutputFile) checked = checkOutputFile(path);
    if (info.kind == ParamKind::OutputDirectory) checked = checkOutputDirectory(path);
    if (!checked.ok()) complain(i, info, checked.error());
  }

  /// Outputs stay in the folder of the graph that is run, wherever a subgraph's file lies, unless the user
  /// says otherwise: a graph from elsewhere can't write where it likes.
  void checkPlace(int i, const ParamInfo& info, const std::string& path) {
    const Graph::Node& node = graph_.nodes[static_cast<std::size_t>(i)];
    if (std::find(node.typedPaths.begin(), node.typedPaths.end(), info.name) != node.typedPaths.end()) return;
    const fs::path folder =
        info.kind == ParamKind::OutputFile ? fs::path(path).parent_path() : fs::path(path);
    const auto [found, isNew] = mayWrite_.emplace(std::pair(folder, node.home->directory), false);
    if (isNew) {
      const fs::path real = resolved(folder);
      found->second = isInside(real, resolved(node.home->directory)) ||
                      std::any_of(allowed_.begin(), allowed_.end(),
                                  [&](const fs::path& allowed) { return isInside(real, allowed); });
      if (!found->second)
        complain(i, info,
                 wrong(pathInQuotes(path) + " is outside of the graph's folder",
                       "write below it, name the place on the command line (--var, --set), or allow it with "
                       "--allow-write " +
                           folder.string()));
    }
  }

  /// A file has one owner; and nodes of one type that own one directory would delete each other's files.
  void checkOwner(int i, const ParamInfo& info, const std::string& path) {
    const Graph::Node& node = graph_.nodes[static_cast<std::size_t>(i)];
    const std::string key =
        info.kind == ParamKind::OutputFile ? "file " + path : "directory " + node.type->name + ' ' + path;
    const auto [owner, isFirst] = owners_.emplace(key, std::pair(i, info.name));
    if (isFirst) return;
    const auto& [other, port] = owner->second;
    const Graph::Node& first = graph_.nodes[static_cast<std::size_t>(other)];
    const bool isOfAnotherGraph = first.shot != node.shot;
    if (first.name != node.name) {
      const std::string place = isOfAnotherGraph ? " of " + first.home->name : "";
      complain(i, info,
               wrong(graph_.nameOf(other, port) + place + " writes to the same path",
                     "give each a path of its own"));
      return;
    }
    if (!clashes_.emplace(node.shot, node.name + '.' + info.name).second) return;
    if (isOfAnotherGraph) {
      complain(i, info,
               wrong(first.home->name + " and " + node.home->name + " write to the same path",
                     "give each graph a path of its own"));
      return;
    }
    const Graph::Context& one = graph_.contexts[static_cast<std::size_t>(first.context)];
    const Graph::Context& two = graph_.contexts[static_cast<std::size_t>(node.context)];
    complain(i, info,
             wrong(one.label + " and " + two.label + " write to the same path",
                   "put " + distinction(one, two) + " into it"));
  }

  static std::string distinction(const Graph::Context& one, const Graph::Context& two) {
    if (one.frame != two.frame) return "${frame:04}";
    for (std::size_t k = 0; k < one.values.size() && k < two.values.size(); ++k)
      if (one.values[k] != two.values[k]) return "${" + one.values[k].first + "}";
    return "what tells them apart";
  }

  const Graph& graph_;
  Diagnostics& diagnostics_;
  std::vector<fs::path> allowed_;
  std::set<std::pair<ParamKind, std::string>> seen_;
  std::map<std::pair<fs::path, fs::path>, bool> mayWrite_;  ///< by folder and home
  std::map<std::string, std::pair<int, std::string>> owners_;
  std::set<std::pair<int, std::string>> clashes_;  ///< by shot
};

}  // namespace

void checkFiles(const Graph& graph, const std::vector<int>& nodes, const std::vector<std::string>& allowed,
                Diagnostics& diagnostics) {
  FileChecker checker(graph, allowed, diagnostics);
  for (const int i : nodes) checker.check(i);
}

}  // namespace sherd
