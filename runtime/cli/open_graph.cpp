#include "cli/open_graph.h"

#include "graph/migrate.h"
#include "graph/subgraphs.h"

namespace sherd {
namespace {

std::vector<Assignment> parseAll(const char* option, const std::vector<std::string>& typed,
                                 const Environment& environment, Diagnostics& diagnostics) {
  std::vector<Assignment> assignments;
  for (const std::string& text : typed) {
    auto assignment = parseAssignment(option, text, environment);
    if (assignment.ok())
      assignments.push_back(std::move(assignment).value());
    else
      diagnostics.add({}, "", assignment.error());
  }
  return assignments;
}

}  // namespace

Graph openGraph(const std::string& path, const ShotOptions& options, const Registry& registry,
                const Environment& environment, Diagnostics& diagnostics, GraphFile& file) {
  const Overrides overrides{parseAll("--var", options.vars, environment, diagnostics),
                            parseAll("--set", options.sets, environment, diagnostics), options.frames};
  const std::size_t before = diagnostics.count();
  file = readGraphFile(path, diagnostics);
  expandSubgraphs(file, diagnostics);
  migrate(file, registry, diagnostics, file.notes);
  // Of a file that can't be read as a graph, nothing more can be said.
  if (file.nodes.empty() && diagnostics.count() > before) return {};
  return checkGraph(file, registry, overrides, environment, diagnostics);
}

}  // namespace sherd
