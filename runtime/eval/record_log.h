// All records of a store: those of this process, appended to a young segment of its own; those of others, as
// far as they were read; and the merged segments. Thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "eval/frame_table.h"
#include "eval/record_segment.h"
#include "eval/store_directory.h"

namespace sherd::store {

class RecordLog {
 public:
  static constexpr std::size_t kBatchBytes = std::size_t{64} << 10;  ///< gathered before they are appended
  static constexpr std::size_t kMostSegments = 8;                    ///< young ones that nobody holds
  static constexpr std::uint64_t kMostYoungBytes = std::uint64_t{4} << 20;  ///< of these

  explicit RecordLog(Directory& directory) : directory_(directory) {}
  ~RecordLog() { close(); }
  RecordLog(const RecordLog&) = delete;
  RecordLog& operator=(const RecordLog&) = delete;

  /// Reads what is new in the folder.
  void refresh();

  /// Calls use(frame) with the newest frame of this key and returns its result; a default one where there is
  /// none. The frame may be used only until `use` returns. Marks it as used, at most once a day.
  template <class F>
  auto find(const Digest& key, F&& use) -> decltype(use(Frame{})) {
    const std::lock_guard lock(mutex_);
    const Frame frame = newest(key);
    if (frame == nullptr) return {};
    if (usedOf(frame) + kDay < now()) return use(markUsed(frame));
    return use(frame);
  }
  bool knowsRecipe(const Digest& recipe) const;

  /// `at_once`: hands it to the kernel before returning, with all that was gathered.
  void add(const ResultRecord& record, bool atOnce);
  void addFile(const Digest& path, const FileIdentity& identity, const Digest& content);
  void flush();
  /// Flushes, and lets go of the own segment; a later record begins another one.
  void close();

  /// Merges the segments that nobody holds where there are more than kMostSegments or kMostYoungBytes of
  /// them, and deletes what isn't a segment; `all`: in any case, and all merged ones with them. Where these
  /// come to more than `mostBytes`, drops the records of the least worth() until an eighth of that is free
  /// again. Does nothing while another process merges. Returns the bytes freed.
  std::uint64_t merge(std::uint64_t mostBytes, bool all);
  /// Removes all segments and forgets all records.
  void clear();

  /// Results known. O(records).
  std::uint64_t count() const;
  std::uint64_t bytesOnDisk() const;
  /// A line for each segment that is damaged.
  std::vector<std::string> verify() const;

  /// Now, as stamped on records: ns since 1970, about 4 ms coarse.
  static std::int64_t now();

 private:
  static constexpr std::int64_t kDay = 86'400'000'000'000;  // ns

  Frame newest(const Digest& key) const;
  Frame markUsed(Frame frame);
  char* room(std::size_t size);
  void added(std::size_t size, bool atOnce);
  void appendPending();
  bool ownSegment();
  void keep(Frame frame);
  bool takeUp(const std::vector<std::string>& names);
  bool readYoung(const std::string& name);
  void dropSuperseded();

  Directory& directory_;
  mutable std::mutex mutex_;
  std::mutex merging_;

  FrameTable<keyOf> young_;       ///< frames in chunks_
  FrameTable<recipeOf> recipes_;  ///< of the same
  std::vector<std::unique_ptr<char[]>> chunks_;
  char *chunk_ = nullptr, *chunkEnd_ = nullptr;  ///< room left for own records
  char* pending_ = nullptr;                      ///< [pending_, chunk_) is to be appended

  OwnFile own_;
  std::map<std::string, std::uint64_t> readTo_;  ///< of young segments of others: the offset read to
  std::map<std::string, std::uint64_t> sizes_;   ///< and the size that they had then
  std::map<std::string, std::unique_ptr<MergedSegment>> merged_;
};

}  // namespace sherd::store
