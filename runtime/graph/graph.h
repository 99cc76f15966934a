// A graph that has been checked: names are looked up, variables expanded, parameters read. What eval works
// on.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "graph/graph_file.h"
#include "graph/node_type.h"
#include "graph/registry.h"
#include "graph/variables.h"

namespace sherd {

struct Graph {
  /// A wire into a node: output `output` of nodes[node].
  struct Wire {
    std::string to;  ///< the input port or parameter
    int node = 0;
    std::string output;
  };
  struct Node {
    std::string name;
    const NodeType* type = nullptr;
    Origin origin;
    ParamValues params;                     ///< all of them; a wired one holds its default until it runs
    std::vector<Wire> inputs;               ///< in the order of the type's ports
    std::vector<Wire> wiredParams;          ///< in the order of the type's parameters
    std::map<std::string, Origin> origins;  ///< of the links and of the parameters that are set
  };
  struct Target {
    std::string name;
    std::vector<int> nodes;
  };

  SourcePtr source;
  std::vector<Node> nodes;  ///< in the file's order
  std::vector<Target> targets;
  std::map<std::string, std::vector<int>> groups;  ///< a node that stood for a subgraph: whose outputs it had
  double fps = 24;

  /// The node's index, or −1.
  int find(const std::string& name) const;
  /// Where a message about `port` of a node belongs: the port's place, else the node's.
  Origin originOf(int node, const std::string& port) const;
  /// "node" or "node.port".
  std::string nameOf(int node, const std::string& port) const;

  std::map<std::string, int> index;
};

struct Overrides {
  std::vector<Assignment> vars;  ///< --var name=value
  std::vector<Assignment> sets;  ///< --set node.param=value
};

/// Looks up types, ports and nodes, expands variables, reads parameters and searches for loops. All errors
/// are reported; the graph is complete only where there are none. O(nodes + wires), but for suggestions.
Graph checkGraph(const GraphFile& file, const Registry& registry, const Overrides& overrides,
                 const Environment& environment, Diagnostics& diagnostics);

/// What a run asks for: a target, a node, or by default all targets; in a graph without any, all nodes that
/// write files, and in one without these all nodes that nothing is wired to.
Result<std::vector<int>> wantedNodes(const Graph& graph, const std::string& target, const std::string& to);
/// The wanted nodes and all that these need, ascending.
std::vector<int> neededNodes(const Graph& graph, const std::vector<int>& wanted);

/// Input files that are missing or can't be read, outputs that can't be written, two nodes that write the
/// same output: of `nodes` only, and without writing anything.
void checkFiles(const Graph& graph, const std::vector<int>& nodes, Diagnostics& diagnostics);

}  // namespace sherd
