#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>

#include "cli/json_events.h"
#include "cli/progress.h"
#include "cli/report_data.h"
#include "cli/text_table.h"
#include "cli/verbs.h"

namespace sherd {
namespace {

/// The files of nodes that ran, of those that were hits, or of all.
std::vector<std::string> writtenFiles(const EvalReport& report, std::optional<NodeState> state = {}) {
  std::vector<std::string> files;
  for (const NodeReport& node : report.nodes)
    if (!state || node.state == *state) files.insert(files.end(), node.written.begin(), node.written.end());
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// One line per directory: how many files, and the names of the few that are worth opening first.
void printWritten(const std::string& what, const std::vector<std::string>& files, std::ostream& out) {
  constexpr std::size_t kMostNamed = 6;
  std::map<std::string, std::vector<std::string>> byDirectory;
  for (const std::string& file : files) {
    const std::filesystem::path path(file);
    byDirectory[path.parent_path().string()].push_back(path.filename().string());
  }
  for (const auto& [directory, names] : byDirectory) {
    out << what << countText(names.size(), "file") << " in " << shownPath(directory);
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

void printSummary(const EvalReport& report, Console& console) {
  printWritten("up to date: ", writtenFiles(report, NodeState::Hit), console.out);
  printWritten("wrote ", writtenFiles(report, NodeState::Run), console.out);
  console.out << (report.cancelled ? "cancelled after "
                  : report.ok()    ? "done in "
                                   : "failed after ")
              << durationText(report.ms) << " (" << countText(report.nodes.size(), "node");
  for (const NodeState state : {NodeState::Hit, NodeState::Failed, NodeState::Skipped})
    if (const int count = report.count(state); count > 0)
      console.out << ", " << count << ' ' << (state == NodeState::Hit ? "cached" : stateName(state));
  console.out << ")\n" << std::flush;
}

/// A line for each of several graphs.
void printShots(const Shots& shots, const EvalReport& report, Console& console) {
  if (shots.shots.size() < 2) return;
  struct Count {
    std::array<int, 4> states{};
    double ms = 0;
  };
  std::vector<Count> counts(shots.shots.size());
  for (const NodeReport& node : report.nodes) {
    Count& count =
        counts[static_cast<std::size_t>(shots.graph.nodes[static_cast<std::size_t>(node.node)].shot)];
    ++count.states[static_cast<std::size_t>(node.state)];
    count.ms += node.ms;
  }
  std::vector<Row> rows{{"graph", "ran", "cached", "failed", "skipped", "node time", ""}};
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const auto& states = counts[k].states;
    const bool ok = states[2] + states[3] == 0;
    rows.push_back({shots.shots[k].name, std::to_string(states[0]), std::to_string(states[1]),
                    std::to_string(states[2]), std::to_string(states[3]), durationText(counts[k].ms),
                    ok              ? "ok"
                    : states[2] > 0 ? "FAILED"
                                    : "not finished"});
  }
  printTable(rows, console.width, console.out);
}

int refuse(const Diagnostics& diagnostics, const RunOptions& options, Console& console) {
  printDiagnostics(diagnostics, console.err);
  if (options.json) {
    jsonErrors(diagnostics, console.out);
    jsonDone(false, 0, {}, console.out);
  }
  return kWrongInput;
}

int refuse(const Error& error, const RunOptions& options, Console& console) {
  Diagnostics diagnostics;
  diagnostics.add({}, error.port, error);
  return refuse(diagnostics, options, console);
}

}  // namespace

int runVerb(const RunOptions& options, const Registry& registry, const Environment& environment,
            Console& console) {
  Diagnostics diagnostics;
  const Shots shots = openShots(options, Opening::ToRun, registry, environment, diagnostics);
  for (const std::string& note : shots.notes) console.err << note << '\n';
  if (!diagnostics.empty()) return refuse(diagnostics, options, console);
  auto opened = openStore(options, environment, console.err);
  if (!opened.ok()) return refuse(opened.error(), options, console);
  DiskStore* store = opened.value().get();
  const std::vector<int> needed = neededNodes(shots.graph, shots.wanted);
  const EvalOptions how{.keepGoing = options.keepGoing, .values = false, .disk = store};
  Cache cache;
  std::vector<PlanEntry> plan;
  if (!options.report.empty())
    plan = planRun(shots.graph, shots.wanted, cache, how, readHistories(shots, store));

  ProgressPrinter printer(shots.graph, needed, options.quiet, console);
  JsonEvents events(shots.graph, console);
  EvalListener& listener = options.json ? static_cast<EvalListener&>(events) : printer;
  const EvalReport report = evaluate(shots.graph, shots.wanted, cache, console.cancel, how, &listener);
  if (store != nullptr) writeHistories(shots, report, *store);
  const std::vector<std::string> files = writtenFiles(report);
  if (!options.json) printer.end();
  printDiagnostics(failures(shots.graph, report), console.err);
  bool isReported = true;
  if (!options.report.empty()) {
    const auto written = writeReport(reportOf(shots, options.command, plan, report), options.report);
    if (!written.ok()) {
      Diagnostics problem;
      problem.add({}, "--report", written.error());
      printDiagnostics(problem, console.err);
      isReported = false;
    }
  }
  if (options.json) {
    jsonDone(report.ok(), report.ms, files, console.out);
  } else if (!options.quiet) {
    printShots(shots, report, console);
    printSummary(report, console);
  }
  if (report.cancelled) return kCancelled;
  return report.ok() && isReported ? kOk : kNodeFailed;
}

}  // namespace sherd
