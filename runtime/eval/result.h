// What is known of a node's result without having it: the part that is kept of every node that ever ran, in
// memory and on disk, and from which keys, plans and hits are made.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/hash.h"
#include "graph/value.h"

namespace sherd {

struct Message {
  LogLevel level = LogLevel::Info;
  std::string text;
  friend bool operator==(const Message&, const Message&) = default;
};

/// Tells whether a file is still the one that it was, without reading it. The change time can't be set back
/// by a program, so that content that was altered behind our back is seen.
struct FileIdentity {
  std::uint64_t device = 0, inode = 0, bytes = 0;
  std::int64_t modified = 0, changed = 0;  ///< ns since 1970
  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;

  bool exists() const { return inode != 0; }
  /// All zero where there is no file, or it can't be looked at.
  static FileIdentity of(const std::string& path);
};

struct WrittenFile {
  std::string path;  ///< absolute
  FileIdentity identity;
  friend bool operator==(const WrittenFile&, const WrittenFile&) = default;
};

/// One output of a result. Digest and size are zero where the node left it empty.
struct OutputRecord {
  Digest digest;
  std::uint64_t bytes = 0;
  bool empty() const { return digest == Digest{}; }
  friend bool operator==(const OutputRecord&, const OutputRecord&) = default;
};

struct ResultRecord {
  Digest key;     ///< of all that the result depends on
  Digest recipe;  ///< the part of the key that is not inputs: type, versions, parameters, content of files
  double ms = 0;  ///< that it took to make
  std::vector<OutputRecord> outputs;  ///< in the order of the type's outputs
  std::vector<Message> messages;      ///< what the node said; a hit says it again
  std::vector<WrittenFile> written;   ///< by an exporter
  friend bool operator==(const ResultRecord&, const ResultRecord&) = default;
};

}  // namespace sherd
