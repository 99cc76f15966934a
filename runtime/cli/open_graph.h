// What `run`, `plan` and `check` begin with.
#pragma once

#include <string>

#include "cli/shots.h"
#include "graph/graph.h"

namespace sherd {

/// Reads the graph file and checks it with what the command line overrides. The graph is usable only where
/// `diagnostics` stays empty.
Graph openGraph(const std::string& path, const ShotOptions& options, const Registry& registry,
                const Environment& environment, Diagnostics& diagnostics, GraphFile& file);

}  // namespace sherd
