// What is wrong with a graph, and where. Reading and checking go on after an error, so that all of them can
// be shown at once, each as "file:line:column: node.port: what is wrong; what would be right".
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"

namespace sherd {

/// A file, a command-line option or the environment: where texts come from.
struct Source {
  std::string name;  ///< as shown: the file as the user named it, or the option as it was typed
  std::filesystem::path directory;  ///< absolute; relative paths in this source start here
  bool typed = false;               ///< by the user, on the command line
};
using SourcePtr = std::shared_ptr<const Source>;

/// A place in a source. Line and column count from 1, columns in characters; line 0 means all of the source,
/// as for an option of the command line.
struct Origin {
  SourcePtr source;
  int line = 0, column = 0;

  /// "file:line:column", or the option as it was typed.
  std::string text() const;
};

struct Diagnostic {
  Origin origin;
  std::string where;  ///< "node.port", "node" or a key of the file; may be empty
  Error error;

  std::string text() const;
};

/// Collects errors. Only the first kMostKept are kept; the rest is counted. The same text about the same
/// place of a file counts once, also where it was found through several uses of a subgraph ("a/cut" and
/// "b/cut").
class Diagnostics {
 public:
  static constexpr std::size_t kMostKept = 1000;

  void add(Origin origin, std::string where, std::string what, std::string remedy = {});
  void add(Origin origin, std::string where, Error error);
  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  /// In the order of the sources, as they were first spoken of; those of the command line come first.
  std::vector<Diagnostic> sorted() const;

 private:
  std::vector<Diagnostic> kept_;
  std::set<std::string> seen_;
  std::size_t count_ = 0;
};

}  // namespace sherd
