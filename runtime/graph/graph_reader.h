// JSON values to the entries of a graph file or subgraph: the form only, nothing is looked up.
#pragma once

#include <string>
#include <vector>

#include "graph/graph_file.h"

namespace sherd {

/// Fills entries from JSON and reports what has the wrong form. What can't be read is left out, or kept
/// without content where leaving it out would be an error of its own.
class GraphReader {
 public:
  explicit GraphReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  /// The content of a file: a graph, or a subgraph if it declares inputs or outputs.
  void readFile(const JsonValue& root, GraphFile& file);

 private:
  using Names = std::vector<std::string>;

  bool expect(const JsonValue& value, JsonValue::Kind kind, const std::string& where);
  void findUnknownKeys(const JsonValue& object, const Names& keys, const std::string& where,
                       const std::string& kind);
  void readFormat(const JsonValue& root);
  void readFps(const JsonValue& fps, GraphFile& file);
  void keep(const JsonValue& root, const char* key, JsonValue::Kind kind, std::optional<Setting>& setting);
  void keepFrames(const JsonValue& root, std::optional<Setting>& setting);
  void readVars(const JsonValue& vars, const std::string& inside, std::vector<Setting>& list);
  void readTargets(const JsonValue& targets, GraphFile& file);
  void readNodes(const JsonValue& nodes, const std::string& inside, std::vector<NodeEntry>& list);
  void readNode(const JsonValue& value, const std::string& where, NodeEntry& node);
  void readType(const JsonValue& value, const std::string& where, NodeEntry& node);
  void readLinks(const JsonValue& value, const std::string& where, NodeEntry& node);
  void readLink(const JsonValue& value, const std::string& where, LinkEntry& link);
  void readParams(const JsonValue& value, const std::string& where, NodeEntry& node);

  // subgraph_reader.cpp; `inside` is the path of the subgraphs around it, as "Shatter/", and "" in a file
  void readSubgraphs(const JsonValue& value, const std::string& inside, std::vector<SubgraphEntry>& list);
  void readSubgraphFileName(const JsonValue& value, const std::string& where, SubgraphEntry& entry);
  Subgraph readSubgraph(const JsonValue& value, const std::string& inside);
  void readInputs(const JsonValue& value, const std::string& inside, Subgraph& subgraph);
  void readOutputs(const JsonValue& value, const std::string& inside, Subgraph& subgraph);
  void readPortType(const JsonValue& value, const std::string& where, DeclaredPort& port);
  void readHelp(const JsonValue& value, const std::string& where, std::string& help);

  Diagnostics& diagnostics_;
};

}  // namespace sherd
