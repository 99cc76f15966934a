// What `sherd nodes` says of a node type in words: shared by its text, its Markdown and its schema, which all
// derive from the type's table.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/node_type.h"
#include "graph/registry.h"

namespace sherd {

/// "Simulate@1".
std::string versioned(const NodeType& type);

/// The default with its unit, "1 m", or "required".
std::string defaultText(const ParamInfo& info);
/// What values it takes: its range with the unit, or its words; empty where all of its kind will do.
std::string limitsText(const ParamInfo& info);
/// Help and limits: "height of the picture; at least 64 and at most 16384 pixels".
std::string helpText(const ParamInfo& info);
/// The help, with "(optional)" or what it gathers before it.
std::string helpText(const PortInfo& input);

/// Where cancelling waits, one entry a call: "OpenVDB's meshToVolume, 420 ms at most as measured".
std::vector<std::string> waitTexts(const NodeType& type);
/// What graphs of older versions need, one entry a version: "1 → 2" and "parameter "tets" is now "count"; …".
std::vector<std::pair<std::string, std::string>> migrationTexts(const NodeType& type);

/// A node of the type with what it can't do without: links to the inputs that must be wired, and the
/// parameters that have no default. Pasted together, the snippets of all types are wired to one another: each
/// is named after its type, and links to the first type of `registry` that makes what it needs.
struct NodeSnippet {
  std::string key;                                          ///< "export_crack_surface"
  std::string type;                                         ///< "ExportCrackSurface@1"
  std::vector<std::pair<std::string, std::string>> in;      ///< port, link
  std::vector<std::pair<std::string, std::string>> params;  ///< name, text; only texts can be required
};
NodeSnippet snippetOf(const NodeType& type, const Registry& registry);
/// As it stands in a graph file, without a comma behind it. One line, or a line each for type, in and params
/// where that is longer than `width` characters.
std::string snippetText(const NodeSnippet& snippet, std::size_t width);

}  // namespace sherd
