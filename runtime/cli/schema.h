// A JSON Schema of graph files, for editors and validators.
#pragma once

#include <string>

#include "graph/registry.h"

namespace sherd {

/// JSON Schema draft-07 (the newest that editors support in full) of graph files whose nodes are of the
/// registry's types: keys of the graph and of its nodes, and for each "Type@N" its inputs and parameters with
/// kind, range, words, default and help; unknown keys are refused. A type without "@" is a subgraph of the
/// file, of which nothing more is checked. An older version that the type can be migrated from is accepted as
/// it is.
///
/// What a schema can't know stays with `sherd check`: whether linked nodes, ports and variables are there,
/// the types of what is wired, the values behind "${x}", loops, files.
///
/// For editors of the VS Code family it also has the keywords `enumDescriptions`, `patternErrorMessage`,
/// `defaultSnippets`, `allowComments` and `allowTrailingCommas`, which validators pass over.
std::string graphSchema(const Registry& registry);

}  // namespace sherd
