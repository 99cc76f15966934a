// What `fmt` and `upgrade` have in common: a file's text, and writing it back.
#pragma once

#include <string>

#include "cli/console.h"
#include "graph/diagnostics.h"

namespace sherd {

struct TextFile {
  SourcePtr source;
  std::string path;  ///< absolute, links followed
  std::string text;
};

/// The file's text; without one, that is reported.
bool readTextFile(const std::string& path, TextFile& file, Diagnostics& diagnostics);

/// Shows what would change, and with `write` makes the change. The error of writing is reported.
void changeTextFile(const TextFile& file, const std::string& text, bool write, Console& console,
                    Diagnostics& diagnostics);

}  // namespace sherd
