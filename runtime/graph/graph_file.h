// A graph as it is written: names not looked up, variables not expanded, every part with its place.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graph/json.h"

namespace sherd {

/// A key and its value: a variable, or a parameter of a node.
struct Setting {
  std::string name;  ///< of a variable in a subgraph: with its scope, as "break/gamma"
  Origin origin;     ///< of the key
  JsonValue value;
  std::string scope = {};  ///< whose variables the value may name: "" are the graph's, "break/" those of the
                           ///< subgraph that the node "break" stands for
};

/// "port": "node" or "node.output".
struct LinkEntry {
  std::string port;
  Origin origin;       ///< of the link's text
  std::string node;    ///< empty where the text is no link, which then has been reported
  std::string output;  ///< empty: the node's first
};

struct NodeEntry {
  std::string name;  ///< in a subgraph: with the nodes that stand for it, as "break/cells"
  Origin origin;
  std::string type;
  static constexpr int kNoVersion = -1;
  int version = 0;  ///< N of Type@N; 0: none is written; kNoVersion: it can't be read, which was reported
  Origin typeOrigin;
  std::vector<LinkEntry> in;
  std::vector<Setting> params;
  /// "in" or "params" can't be read, which was reported: what they would give is not also missing.
  bool inIsUnread = false, paramsAreUnread = false;
};

struct TargetEntry {
  std::string name;
  Origin origin;
  std::vector<std::pair<std::string, Origin>> nodes;
};

/// A node that stood for a subgraph before the subgraph took its place.
struct GroupEntry {
  std::string name;  ///< "break"
  Origin origin;
  std::vector<std::pair<std::string, std::string>>
      outputs;  ///< name, and "node.output" or "node" within the graph
};

struct GraphFile {
  SourcePtr source;
  double fps = 24;
  std::optional<Setting> frames, wedge;  ///< known keys whose evaluation is not there yet
  std::vector<Setting> vars;
  std::vector<TargetEntry> targets;
  std::vector<NodeEntry> nodes;
  std::vector<GroupEntry> groups;  ///< outer ones first
};

/// Reads what there is to read and reports all that is wrong in form: syntax, unknown keys, wrong kinds.
GraphFile readGraph(std::string_view text, const SourcePtr& source, Diagnostics& diagnostics);
/// The same from a file, which is shown in messages as `path` is given.
GraphFile readGraphFile(const std::string& path, Diagnostics& diagnostics);

}  // namespace sherd
