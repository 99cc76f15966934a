// Graphs with subgraphs, of made-up nodes, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "graph/subgraphs.h"
#include "runtime/made_up.h"

namespace sherd::test {

using Lines = std::vector<std::string>;

/// "Raise": adds `by` (1) to the input "x", and the input "extra" if that is wired.
inline const std::string kRaise = R"("Raise": {
  "help": "Adds.", "vars": {"by": 1},
  "inputs": {"x": "Number", "extra": {"type": "Number", "optional": true, "help": "more"}},
  "outputs": {"y": "add.sum", "same": {"from": "add", "type": "Number", "help": "the same"}},
  "nodes": {"add": {"type": "Add@1", "in": {"a": "in.x", "b": "in.extra"}, "params": {"offset": "${by}"}}}})";

inline std::string graphWith(const std::string& subgraphs, const std::string& content,
                             const std::string& more = "") {
  return "{\"format\": 1, " + more + "\"subgraphs\": {" + subgraphs + "},\n\"nodes\": {" + content + "}}";
}

/// Outlives the graphs, which point to its types.
inline const Registry& nodes() {
  static const Registry registry = madeUpNodes();
  return registry;
}

/// The graph of a file without errors.
inline Graph good(const std::string& text, const fs::path& directory = "/graphs", const Lines& sets = {},
                  const Lines& vars = {}) {
  Checked checked = check(text, nodes(), sets, vars, directory);
  for (const std::string& error : checked.errors) ADD_FAILURE() << error;
  return std::move(checked.graph);
}

inline Lines errorsOf(const std::string& text, const fs::path& directory = "/graphs",
                      const Lines& sets = {}) {
  return check(text, nodes(), sets, {}, directory).errors;
}

/// Errors of one definition "S" and one use of it, "s", in which "c" is a Constant.
inline Lines errorsIn(const std::string& definition, const std::string& use = R"({"type": "S"})") {
  return errorsOf("{\"format\": 1, \"subgraphs\": {\n\"S\": " + definition +
                  "},\n\"nodes\": {\"c\": {\"type\": \"Constant@1\"},\n\"s\": " + use + "}}");
}

inline double valueOf(const Graph& graph, const std::string& node, const std::string& port = "sum") {
  Cache cache;
  CancelToken token;
  const auto wanted = wantedNodes(graph, "", node);
  if (!wanted.ok()) ADD_FAILURE() << wanted.error().text();
  return numberAt(graph, evaluate(graph, *wanted, cache, token), node, port);
}

inline Lines namesIn(const Graph& graph) {
  Lines names;
  for (const Graph::Node& node : graph.nodes) names.push_back(node.name);
  return names;
}

}  // namespace sherd::test
