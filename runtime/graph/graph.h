// A graph that has been checked: names are looked up, variables expanded, parameters read. What eval works
// on.
//
// Frames and wedges. A graph may be run for a range of frames and for all combinations of values of its
// wedge's variables. A node is there once for each frame and each value that it, or anything that it is wired
// to, depends on: what doesn't read the frame is there once for the whole range, and so are all nodes of a
// graph without either. An input that gathers takes all of its source's, and depends on none of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/hash.h"
#include "graph/graph_file.h"
#include "graph/node_type.h"
#include "graph/registry.h"
#include "graph/variables.h"

namespace sherd {

/// Whole numbers as they are written: "1001-1100x2", "7", "1-3,8". A frame may be negative: "-5--1".
struct FrameList {
  std::vector<std::int64_t> frames;  ///< ascending, each once, at least one
};
/// At most 1,000,000 frames.
Result<FrameList> parseFrames(const std::string& text);
/// The opposite, as short as can be.
std::string framesText(const std::vector<std::int64_t>& frames);

struct Graph {
  /// A wire into a node: output `output` of nodes[node], by its place in that node's type, to the input or
  /// parameter `to`, by its place in this node's type.
  struct Wire {
    int to = 0, node = 0, output = 0;
  };
  /// The frame and the wedge's values that a node stands for, as far as it depends on them.
  struct Context {
    std::optional<std::int64_t> frame;
    std::vector<std::pair<std::string, std::string>> values;  ///< variable, value as text
    std::string label;                                        ///< "frame 1001, seed 7"; empty for neither
  };
  struct Node {
    std::string name;
    const NodeType* type = nullptr;
    Origin origin;
    ParamValues params;                     ///< all of them; a wired one holds its default until it runs
    std::vector<Wire> inputs;               ///< in the order of the type's ports; several to one that gathers
    std::vector<Wire> wiredParams;          ///< in the order of the type's parameters
    std::map<std::string, Origin> origins;  ///< of the links and of the parameters that are set
    std::vector<std::string> typedPaths;    ///< parameters whose path begins with what the command line said
    int context = 0;                        ///< in Graph::contexts
    SourcePtr home;                         ///< the graph file that is run, also for nodes of subgraphs
    int shot = 0;                           ///< in Graph::shots
    Digest recipe;            ///< of type, versions and all parameters but wired ones and files to read
    bool readsFiles = false;  ///< has files to read among its parameters
    bool wiredFiles = false;  ///< and the name of one of them comes over a wire
  };
  struct Target {
    std::string name;
    std::vector<int> nodes;
  };
  /// nodes[first] … nodes[first + count − 1], those of one name.
  struct Instances {
    int first = 0, count = 0;
  };

  SourcePtr source;
  std::vector<Node> nodes;  ///< in the file's order; those of one name by frame, then by the wedge's values
  std::vector<Context> contexts{1};  ///< the first is empty
  std::vector<std::string> shots{
      1};  ///< names of the graphs that were put together; one empty one where it is one
  std::vector<Target> targets;
  std::map<std::string, std::vector<int>> groups;  ///< a node that stood for a subgraph: whose outputs it had
  double fps = 24;

  /// The index of the node, of the first of its name, or −1.
  int find(const std::string& name) const;
  /// Where a message about `port` of a node belongs: the port's place, else the node's.
  Origin originOf(int node, const std::string& port) const;
  /// "node" or "node.port".
  std::string nameOf(int node, const std::string& port) const;
  /// "node", or "node (frame 1001)".
  std::string labelOf(int node) const;

  std::unordered_map<std::string, Instances> index;
};

struct Overrides {
  std::vector<Assignment> vars;  ///< --var name=value; one of the wedge's variables keeps this value
  std::vector<Assignment> sets;  ///< --set node.param=value
  std::optional<std::string> frames = {};  ///< --frames, in place of the graph's own
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

/// Input files that are missing or can't be read, outputs that can't be written, two nodes, frames or wedges
/// that write the same output, outputs outside of the graph's folder and the directories `allowed` that the
/// command line doesn't name: of `nodes` only, and without writing anything.
void checkFiles(const Graph& graph, const std::vector<int>& nodes, const std::vector<std::string>& allowed,
                Diagnostics& diagnostics);

/// Puts the nodes of another graph behind those of this one, so that both can be evaluated as one. They
/// belong to the shot of that name. Targets, groups and the index are not taken over.
void append(Graph& graph, const Graph& other, const std::string& shot);

}  // namespace sherd
