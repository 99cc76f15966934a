// Loops of wires, which no order of evaluation can serve.
#pragma once

#include "graph/graph.h"

namespace sherd {

/// Reports loops as "a → b → a" at the link that closes each: one per closing link of a depth-first search,
/// so that a graph has none exactly where none is reported. O(nodes + wires), without recursion.
void reportLoops(const Graph& graph, Diagnostics& diagnostics);

}  // namespace sherd
