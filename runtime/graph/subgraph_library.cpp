#include "graph/subgraph_library.h"

#include <system_error>

#include "graph/suggest.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::string pathInQuotes(const fs::path& path) { return inQuotes(path.string(), path.string().size()); }

/// As the user would name the file from where the one that names it was named.
std::string shownName(const SubgraphEntry& entry) {
  return (fs::path(entry.fileOrigin.source->name).parent_path() / entry.file).lexically_normal().string();
}

}  // namespace

const KnownSubgraph* SubgraphScope::find(const std::string& name) const {
  for (const SubgraphScope* scope = this; scope != nullptr; scope = scope->outer)
    if (const auto found = scope->names.find(name); found != scope->names.end()) return found->second;
  return nullptr;
}

SubgraphLibrary::SubgraphLibrary(const std::vector<SubgraphEntry>& table, Diagnostics& diagnostics)
    : diagnostics_(diagnostics), top_(addTable(table, nullptr, 0)) {}

const SubgraphScope* SubgraphLibrary::addTable(const std::vector<SubgraphEntry>& table,
                                               const SubgraphScope* outer, int depth) {
  SubgraphScope& scope = scopes_.emplace_back();
  scope.outer = outer;
  for (const SubgraphEntry& entry : table) {
    KnownSubgraph& known = known_.emplace_back(KnownSubgraph{entry.name, entry.origin, nullptr, nullptr});
    scope.names.emplace(entry.name, &known);
    if (entry.definition != nullptr) {
      known.definition = entry.definition.get();
      known.scope = addTable(entry.definition->subgraphs, &scope, depth + 1);
    } else if (!entry.file.empty()) {
      const File file = load(entry, depth + 1);
      known.definition = file.subgraph.get();
      known.scope = file.scope;
    }
  }
  return &scope;
}

SubgraphLibrary::File SubgraphLibrary::load(const SubgraphEntry& entry, int depth) {
  const fs::path path = (entry.fileOrigin.source->directory / entry.file).lexically_normal();
  if (const auto known = files_.find(path); known != files_.end()) return known->second;
  if (depth > kDeepest) {
    diagnostics_.add(entry.fileOrigin, "subgraphs." + entry.name, "files name files more than 64 deep",
                     "nest them less");
    return {};
  }
  File& file = files_[path];
  file.subgraph = read(entry, path);
  if (file.subgraph == nullptr) return file;
  // The file may name itself, so that its scope must be known before its table is read: it is filled then.
  SubgraphScope& scope = scopes_.emplace_back();
  file.scope = &scope;
  const SubgraphScope* filled = addTable(file.subgraph->subgraphs, nullptr, depth);
  scope.names = filled->names;
  return file;
}

std::shared_ptr<const Subgraph> SubgraphLibrary::read(const SubgraphEntry& entry, const fs::path& path) {
  const std::string where = "subgraphs." + entry.name;
  std::error_code problem;
  if (!fs::exists(path, problem)) {
    diagnostics_.add(entry.fileOrigin, where, "there is no file " + pathInQuotes(path),
                     "correct the path, which is relative to this file");
    return nullptr;
  }
  const auto text = readGraphText(path);
  if (!text.ok()) {
    diagnostics_.add(entry.fileOrigin, where, pathInQuotes(path) + ": " + text.error().what,
                     "name a file with a subgraph");
    return nullptr;
  }
  const std::size_t before = diagnostics_.count();
  const auto source = std::make_shared<const Source>(Source{shownName(entry), path.parent_path()});
  const GraphFile file = readGraph(*text, source, diagnostics_);
  if (file.subgraph == nullptr && diagnostics_.count() == before)
    diagnostics_.add(entry.fileOrigin, where,
                     pathInQuotes(path) + " is no subgraph: it declares no \"inputs\" and no \"outputs\"",
                     "name a file with a subgraph");
  return file.subgraph;
}

}  // namespace sherd
