// Files while they are being written: each under a name of its own beside the file that it is to become,
// locked by the process that writes it (flock, which the kernel drops when that process dies). So any number
// of processes may write one file at once, and what a killed one left is told from what another is still
// writing.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>

#include "base/result.h"

namespace sherd {

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

/// While one of these is there, a file may appear. removePartialFiles() waits until there are none, and no
/// new ones come: else a file could appear behind its back.
class MakingFile {
 public:
  MakingFile();
  ~MakingFile();
  MakingFile(const MakingFile&) = delete;
  MakingFile& operator=(const MakingFile&) = delete;
};

/// Removes all files that are being written at this moment, and makes threads that would write another one by
/// writeFileAtomically() wait for ever. For a signal handler that then ends the process: takes no lock,
/// allocates nothing, takes at most 20 ms.
void removePartialFiles() noexcept;

/// 16 random hexadecimal digits.
std::string randomName();

/// What the file `path` may be called while it is being written: `path`.<randomName()>.partial
std::string partialName(const std::string& path);
/// The file that one of such a name is to become; empty where `path` is no such name.
std::string partialTarget(const std::string& path);

/// Removes what processes that have died left half-written in `directory`: files named by partialName() that
/// nobody has locked, where `isOurs` is true of the name (without directory) of what they were to become.
/// Where there are no locks, those of the last 24 hours stay. O(files in the directory). The error names what
/// can't be removed.
Result<void> removeAbandoned(const std::string& directory,
                             const std::function<bool(const std::string&)>& isOurs);
/// Of one file.
Result<void> removeAbandoned(const std::string& path);

/// Tells which files have one beside them that removeAbandoned() would remove. Looks into each directory
/// once.
class AbandonedFiles {
 public:
  bool isBeside(const std::string& path);

 private:
  std::map<std::string, std::set<std::string>> targets_;  ///< by directory
};

}  // namespace sherd
