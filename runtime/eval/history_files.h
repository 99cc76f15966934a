// Texts by name, each a file of its own: history/<digest of the name>. Thread-safe.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "eval/store_directory.h"

namespace sherd::store {

class HistoryFiles {
 public:
  explicit HistoryFiles(Directory& directory) : directory_(directory) {}

  /// Empty where there is none; an unsound one is deleted.
  std::string read(const std::string& name);
  void write(const std::string& name, std::string_view content);
  std::uint64_t bytesOnDisk() const;
  /// Deletes the oldest beyond mostBytes. Returns the bytes freed.
  std::uint64_t evict(std::uint64_t mostBytes);
  /// Reads all, deletes what is unsound, and returns a line for each.
  std::vector<std::string> verify();
  void clear();

 private:
  Directory& directory_;
};

}  // namespace sherd::store
