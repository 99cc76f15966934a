// Where a verb prints to, and how it hears of Ctrl-C. Tests hand in string streams.
#pragma once

#include <ostream>
#include <string>

#include "base/exec.h"
#include "graph/diagnostics.h"

namespace sherd {

struct Console {
  std::ostream& out;      ///< results
  std::ostream& err;      ///< errors
  CancelToken& cancel;    ///< set by Ctrl-C
  bool terminal = false;  ///< `out` is a terminal: one line may be written over again
  int width = 80;         ///< of the terminal, in characters
};

/// What the program ends with.
enum ExitCode { kOk = 0, kNodeFailed = 1, kWrongInput = 2, kCancelled = 130 };

/// Prints all of them, one a line, and how many there were beyond those that are kept.
void printDiagnostics(const Diagnostics& diagnostics, std::ostream& err);

/// "12 ms", "3.4 s", "2 min 5 s".
std::string durationText(double ms);
/// The path relative to the current directory if that is shorter.
std::string shownPath(const std::string& path);
/// "1 node", "2 nodes".
std::string countText(std::size_t count, const std::string& noun);

}  // namespace sherd
