// Frames by one of their digests: open addressing, 16 bytes an entry, no allocation per entry.
#pragma once

#include <cstdint>
#include <vector>

#include "eval/record_frame.h"

namespace sherd::store {

/// `digestIn` is keyOf or recipeOf. Frames must outlive the table.
template <Digest (*digestIn)(Frame)>
class FrameTable {
 public:
  /// The frame of this digest, or null. O(1).
  Frame find(const Digest& digest) const {
    if (entries_.empty()) return nullptr;
    const std::uint64_t bits = mixed(digest);
    for (std::size_t i = bits >> shift_;; i = (i + 1) & (entries_.size() - 1)) {
      const Entry& entry = entries_[i];
      if (entry.frame == nullptr) return nullptr;
      if (entry.bits == bits && digestIn(entry.frame) == digest) return entry.frame;
    }
  }
  /// Replaces the frame of the same digest. O(1) on average.
  void put(Frame frame) {
    if (2 * (count_ + 1) > entries_.size()) grow();
    const Digest digest = digestIn(frame);
    const std::uint64_t bits = mixed(digest);
    for (std::size_t i = bits >> shift_;; i = (i + 1) & (entries_.size() - 1)) {
      Entry& entry = entries_[i];
      if (entry.frame == nullptr) {
        entry = {bits, frame};
        ++count_;
        return;
      }
      if (entry.bits == bits && digestIn(entry.frame) == digest) {
        entry.frame = frame;
        return;
      }
    }
  }
  /// O(size).
  template <class F>
  void each(F&& f) const {
    for (const Entry& entry : entries_)
      if (entry.frame != nullptr) f(entry.frame);
  }
  std::size_t size() const { return count_; }
  void clear() { *this = {}; }

 private:
  struct Entry {
    std::uint64_t bits = 0;
    Frame frame = nullptr;
  };

  void grow() {
    std::vector<Entry> old(entries_.empty() ? 1024 : 2 * entries_.size());
    old.swap(entries_);
    shift_ = 64;
    for (std::size_t size = entries_.size(); size > 1; size /= 2) --shift_;
    for (const Entry& entry : old) {
      if (entry.frame == nullptr) continue;
      std::size_t i = entry.bits >> shift_;
      while (entries_[i].frame != nullptr) i = (i + 1) & (entries_.size() - 1);
      entries_[i] = entry;
    }
  }

  std::vector<Entry> entries_;  ///< a power of two, at most half full
  std::size_t count_ = 0;
  int shift_ = 64;
};

}  // namespace sherd::store
