// Migrations in the text of a graph file.
#pragma once

#include "graph/document.h"
#include "graph/graph_file.h"
#include "graph/registry.h"

namespace sherd {

/// The changes that make all nodes of the file, and of the subgraphs defined in it, nodes of the current
/// versions; nothing else is touched. `file` is what readGraph() made of the same text. Nodes that can't be
/// changed without somebody's decision are left as they are and reported.
std::vector<TextEdit> upgradeEdits(const Document& document, const GraphFile& file, const Registry& registry,
                                   Diagnostics& diagnostics);

}  // namespace sherd
