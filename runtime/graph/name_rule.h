// What may be a name in a graph: of a node, target, variable, subgraph or port.
#pragma once

#include <string_view>

namespace sherd {

/// Whether the text (UTF-8) is a name: not empty, no blank at either end, and without control characters and
/// the characters that mean something in links, types, variables or on the command line: . / @ $ { } : = " '
bool isName(std::string_view text);

/// The same in words, as the remedy of a message.
extern const char* const kNameRule;

}  // namespace sherd
