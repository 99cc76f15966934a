// Subgraphs: named pieces of a graph that nodes stand for.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "graph/graph.h"

namespace sherd {

/// Replaces each node that stands for a subgraph by the subgraph's nodes, which are named with the node's
/// name before theirs ("break/cut"), and rewires what was linked to it. The subgraph's variables become
/// variables of the file ("break/gamma") with the node's "params" for values. Reports what is wrong in the
/// subgraphs' use and inside them, in each place once. Also fills what GraphFile lists as added by this.
/// O(nodes + links after it).
void expandSubgraphs(GraphFile& file, Diagnostics& diagnostics);

/// The nodes of an expanded file that the outputs of a node that stood for a subgraph come from; where it has
/// no outputs, all that are in it.
std::vector<std::string> nodesOfGroup(const GraphFile& file, const GroupEntry& group);
/// The same for all of them, by name and as indices.
std::map<std::string, std::vector<int>> groupsOf(const GraphFile& file, const Graph& graph);

/// Of an expanded file: whether what is wired to the ends of subgraphs has the declared types. Returns the
/// places (LinkEntry::named, as text) of the links that are wrong and have been reported, so that the nodes
/// behind those ends need not complain as well.
std::set<std::string> checkSubgraphEnds(const GraphFile& file, const Registry& registry,
                                        Diagnostics& diagnostics);
/// Checks the subgraphs that no node uses.
void checkUnusedSubgraphs(const GraphFile& file, const Registry& registry, const Environment& environment,
                          Diagnostics& diagnostics);

/// The overrides of an expanded file, with "--set break.gamma=…" of a node that stood for a subgraph made an
/// override of the variable "break/gamma".
Overrides withSubgraphOverrides(const GraphFile& file, const Overrides& overrides, Diagnostics& diagnostics);

/// A message for a file that holds a subgraph: it can't be run by itself. Empty for others.
void refuseSubgraphFile(const GraphFile& file, Diagnostics& diagnostics);

}  // namespace sherd
