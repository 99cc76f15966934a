#include "cli/report_json.h"

#include <nlohmann/json.hpp>

#include "cli/console.h"
#include "cli/report_text.h"

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

Json portsJson(const std::vector<ReportPort>& ports) {
  Json json = Json::array();
  for (const ReportPort& port : ports)
    json.push_back({{"name", port.name}, {"type", port.type}, {"help", port.help}});
  return json;
}

Json paramsJson(const std::vector<ReportParam>& params) {
  Json json = Json::array();
  for (const ReportParam& param : params)
    json.push_back({{"name", param.name},
                    {"value", param.value},
                    {"fallback", param.fallback},
                    {"unit", param.unit},
                    {"help", param.help},
                    {"set", !param.isDefault},
                    {"wired", param.isWired}});
  return json;
}

bool sameParams(const std::vector<ReportParam>& a, const std::vector<ReportParam>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ReportParam& p, const ReportParam& q) {
    return p.name == q.name && p.value == q.value && p.fallback == q.fallback && p.isWired == q.isWired;
  });
}

/// Parameters are left out where they are those of the node's first run: most don't depend on the frame.
Json runJson(const ReportNode& node, const ReportNode& first) {
  Json json{{"context", node.context},
            {"state", shownState(node.state)},
            {"why", node.why},
            {"ms", node.ms},
            {"time", node.ms > 0 ? durationText(node.ms) : ""},
            {"threads", node.threads},
            {"memory", node.memoryBytes > 0 ? byteText(node.memoryBytes) : ""},
            {"cache", node.cacheBytes > 0 ? byteText(node.cacheBytes) : ""},
            {"messages", node.messages},
            {"error", node.error},
            {"written", node.written}};
  if (&node == &first || !sameParams(node.params, first.params)) json["params"] = paramsJson(node.params);
  return json;
}

Json groupJson(const ReportData& data, const ReportGroup& group) {
  const auto nodeOf = [&](int run) -> const ReportNode& { return data.nodes[static_cast<std::size_t>(run)]; };
  const ReportNode& first = nodeOf(group.runs.front());
  Json runs = Json::array();
  for (const int run : group.runs) runs.push_back(runJson(nodeOf(run), first));
  return {{"graph", first.graph},
          {"name", first.name},
          {"type", first.type},
          {"help", first.help},
          {"state", group.stateText()},
          {"time", group.ms > 0 ? durationText(group.ms) : ""},
          {"memory", group.memoryBytes > 0 ? byteText(group.memoryBytes) : ""},
          {"cache", group.cacheBytes > 0 ? byteText(group.cacheBytes) : ""},
          {"inputs", portsJson(first.inputs)},
          {"outputs", portsJson(first.outputs)},
          {"leftOut", group.all - group.runs.size()},
          {"runs", std::move(runs)}};
}

}  // namespace

std::string reportJson(const ReportData& data, const ReportGroups& grouped) {
  Json states = Json::array(), groups = Json::array(), wires = Json::array();
  for (const ShownState& state : kShownStates)
    states.push_back({{"name", state.name}, {"style", state.style}});
  for (const ReportGroup& group : grouped.groups) groups.push_back(groupJson(data, group));
  for (const GroupWire& wire : grouped.wires)
    wires.push_back({{"from", wire.from}, {"output", wire.output}, {"to", wire.to}, {"input", wire.input}});
  const std::string json =
      Json{{"states", std::move(states)}, {"groups", std::move(groups)}, {"wires", std::move(wires)}}.dump(
          -1, ' ', false, Json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      escaped += "\\u003c";
    else
      escaped += c;
  return escaped;
}

}  // namespace sherd
