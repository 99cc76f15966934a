// A subgraph at one of the places where it is used. Internal to subgraphs.cpp and subgraph_links.cpp.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "graph/subgraph_library.h"

namespace sherd {

/// What a link leads to once subgraphs are looked through.
struct Resolved {
  enum class State {
    Unknown,
    Following,  ///< being looked for: reaching it again is a loop
    Found,      ///< output `output` of the node `node` of the whole graph
    Absent,     ///< an optional input that nothing is wired to
    Broken,     ///< reported, or open because nothing uses the subgraph
  };
  State state = State::Unknown;
  std::string node, output;
  Origin named = {};  ///< of the text that names them
};

/// The file's own nodes, or those of a subgraph at one node that stands for it.
struct Instance {
  std::string subgraph;                  ///< its name; empty: the file's own nodes
  const Subgraph* definition = nullptr;  ///< null: the file's own nodes, or a subgraph that can't be read
  const SubgraphScope* scope = nullptr;
  Instance* outer = nullptr;        ///< null: the file's own nodes, or a subgraph that no node uses
  const NodeEntry* node = nullptr;  ///< of `outer`: what it takes the place of
  std::string prefix;               ///< "break/"; empty for the file's own nodes
  bool broken = false;              ///< it can't be read or expanded, which was reported

  std::unordered_set<std::string> names;  ///< of its nodes
  std::unordered_map<std::string, std::unique_ptr<Instance>> children;
  std::map<std::string, Resolved> inputs, outputs;  ///< as far as they have been followed

  /// "break/cut.port"
  std::string place(const NodeEntry& inner, const std::string& port) const {
    return prefix + inner.name + '.' + port;
  }
};

/// Where a link of one of the instance's nodes leads, through any number of subgraphs; `where` names its
/// place for messages. O(subgraphs passed), and O(1) where this way was followed before.
Resolved followLink(Instance& instance, const LinkEntry& link, const std::string& where,
                    Diagnostics& diagnostics);

/// The port of that name, or null.
const DeclaredPort* findPort(const std::vector<DeclaredPort>& ports, const std::string& name);
std::vector<std::string> namesOf(const std::vector<DeclaredPort>& ports);

}  // namespace sherd
