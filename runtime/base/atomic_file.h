// Writing files so that nobody ever sees half of one.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace sherd {

enum class FileChange {
  Written,  ///< the file is new or held something else
  Kept,     ///< it held the same bytes already, and was not touched
};

/// Is `path` a regular file (no link) of exactly these bytes?
bool fileHolds(const std::string& path, std::string_view content);

/// Makes the file `path` hold `content`: written beside it under a name of its own (partial_file.h), then
/// renamed, so that of several processes that do so at once one has its way. A file that was there passes on
/// its permissions. On failure it is as it was and nothing else is left; a process that is killed leaves at
/// most the half-written one, which removeAbandoned() removes. The error names the file and what the system
/// said (no space, no permission, a directory in the way).
Result<FileChange> writeFileAtomically(const std::string& path, std::string_view content);

/// Creates `directory` and those above it where they are missing. The error says what is in the way.
Result<void> makeDirectory(const std::string& directory);

}  // namespace sherd
