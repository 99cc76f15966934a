// What a graph is run for: its frames and its wedge, as the file and the command line have them.
#pragma once

#include "graph/graph.h"
#include "graph/variables.h"

namespace sherd {

/// The file's "frames" (or those of the command line in their place) and its "wedge": {"variable":
/// [values…]}. A variable that --var sets keeps that one value. What is wrong is reported and left out.
Sweep readSweep(const GraphFile& file, const Overrides& overrides, Diagnostics& diagnostics);

}  // namespace sherd
