#include <algorithm>
#include <filesystem>
#include <map>

#include "cli/json_events.h"
#include "cli/open_graph.h"
#include "cli/progress.h"
#include "cli/verbs.h"
#include "graph/subgraphs.h"

namespace sherd {
namespace {

std::vector<std::string> writtenFiles(const EvalReport& report) {
  std::vector<std::string> files;
  for (const NodeReport& node : report.nodes)
    files.insert(files.end(), node.written.begin(), node.written.end());
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// One line per directory: how many files, and the names of the few that are worth opening first.
void printWritten(const std::vector<std::string>& files, std::ostream& out) {
  constexpr std::size_t kMostNamed = 6;
  std::map<std::string, std::vector<std::string>> byDirectory;
  for (const std::string& file : files) {
    const std::filesystem::path path(file);
    byDirectory[path.parent_path().string()].push_back(path.filename().string());
  }
  for (const auto& [directory, names] : byDirectory) {
    out << "wrote " << countText(names.size(), "file") << " in " << shownPath(directory);
    auto isKey = [&](const std::string& name) {
      return names.size() <= kMostNamed || name.ends_with(".png") || name.ends_with(".json");
    };
    std::size_t named = 0;
    for (const std::string& name : names)
      if (isKey(name) && named < kMostNamed) out << (named++ == 0 ? ": " : ", ") << name;
    out << (named < names.size() && named > 0 ? ", …\n" : "\n");
  }
}

/// Node failures as "file:line:column: node.port: what; remedy".
Diagnostics failures(const Graph& graph, const EvalReport& report) {
  Diagnostics diagnostics;
  for (const NodeReport& node : report.nodes)
    if (node.error)
      diagnostics.add(graph.originOf(node.node, node.error->port), graph.nameOf(node.node, node.error->port),
                      *node.error);
  return diagnostics;
}

void printSummary(const EvalReport& report, const std::vector<std::string>& files, Console& console) {
  printWritten(files, console.out);
  console.out << (report.cancelled ? "cancelled after "
                  : report.ok()    ? "done in "
                                   : "failed after ")
              << durationText(report.ms) << " (" << countText(report.nodes.size(), "node");
  for (const NodeState state : {NodeState::Hit, NodeState::Failed, NodeState::Skipped})
    if (const int count = report.count(state); count > 0)
      console.out << ", " << count << ' ' << (state == NodeState::Hit ? "cached" : stateName(state));
  console.out << ")\n" << std::flush;
}

/// What the file may say but this program can't do yet. A wedge stands for several runs, and one of them
/// would not be what was asked for. A frame range is: whatever reads ${frame} is an error, so all frames are
/// the same.
void tellUnsupported(const GraphFile& file, Diagnostics& diagnostics, Console& console) {
  if (file.wedge)
    diagnostics.add(file.wedge->origin, "wedge", "wedges are not supported yet",
                    "run once per value, with --var");
  if (file.frames)
    console.err
        << file.frames->origin.text()
        << ": warning: frames: frame ranges are not supported yet; nothing here depends on the frame, "
           "so one evaluation stands for all\n";
}

int refuse(const Diagnostics& diagnostics, const RunOptions& options, Console& console) {
  printDiagnostics(diagnostics, console.err);
  if (options.json) {
    jsonErrors(diagnostics, console.out);
    jsonDone(false, 0, {}, console.out);
  }
  return kWrongInput;
}

}  // namespace

int runVerb(const RunOptions& options, const Registry& registry, const Environment& environment,
            Console& console) {
  Diagnostics diagnostics;
  GraphFile file;
  const Graph graph =
      openGraph(options.graph, options.vars, options.sets, registry, environment, diagnostics, file);
  tellUnsupported(file, diagnostics, console);
  refuseSubgraphFile(file, diagnostics);
  if (!diagnostics.empty()) return refuse(diagnostics, options, console);
  const auto wanted = wantedNodes(graph, options.target, options.to);
  if (!wanted.ok()) diagnostics.add({file.source, 0, 0}, "", wanted.error());
  const std::vector<int> needed = wanted.ok() ? neededNodes(graph, *wanted) : std::vector<int>();
  checkFiles(graph, needed, diagnostics);
  if (!diagnostics.empty()) return refuse(diagnostics, options, console);

  ProgressPrinter printer(graph, needed, options.quiet, console);
  JsonEvents events(graph, console);
  EvalListener& listener = options.json ? static_cast<EvalListener&>(events) : printer;
  Cache cache;
  const EvalReport report =
      evaluate(graph, *wanted, cache, console.cancel, {.keepGoing = options.keepGoing}, &listener);
  const std::vector<std::string> files = writtenFiles(report);
  if (!options.json) printer.end();
  printDiagnostics(failures(graph, report), console.err);
  if (options.json)
    jsonDone(report.ok(), report.ms, files, console.out);
  else if (!options.quiet)
    printSummary(report, files, console);
  if (report.cancelled) return kCancelled;
  return report.ok() ? kOk : kNodeFailed;
}

}  // namespace sherd
