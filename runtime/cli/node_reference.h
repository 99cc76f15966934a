// The node reference, nodes/README.md.
#pragma once

#include <string>

#include "graph/registry.h"

namespace sherd {

/// All node types of the registry as Markdown, by name: help, inputs, parameters with kind, default and
/// range, outputs, where cancelling waits, older versions, and a node to paste.
std::string nodeReference(const Registry& registry);

}  // namespace sherd
