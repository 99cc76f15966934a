#include "cli/report_data.h"

#include <algorithm>

#include "eval/key.h"
#include "graph/param.h"

namespace sherd {
namespace {

std::vector<ReportPort> portsOf(const std::vector<PortInfo>& ports) {
  std::vector<ReportPort> list;
  for (const PortInfo& port : ports) list.push_back({port.name, port.type, port.help});
  return list;
}

std::vector<ReportParam> paramsOf(const Graph::Node& node) {
  std::vector<ReportParam> list;
  for (std::size_t p = 0; p < node.type->params.size(); ++p) {
    const ParamInfo& info = node.type->params[p];
    const ParamValue& value = node.params.at(info.name);
    const bool isWired = std::any_of(node.wiredParams.begin(), node.wiredParams.end(),
                                     [&](const Graph::Wire& wire) { return wire.to == static_cast<int>(p); });
    list.push_back({info.name, paramText(value), paramText(info.fallback), info.unit, info.help,
                    !isWired && value == info.fallback, isWired});
  }
  return list;
}

void addOutcome(const NodeReport& report, ReportNode& node) {
  node.state = stateName(report.state);
  node.ms = report.ms;
  node.threads = report.threads;
  node.memoryBytes = report.bytes;
  node.cacheBytes = report.kept;
  for (const Message& message : report.messages)
    node.messages.push_back((message.level == LogLevel::Warning ? "warning: " : "") + message.text);
  if (report.error) node.error = report.error->text();
  node.written = report.written;
}

}  // namespace

ReportData reportOf(const Shots& shots, const std::string& command, const std::vector<PlanEntry>& plan,
                    const EvalReport& report) {
  const Graph& graph = shots.graph;
  ReportData data;
  for (const Shot& shot : shots.shots) data.title += (data.title.empty() ? "" : ", ") + shot.name;
  data.command = command;
  data.ok = report.ok();
  data.cancelled = report.cancelled;
  data.ms = report.ms;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const Graph::Node& node = graph.nodes[i];
    ReportNode& shown = data.nodes.emplace_back();
    shown.graph = graph.shots[static_cast<std::size_t>(node.shot)];
    shown.name = node.name;
    shown.context = graph.contexts[static_cast<std::size_t>(node.context)].label;
    shown.type = node.type->name;
    shown.help = node.type->help;
    shown.state = "not needed";
    if (i < plan.size()) shown.why = plan[i].why;
    shown.inputs = portsOf(node.type->inputs);
    shown.outputs = portsOf(node.type->outputs);
    shown.params = paramsOf(node);
    forEachWire(node, [&](const Graph::Wire& wire, bool isParam) {
      const auto to = static_cast<std::size_t>(wire.to), output = static_cast<std::size_t>(wire.output);
      data.wires.push_back({wire.node, static_cast<int>(i),
                            graph.nodes[static_cast<std::size_t>(wire.node)].type->outputs[output].name,
                            isParam ? node.type->params[to].name : node.type->inputs[to].name});
    });
  }
  for (const NodeReport& node : report.nodes) {
    addOutcome(node, data.nodes[static_cast<std::size_t>(node.node)]);
    for (const std::string& file : node.written)
      if (file.ends_with(".png")) data.pictures.push_back(file);
  }
  std::sort(data.pictures.begin(), data.pictures.end());
  return data;
}

}  // namespace sherd
