// A graph as it is written: names not looked up, variables not expanded, every part with its place.
#pragma once

#include <memory>
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
  Origin named = {};   ///< in an expanded file: of the text that names node and output, from which the link
                       ///< may come through ends of subgraphs
};

struct NodeEntry {
  std::string name;  ///< in a subgraph: with the nodes that stand for it, as "break/cells"
  Origin origin;
  std::string scope = {};  ///< whose variables "params" may name, as in Setting
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

/// A port that a subgraph declares.
struct DeclaredPort {
  std::string name;
  Origin origin;     ///< of the name
  std::string type;  ///< ValueType::name; of an output it may be left out
  Origin typeOrigin;
  std::string help;
  bool optional = false;  ///< of an input: may be left unconnected
  LinkEntry from;         ///< of an output: the node inside that it comes from
};

struct Subgraph;

/// A subgraph's name, and what it stands for.
struct SubgraphEntry {
  std::string name;
  Origin origin;
  std::shared_ptr<const Subgraph> definition;  ///< null: it is in another file, or can't be read
  std::string file;                            ///< the other file, as it is written; empty: none
  Origin fileOrigin;
};

/// A piece of a graph with declared ends, to be used as if it were a node type.
struct Subgraph {
  std::string help;
  std::vector<Setting> vars;  ///< what "params" of a node may set, with defaults
  std::vector<DeclaredPort> inputs, outputs;
  std::vector<NodeEntry> nodes;          ///< whose links may be to "in.NAME"
  std::vector<SubgraphEntry> subgraphs;  ///< that only it can use
};

/// A node that stood for a subgraph before the subgraph took its place.
struct GroupEntry {
  std::string name;  ///< "break"
  Origin origin;
  std::vector<std::pair<std::string, std::string>>
      outputs;                           ///< name, and "node.output" or "node" within the graph
  std::string subgraph = {};             ///< "Shatter"
  std::size_t firstNode = 0, nodes = 0;  ///< which of GraphFile::nodes are in it: so many from the first on
};

/// An output that a subgraph's declaration says must be of some type.
struct ExpectedType {
  Origin origin;  ///< of the link
  std::string where;
  std::string type;   ///< what is wanted
  Origin typeOrigin;  ///< where that is said
  Origin named;       ///< as in LinkEntry
  std::string node,
      output;  ///< what is wired, as in LinkEntry; node "": nothing, only the type's name counts
};

struct GraphFile {
  SourcePtr source;
  double fps = 24;
  std::optional<Setting> frames, wedge;  ///< a text or an integer; an object
  std::vector<Setting> vars;
  std::vector<TargetEntry> targets;
  std::vector<NodeEntry> nodes;
  std::vector<SubgraphEntry> subgraphs;
  /// The file holds a subgraph to be used by graphs; what it holds is here, and not in the rest.
  std::shared_ptr<const Subgraph> subgraph;

  std::vector<std::string> notes;  ///< for the user, on what is read otherwise than it is written

  // What expandSubgraphs() adds:
  std::vector<GroupEntry> groups;  ///< outer ones first
  std::vector<ExpectedType> expectedTypes;
  std::vector<GraphFile>
      unused;  ///< subgraphs that no node uses, each as a graph whose inputs count as wired
};

/// The whole text of a file; an Error where there is none, or one that is no graph file for its size.
Result<std::string> readGraphText(const std::filesystem::path& path);

/// Reads what there is to read and reports all that is wrong in form: syntax, unknown keys, wrong kinds.
GraphFile readGraph(std::string_view text, const SourcePtr& source, Diagnostics& diagnostics);
/// The same from a file, which is shown in messages as `path` is given.
GraphFile readGraphFile(const std::string& path, Diagnostics& diagnostics);

}  // namespace sherd
