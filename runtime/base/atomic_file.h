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

/// A file that is being written: known to removePartialFiles() from construction to destruction.
class PartialFile {
 public:
  explicit PartialFile(std::string path);
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

 private:
  std::string path_;
  int slot_ = -1;  ///< −1: too many at once, this one is not known
};

/// Removes all files that are being written at this moment, and makes threads that would write another one by
/// writeFileAtomically() wait for ever. For a signal handler that then ends the process: takes no lock,
/// allocates nothing, takes at most 20 ms.
void removePartialFiles() noexcept;

/// What a file is called while it is being written. A run that is killed leaves at most this behind; the next
/// write of the same file replaces it.
std::string partialName(const std::string& path);

/// Makes the file `path` hold `content`: written under partialName(path), then renamed. On failure the old
/// file is as it was and nothing else is left. The error names the file and what the system said (no space,
/// no permission, a directory in the way).
Result<FileChange> writeFileAtomically(const std::string& path, std::string_view content);

/// Creates `directory` and those above it where they are missing. The error says what is in the way.
Result<void> makeDirectory(const std::string& directory);

}  // namespace sherd
