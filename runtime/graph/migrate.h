// Nodes of an older interface version, or of a former name, made nodes of the current one.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/graph_file.h"
#include "graph/registry.h"

namespace sherd {

/// What becomes of one node: the same for a node in memory and for its text in a file.
struct MigratedNode {
  struct Param {
    std::string was;                  ///< its name before; empty: it is new
    std::string name;                 ///< empty: it is gone
    std::optional<std::string> json;  ///< its new value; nothing: as it was
  };
  struct Problem {
    std::string param;  ///< as the file names it
    Error error;
  };
  std::string type;  ///< "Type@N" of the current version
  std::vector<Param> params;
  std::vector<std::pair<std::string, std::string>> links;    ///< port before and after; after "": gone
  std::vector<std::pair<std::string, std::string>> outputs;  ///< renamed ones, before and after
  std::vector<std::string> remarks;                          ///< on what is gone, for the user
  std::vector<Problem> problems;                             ///< values that somebody has to write by hand
};

/// Nothing where the node is current, or where there is no way from its version to the current one.
/// O(steps × (params + links)).
std::optional<MigratedNode> migrateNode(const NodeEntry& node, const NodeType& type);

/// Migrates all nodes of a graph whose subgraphs have been expanded, and the links to outputs that were
/// renamed. `notes` gets a line for each node that was changed; what can't be told is reported. Nodes without
/// a way to the current version stay as they are: checkGraph tells of them.
void migrate(GraphFile& file, const Registry& registry, Diagnostics& diagnostics,
             std::vector<std::string>& notes);

}  // namespace sherd
