#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/json_events.h"
#include "cli/text_table.h"
#include "cli/verbs.h"
#include "eval/plan.h"

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

/// Frames of one node that the plan says the same of.
struct Fold {
  const PlanEntry* first = nullptr;
  std::vector<std::int64_t> frames;
  std::string wedge;
  double ms = 0;  ///< of all of them
};

std::string wedgeText(const Graph::Context& context) {
  std::string text;
  for (const auto& [name, value] : context.values) text += (text.empty() ? "" : ", ") + name + ' ' + value;
  return text;
}

std::string whereText(const Fold& fold) {
  std::string text;
  if (!fold.frames.empty()) text = (fold.frames.size() == 1 ? "frame " : "frames ") + framesText(fold.frames);
  return text + (text.empty() || fold.wedge.empty() ? "" : ", ") + fold.wedge;
}

std::string stateText(const PlanEntry& entry) {
  return entry.state == PlanState::Follows ? "may run" : planStateName(entry.state);
}

std::string whyText(const Fold& fold) {
  const bool mayRun = fold.first->state == PlanState::Run || fold.first->state == PlanState::Follows;
  return fold.first->why + (mayRun && fold.ms >= 1 ? ", about " + durationText(fold.ms) : "");
}

/// The node's lines, one for all frames that agree.
void addLines(const Graph& graph, std::vector<PlanEntry>::const_iterator begin,
              std::vector<PlanEntry>::const_iterator end, std::vector<Row>& rows) {
  std::vector<Fold> folds;
  std::map<std::string, std::size_t> index;
  for (auto it = begin; it != end; ++it) {
    const Graph::Context& context =
        graph.contexts[static_cast<std::size_t>(graph.nodes[static_cast<std::size_t>(it->node)].context)];
    const std::string wedge = wedgeText(context);
    const auto [found, isNew] = index.emplace(stateText(*it) + '\n' + it->why + '\n' + wedge, folds.size());
    if (isNew) folds.push_back({&*it, {}, wedge});
    folds[found->second].ms += it->ms;
    if (context.frame) folds[found->second].frames.push_back(*context.frame);
  }
  for (const Fold& fold : folds) {
    const Graph::Node& node = graph.nodes[static_cast<std::size_t>(fold.first->node)];
    const std::string shot = graph.shots[static_cast<std::size_t>(node.shot)];
    rows.push_back({(shot.empty() ? "" : shot + ": ") + node.name, node.type->name, whereText(fold),
                    stateText(*fold.first), whyText(fold)});
  }
}

void printPlan(const Graph& graph, const std::vector<PlanEntry>& plan, Console& console) {
  std::vector<Row> rows;
  for (auto begin = plan.begin(); begin != plan.end();) {
    const Graph::Node& node = graph.nodes[static_cast<std::size_t>(begin->node)];
    const auto end = std::find_if(begin, plan.end(), [&](const PlanEntry& entry) {
      const Graph::Node& other = graph.nodes[static_cast<std::size_t>(entry.node)];
      return other.name != node.name || other.shot != node.shot;
    });
    addLines(graph, begin, end, rows);
    begin = end;
  }
  printTable(rows, console.width, console.out);
  std::map<PlanState, std::size_t> counts;
  for (const PlanEntry& entry : plan) ++counts[entry.state];
  console.out << counts[PlanState::Run] << " to run, " << counts[PlanState::Follows] << " may run, "
              << countText(counts[PlanState::Hit], "hit") << ", " << counts[PlanState::NotNeeded]
              << " not needed\n";
}

void printJson(const Graph& graph, const std::vector<PlanEntry>& plan, Console& console) {
  for (const PlanEntry& entry : plan) {
    const Graph::Node& node = graph.nodes[static_cast<std::size_t>(entry.node)];
    Json event{{"event", "plan"}};
    if (graph.shots.size() > 1) event["graph"] = graph.shots[static_cast<std::size_t>(node.shot)];
    event["name"] = node.name;
    event["context"] = graph.contexts[static_cast<std::size_t>(node.context)].label;
    event["type"] = node.type->name;
    event["state"] = planStateName(entry.state);
    event["why"] = entry.why;
    event["ms"] = entry.ms;
    console.out << event.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  }
  console.out << std::flush;
}

}  // namespace

int planVerb(const PlanOptions& options, const Registry& registry, const Environment& environment,
             Console& console) {
  Diagnostics diagnostics;
  const Shots shots = openShots(options, Opening::ToRun, registry, environment, diagnostics);
  std::unique_ptr<DiskStore> store;
  if (diagnostics.empty()) {
    auto opened = openStore(options, environment, console.err);
    if (opened.ok())
      store = std::move(opened).value();
    else
      diagnostics.add({}, opened.error().port, opened.error());
  }
  if (!diagnostics.empty()) {
    printDiagnostics(diagnostics, console.err);
    if (options.json) jsonErrors(diagnostics, console.out);
    return kWrongInput;
  }
  for (const std::string& note : shots.notes) console.err << note << '\n';
  Cache cache;
  const EvalOptions how{.values = false, .disk = store.get()};
  const auto plan = planRun(shots.graph, shots.wanted, cache, how, readHistories(shots, store.get()));
  if (options.json)
    printJson(shots.graph, plan, console);
  else
    printPlan(shots.graph, plan, console);
  return kOk;
}

}  // namespace sherd
