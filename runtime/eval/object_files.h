// Values as files: objects/ab/abcd…, named by the value's digest. A head that describes the value, the name
// of its type, its bytes. Thread-safe; any number of processes may read, write and evict at once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/hash.h"
#include "base/value_type.h"
#include "eval/store_directory.h"

namespace sherd::store {

/// What is known of an object's file without opening it.
struct ObjectFile {
  std::string path;
  std::uint64_t bytes = 0;
  double unused = 0;  ///< seconds since its last use
};

/// The bytes of a value, checked.
struct ObjectBytes {
  std::unique_ptr<char[]> all;
  std::string_view payload;
};

class ObjectFiles {
 public:
  explicit ObjectFiles(Directory& directory) : directory_(directory) {}

  bool has(const Digest& digest) const;
  /// The payload; none where it isn't there, and where it is unsound or of another type or version: it is
  /// deleted then. Marks it as used.
  std::optional<ObjectBytes> read(const ValueType& type, const Digest& digest);
  /// Returns the bytes of the file, 0 where it could not be written.
  std::uint64_t write(const ValueType& type, const Digest& digest, double ms, std::string_view payload);
  void remove(const Digest& digest);
  /// Marks it as used, at most once a minute.
  void touch(const Digest& digest);

  /// Everything in the folder, in no order. O(files).
  std::vector<ObjectFile> list() const;
  /// Deletes those of the least worth() until no more than mostBytes are left. Returns the bytes freed.
  std::uint64_t evict(std::uint64_t mostBytes);
  /// Reads all, deletes what is unsound, and returns a line for each.
  std::vector<std::string> verify();
  void clear();

 private:
  std::string pathOf(const Digest& digest) const;

  Directory& directory_;
};

}  // namespace sherd::store
