#include "cli/shots.h"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "cli/cache_size.h"
#include "cli/open_graph.h"
#include "graph/subgraphs.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

void complain(Diagnostics& diagnostics, std::string what, std::string remedy) {
  diagnostics.add({}, "", Error{std::move(what), std::move(remedy), {}, Error::Kind::Input});
}

std::vector<std::string> graphsIn(const std::string& directory) {
  std::vector<std::string> files;
  std::error_code problem;
  for (fs::directory_iterator it(directory, problem), end; !problem && it != end; it.increment(problem))
    if (it->path().extension() == ".json" && it->is_regular_file(problem))
      files.push_back(it->path().string());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> graphsLike(const std::string& pattern) {
  std::vector<std::string> files;
  glob_t found{};
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  return files;
}

std::string canonicalPath(const std::string& path) {
  std::error_code problem;
  const fs::path canonical = fs::weakly_canonical(path, problem);
  return problem ? path : canonical.string();
}

/// As many of the last parts of each path as it takes to tell them apart.
std::vector<std::string> shortNames(const std::vector<std::string>& paths) {
  std::vector<std::string> names(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    fs::path path = fs::path(canonicalPath(paths[i])).replace_extension();
    names[i] = path.filename().string();
    auto isTaken = [&] {
      return std::count_if(paths.begin(), paths.end(), [&](const std::string& other) {
               const std::string full = '/' + fs::path(canonicalPath(other)).replace_extension().string();
               return full.ends_with('/' + names[i]);
             }) > 1;
    };
    while (isTaken() && path.has_parent_path() && path != path.parent_path()) {
      path = path.parent_path();
      names[i] = path.filename().string() + '/' + names[i];
    }
  }
  return names;
}

}  // namespace

std::vector<std::string> graphFiles(const std::vector<std::string>& arguments, Diagnostics& diagnostics) {
  std::vector<std::string> files;
  std::set<std::string> seen;
  for (const std::string& argument : arguments) {
    std::error_code problem;
    std::vector<std::string> found{argument};
    if (fs::is_directory(argument, problem)) {
      found = graphsIn(argument);
      if (found.empty())
        complain(diagnostics, inQuotes(argument) + " is a directory without graphs",
                 "graphs are named *.json");
    } else if (!fs::exists(argument, problem) && argument.find_first_of("*?[") != std::string::npos) {
      found = graphsLike(argument);
      if (found.empty())
        complain(diagnostics, "no file is like " + inQuotes(argument),
                 "name graph files or a directory of them");
    }
    for (std::string& file : found)
      if (seen.insert(canonicalPath(file)).second) files.push_back(std::move(file));
  }
  return files;
}

Shots openShots(const ShotOptions& options, Opening opening, const Registry& registry,
                const Environment& environment, Diagnostics& diagnostics) {
  Shots shots;
  const std::vector<std::string> files = graphFiles(options.graphs, diagnostics);
  const std::vector<std::string> names = shortNames(files);
  for (std::size_t k = 0; k < files.size(); ++k) {
    GraphFile file;
    const std::size_t before = diagnostics.count();
    Graph graph = openGraph(files[k], options, registry, environment, diagnostics, file);
    if (opening == Opening::ToRun) refuseSubgraphFile(file, diagnostics);
    shots.notes.insert(shots.notes.end(), file.notes.begin(), file.notes.end());
    const int first = static_cast<int>(shots.graph.nodes.size());
    if (diagnostics.count() == before) {
      const auto wanted = wantedNodes(graph, options.target, options.to);
      if (!wanted.ok()) diagnostics.add({file.source, 0, 0}, "", wanted.error());
      for (const int i : wanted.ok() ? *wanted : std::vector<int>()) shots.wanted.push_back(first + i);
    }
    shots.shots.push_back({files[k], names[k]});
    shots.isSubgraph.push_back(file.subgraph != nullptr);
    if (files.size() == 1)
      shots.graph = std::move(graph);
    else
      append(shots.graph, graph, names[k]);
  }
  std::vector<int> nodes;
  if (opening == Opening::ToCheck)
    for (std::size_t i = 0; i < shots.graph.nodes.size(); ++i) nodes.push_back(static_cast<int>(i));
  else if (diagnostics.empty())
    nodes = neededNodes(shots.graph, shots.wanted);
  checkFiles(shots.graph, nodes, options.allowWrite, diagnostics);
  return shots;
}

Result<std::unique_ptr<DiskStore>> openStore(const ShotOptions& options, const Environment& environment,
                                             std::ostream& err) {
  if (options.noCache) return std::unique_ptr<DiskStore>();
  const std::string directory =
      options.cache.empty() ? DiskStore::defaultDirectory(environment.variable) : options.cache;
  if (directory.empty()) return std::unique_ptr<DiskStore>();
  SHERD_ASSIGN(const std::uint64_t mostBytes, cacheSize(options.cacheSize, "--cache-size", environment));
  auto store =
      DiskStore::open(directory, {.mostBytes = mostBytes, .onWarning = [&err](const std::string& text) {
                                    err << "warning: " << text << '\n' << std::flush;
                                  }});
  if (store.ok()) return std::move(store).value();
  if (!options.cache.empty()) return store.error();
  err << "warning: " << store.error().text() << "; going on without a cache\n";
  return std::unique_ptr<DiskStore>();
}

std::vector<History> readHistories(const Shots& shots, const DiskStore* store) {
  std::vector<History> histories(shots.shots.size());
  for (std::size_t k = 0; k < histories.size() && store != nullptr; ++k)
    histories[k] = unpack(store->history(canonicalPath(shots.shots[k].path)));
  return histories;
}

void writeHistories(const Shots& shots, const EvalReport& report, DiskStore& store) {
  FileDigests files(&store);
  for (std::size_t k = 0; k < shots.shots.size(); ++k) {
    const std::string name = canonicalPath(shots.shots[k].path);
    History history = unpack(store.history(name));
    update(history, shots.graph, static_cast<int>(k), report, files);
    store.setHistory(name, pack(history));
  }
}

}  // namespace sherd
