// One node for every frame and every combination of the wedge's values that it depends on.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "graph/graph.h"
#include "graph/variables.h"

namespace sherd {

/// Reads again what of node `node`'s parameters depends on the sweep, for the place in it that it is given
/// (an entry of Variables::moveTo), into a copy of the node. What is wrong is reported.
using RereadParams = std::function<void(int node, const std::vector<int>& at, Graph::Node& copy)>;

/// `graph` holds each node once, for the first frame and values; `own` tells by a bit per dimension (as
/// Expanded::reads) what a node's own parameters depend on. Nodes depend on what their sources do, but for
/// inputs that gather. The graph must have no loops. Too many nodes (over 5 million) are an error. O(nodes +
/// wires of the result).
void multiply(Graph& graph, const Sweep& sweep, const std::vector<std::uint64_t>& own,
              const RereadParams& reread, Diagnostics& diagnostics);

/// The nodes in an order in which all sources come first. Those on a loop and behind one are left out.
std::vector<int> topologicalOrder(const Graph& graph);

/// Fills in Graph::Node::recipe and what it knows of files.
void writeRecipe(Graph::Node& node);

}  // namespace sherd
