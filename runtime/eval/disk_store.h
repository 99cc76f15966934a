// The cache on disk: what is known of results, and values by content. Shared by any number of processes, and
// sound whenever one of them is killed.
//
//   DIR/sherd-cache        says what this directory is, and its format; a directory that holds other things
//                          and not this file is refused, so that `cache clear` can't empty a stranger's
//   DIR/records/*          append-only segments of records, one per writing process; merged now and then
//   DIR/objects/ab/abcd…   one value each, named by its digest, or part of a node's work (base/memo.h), named
//                          by its key: header (magic, format, type name and version, recompute time, payload
//                          length and checksum), payload
//   DIR/history/*          what the last run of each graph looked like, for `plan`
//   DIR/tmp/*              half-written things, renamed into place when they are whole
//
// Safety. Files appear by rename only; segments grow by single appends of whole records, each with length and
// checksum, and a torn tail is ignored. Segments in use are known by flock, which the kernel drops when a
// process dies. Whatever is truncated, corrupt or of another format is a miss, deleted where that is allowed,
// and never an error. A store that can't be written to (read-only, full, gone) says so once as a warning
// and serves reads as far as it can.
//
// Durability. A result that took at least kSlowMs is in the kernel's hands when record() returns, so that a
// kill of the process loses nothing. Quicker ones are gathered and appended together: when 64 KiB have come
// together, with the next slow one, by flush(), and at the end. After a loss of power what didn't reach the
// disk is found by its checksum, and is a miss.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "eval/result.h"
#include "graph/value.h"

namespace sherd {

struct DiskStoreOptions {
  static constexpr std::uint64_t kMostBytes = std::uint64_t{10} << 30;
  std::uint64_t mostBytes = kMostBytes;  ///< of all that is kept; passed only while a process is writing
  /// Told once when the store turns out not to be writable, and of each value that can't be saved or loaded
  /// because its type throws or the memory doesn't suffice; from any thread, and not to call the store.
  std::function<void(const std::string&)> onWarning;
};

struct DiskStoreStats {
  std::uint64_t objects = 0, objectBytes = 0;
  std::uint64_t records = 0, recordBytes = 0;
  std::uint64_t historyBytes = 0;
  std::uint64_t mostBytes = 0;

  std::uint64_t bytes() const { return objectBytes + recordBytes + historyBytes; }
};

class DiskStore {
 public:
  static constexpr double kSlowMs = 1;

  /// Opens the store, making the directory where it is missing. An Error where `directory` is a file, holds
  /// something else than a store, or can neither be made nor read; where it can only be read, a warning.
  /// O(size of the newest segments): those that were merged are mapped and searched, not read.
  static Result<std::unique_ptr<DiskStore>> open(const std::string& directory, DiskStoreOptions options = {});
  /// Appends what is gathered, and evicts where the bound is passed.
  ~DiskStore();
  DiskStore(const DiskStore&) = delete;
  DiskStore& operator=(const DiskStore&) = delete;

  // Everything below is thread-safe, and none of it fails: see "Safety".

  /// What is known under this key. O(1); < 0.3 µs where nothing has to be read from disk.
  std::optional<ResultRecord> find(const Digest& key) const;
  /// The same without copying the texts: outputs only, into `outputs`, which is resized. False: not known.
  bool findOutputs(const Digest& key, std::vector<OutputRecord>& outputs) const;
  /// Whether any result of this recipe is known, whatever its inputs were.
  bool knowsRecipe(const Digest& recipe) const;
  /// Keeps the record; replaces one of the same key. < 1 µs for results quicker than kSlowMs.
  void record(const ResultRecord& record);
  /// Takes up what other processes have recorded since opening or the last refresh. Cheap where there is
  /// nothing.
  void refresh();

  /// Whether the value is there, as far as its file's name tells.
  bool hasObject(const Digest& digest) const;
  /// The value, with its parts; empty where it isn't there in full and sound, or memory doesn't suffice.
  /// Reading marks it as used. Values that were loaded or saved before and are still alive in this process,
  /// parts among them, are shared, not loaded again.
  Value load(const ValueType& type, const Digest& digest);
  /// Keeps the value and its parts. `ms` is what making it took: evicting weighs that against the bytes.
  /// False where it could not be kept, or its type can't be.
  bool save(const Value& value, const Digest& digest, double ms);

  /// Bytes under a key of whoever keeps them (base/memo.h): an object like others, checked, bounded and
  /// evicted. None where it isn't there and sound, or memory doesn't suffice.
  std::optional<std::string> part(const Digest& key);
  /// False where it could not be kept.
  bool savePart(const Digest& key, std::string_view bytes, double ms);

  /// Content digests of files by path and identity, so that big inputs are read once. The identity must have
  /// been taken before the content was read. That of a file that was changed within the last 50 ms is not
  /// kept: another change within the clock's grain would not show.
  std::optional<Digest> fileDigest(const std::string& path, const FileIdentity& identity) const;
  void setFileDigest(const std::string& path, const FileIdentity& identity, const Digest& digest);

  /// Texts by name (the last run of a graph), replaced whole. `name` is any text; empty where there is none.
  std::string history(const std::string& name) const;
  void setHistory(const std::string& name, std::string_view content);

  /// Appends what is gathered.
  void flush();
  /// Evicts until all fits into `mostBytes`. Of history at most a hundredth of that stays, the newest, and of
  /// records a tenth; the rest is for objects. What takes the least time to make again per byte goes first,
  /// time counting half after every two days without use (worth.h). Parts are objects like others: what
  /// refers to one that went is a miss. Also removes what killed processes left behind, and merges segments;
  /// those that another process is writing stay. Returns the bytes freed.
  std::uint64_t collect(std::uint64_t mostBytes);
  /// O(objects + records).
  DiskStoreStats stats() const;
  /// Reads everything, deletes what is unsound, and returns a line for each.
  std::vector<std::string> verify();
  /// Removes all results; what other processes are writing survives or is lost, but never half.
  Result<void> clear();

  const std::string& directory() const;

  /// $SHERD_CACHE, else $XDG_CACHE_HOME/sherd, else $HOME/.cache/sherd; empty where none of them is set.
  static std::string defaultDirectory(
      const std::function<std::optional<std::string>(const std::string&)>& environment);

 private:
  struct Impl;
  explicit DiskStore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
