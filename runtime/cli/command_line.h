// The command line: verbs and options to what they stand for.
#pragma once

#include <string>
#include <vector>

#include "cli/console.h"

namespace sherd {

/// Parses the command line, loads the node packs if the verb needs them, and runs it. Returns the exit code.
/// `arguments` are without the program's name.
int runCommandLine(const std::vector<std::string>& arguments, Console& console);

}  // namespace sherd
