// What is wrong with a command line, in the words of this program rather than of the library that parses it.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace sherd {

/// The names of the program's verbs.
const std::vector<std::string>& verbNames();

/// Whether the arguments name a verb first, or ask for help or the version.
Result<void> checkVerbName(const std::vector<std::string>& arguments);

/// A verb is without the graph it needs.
Error missingGraph(const std::string& verb);
/// An argument that `verb` doesn't take; `options` are those that it does, with their dashes.
Error unexpectedArgument(const std::string& verb, const std::string& argument,
                         const std::vector<std::string>& options);

/// Whether the events of `run --json` are asked for, as far as arguments that can't be parsed tell.
bool asksForEvents(const std::vector<std::string>& arguments);

}  // namespace sherd
