// Tells what a piece of code reads of the machine: files that it opens,
// variables of the environment. Linked into an executable, read_watch.cpp
// stands in for open(), fopen(), getenv() and their kin in all of its
// libraries, those that are loaded later among them. The executable must export
// its symbols (CMake: ENABLE_EXPORTS).
#pragma once

#include <string>
#include <vector>

namespace sherd::test {

struct WatchedReads {
  std::vector<std::string> files;      ///< absolute paths, sorted, each once; opened
                                       ///< for writing ones, too
  std::vector<std::string> variables;  ///< names, sorted, each once, whether they were set or not
};

/// Watches all threads of the process from construction to stop(). One at a
/// time.
class ReadWatch {
 public:
  ReadWatch();
  ~ReadWatch();
  ReadWatch(const ReadWatch&) = delete;
  ReadWatch& operator=(const ReadWatch&) = delete;

  WatchedReads stop();
};

}  // namespace sherd::test
