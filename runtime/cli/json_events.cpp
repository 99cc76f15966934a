#include "cli/json_events.h"

#include <nlohmann/json.hpp>

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

/// File names need not be UTF-8: what isn't is replaced rather than thrown at. The line is written as one
/// piece: a signal's handler may write the next one at any moment.
void print(const Json& event, std::ostream& out) {
  out << event.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n' << std::flush;
}

}  // namespace

void JsonEvents::finished(const NodeReport& report) {
  const Graph::Node& node = graph_.nodes[static_cast<std::size_t>(report.node)];
  std::string message;
  auto addLine = [&](const char* prefix, const std::string& text) {
    if (!message.empty()) message += '\n';
    message += prefix;
    message += text;
  };
  for (const Message& line : report.messages)
    addLine(line.level == LogLevel::Warning ? "warning: " : "", line.text);
  if (report.error) addLine("", report.error->text());
  Json event{{"event", "node"}};
  if (graph_.shots.size() > 1) event["graph"] = graph_.shots[static_cast<std::size_t>(node.shot)];
  event["name"] = node.name;
  if (node.context != 0) event["context"] = graph_.contexts[static_cast<std::size_t>(node.context)].label;
  event["type"] = node.type->name;
  event["state"] = stateName(report.state);
  event["ms"] = report.ms;
  event["threads"] = report.threads;
  event["message"] = message;
  print(event, console_.out);
}

void jsonErrors(const Diagnostics& diagnostics, std::ostream& out) {
  for (const Diagnostic& diagnostic : diagnostics.sorted())
    print(Json{{"event", "error"}, {"message", diagnostic.text()}}, out);
}

void jsonDone(bool ok, double ms, const std::vector<std::string>& outputs, std::ostream& out) {
  print(Json{{"event", "done"}, {"ok", ok}, {"ms", ms}, {"outputs", outputs}}, out);
}

}  // namespace sherd
