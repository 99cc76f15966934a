// The directory that a store lives in: making or refusing it, files that appear whole or not at all, and the
// one warning when it can't be written to.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"

namespace sherd::store {

/// Closes on destruction. A lock (flock) on the file goes with the last descriptor of it.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    close();
    number_ = std::exchange(other.number_, -1);
    return *this;
  }
  int number() const { return number_; }
  bool isOpen() const { return number_ >= 0; }
  void close();

 private:
  int number_;
};

/// A file of this process's own, locked for as long as it is open. error is 0, or why there is none.
struct OwnFile {
  Descriptor descriptor;
  std::string path;
  int error = 0;
};

/// Writes all pieces, by one call of the system where it takes them. 0, or the error number.
int writeAll(int descriptor, std::initializer_list<std::string_view> pieces);
/// Reads `size` bytes from `offset` on, fewer where the file ends. The error number is left in errno, and the
/// result is shorter, where that fails.
std::string readFrom(int descriptor, std::uint64_t offset, std::size_t size);
/// Names in a folder in no order, without "." and ".."; none where it can't be read.
std::vector<std::string> namesIn(const std::string& folder);
Descriptor openToRead(const std::string& path);
/// Whether the lock of a file is free; it is then held through the descriptor. False also where the file has
/// lost its name meanwhile, and where the file system has no locks.
bool lockIfFree(const Descriptor& file);
/// 0 where there is none.
std::uint64_t fileBytes(const std::string& path);

class Directory {
 public:
  using Warn = std::function<void(const std::string&)>;
  Directory(std::string path, Warn warn) : path_(std::move(path)), warn_(std::move(warn)) {}

  /// Makes it where it is missing, and the folders in it. An Error where it is a file, is someone else's, or
  /// can neither be made nor read. Where it can't be written to, says so.
  Result<void> open();

  const std::string& path() const { return path_; }
  /// The path of "records/…", "objects/…", "history/…" or "tmp/…".
  std::string at(std::string_view relative) const;

  /// False from the first failure to write on.
  bool writable() const { return writable_; }
  void writeFailed(int error);
  /// One line for the user.
  void warn(const std::string& text) const;

  /// A new, empty file under a random name that begins with `prefix`.
  OwnFile create(std::string_view folder, std::string_view prefix) const;
  /// Makes the file `relative` hold the pieces: written in tmp/, then renamed. The folder of the file is made
  /// where it is missing, but not the one that holds that. False, after writeFailed, where that can't be
  /// done.
  bool replace(const std::string& relative, std::initializer_list<std::string_view> pieces);
  /// Renames an own file into place; false, after writeFailed, where that can't be done.
  bool moveInto(const OwnFile& file, const std::string& relative);
  /// Removes what killed processes left in tmp/. Returns the bytes freed.
  std::uint64_t sweep();

 private:
  Result<void> claim();

  const std::string path_;
  const Warn warn_;
  std::atomic<bool> writable_{true};
};

}  // namespace sherd::store
