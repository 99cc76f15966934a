// Files of frames. A young segment is what one process appended: a head, then frames in the order of time. A
// merged segment is written once and begins with two indices, so that it is mapped and searched, not read:
//
//   head · first entry of each bucket of keys, of recipes · entries of keys, of recipes · frames
//
// Entries are (mixed digest, offset of a frame) in ascending order; a bucket is what shares the upper bits.
// The indices have no checksum: what they lead to has one, and holds the digest that was asked for. Damage to
// them hides records, and nothing worse.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eval/record_frame.h"
#include "eval/store_directory.h"

namespace sherd::store {

struct SegmentHead {
  static constexpr std::uint64_t kMagic = 0x6365'7264'7265'6873;  // "sherdrec"
  static constexpr std::uint32_t kFormat = 2;
  std::uint64_t magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint32_t merged = 0;  ///< 1 where indices follow
};
constexpr std::size_t kYoungHead = sizeof(SegmentHead);
static_assert(kYoungHead == 16);

/// The head of a young segment, as bytes.
std::string_view youngHead();
bool isYoung(std::string_view bytes);

/// A file's bytes, mapped for as long as the object lives.
class Mapping {
 public:
  explicit Mapping(const Descriptor& file);
  ~Mapping();
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

class MergedSegment {
 public:
  /// Null where the file isn't there or isn't a merged segment of this format. O(1).
  static std::unique_ptr<MergedSegment> open(const std::string& path);

  /// The sound frame of this digest, or null. O(1) expected.
  Frame find(const Digest& key) const { return search<keyOf>(keys_, key); }
  Frame findRecipe(const Digest& recipe) const { return search<recipeOf>(recipes_, recipe); }
  /// Where the frames begin, in bytes().
  std::size_t framesBegin() const { return framesBegin_; }
  std::string_view bytes() const { return mapping_.bytes(); }

 private:
  struct Entry {
    std::uint64_t bits, offset;
  };
  struct Index {
    std::span<const std::uint64_t> buckets;  ///< one more than there are
    std::span<const Entry> entries;
    int shift = 63;
  };
  explicit MergedSegment(const Descriptor& file) : mapping_(file) {}
  bool readHead();
  template <Digest (*digestIn)(Frame)>
  Frame search(const Index& index, const Digest& digest) const;
  friend class MergedWriter;

  Mapping mapping_;
  Index keys_, recipes_;
  std::size_t framesBegin_ = 0;
};

/// Writes a merged segment of these frames, each of another key, to an empty file. 0, or the error number.
int writeMerged(int descriptor, std::span<const Frame> frames);

}  // namespace sherd::store
