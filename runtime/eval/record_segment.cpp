#include "eval/record_segment.h"

#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

namespace sherd::store {
namespace {

struct MergedHead {
  SegmentHead common;
  std::uint64_t keys = 0, recipes = 0;  ///< entries
  std::uint32_t keyBucketBits = 0, recipeBucketBits = 0;
  std::uint64_t checksum = 0;  ///< of what stands before it

  std::uint64_t sum() const { return checksum64(this, offsetof(MergedHead, checksum)); }
};
static_assert(sizeof(MergedHead) == 48);

constexpr std::uint32_t kMostBucketBits = 26;
constexpr std::uint64_t kMostEntries = std::uint64_t{1} << 40;

/// About four entries a bucket. At least two buckets, so that shifts stay below 64.
std::uint32_t bucketBits(std::size_t entries) {
  std::uint32_t bits = 1;
  while (bits < kMostBucketBits && (entries >> bits) > 4) ++bits;
  return bits;
}

}  // namespace

std::string_view youngHead() {
  static const SegmentHead head;
  return {reinterpret_cast<const char*>(&head), sizeof head};
}

bool isYoung(std::string_view bytes) { return bytes.substr(0, kYoungHead) == youngHead(); }

Mapping::Mapping(const Descriptor& file) {
  struct stat info {};
  if (!file.isOpen() || ::fstat(file.number(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0)
    return;
  const auto size = static_cast<std::size_t>(info.st_size);
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number(), 0);
  if (data != MAP_FAILED) bytes_ = {static_cast<const char*>(data), size};
}

Mapping::~Mapping() {
  if (!bytes_.empty()) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

std::unique_ptr<MergedSegment> MergedSegment::open(const std::string& path) {
  std::unique_ptr<MergedSegment> segment(new MergedSegment(openToRead(path)));
  return segment->readHead() ? std::move(segment) : nullptr;
}

bool MergedSegment::readHead() {
  const std::string_view all = bytes();
  MergedHead head;
  if (all.size() < sizeof head) return false;
  std::memcpy(&head, all.data(), sizeof head);
  if (head.common.magic != SegmentHead::kMagic || head.common.format != SegmentHead::kFormat ||
      head.common.merged != 1 || head.checksum != head.sum())
    return false;
  const auto sound = [](std::uint32_t bits) { return bits >= 1 && bits <= kMostBucketBits; };
  if (head.keys > kMostEntries || head.recipes > kMostEntries || !sound(head.keyBucketBits) ||
      !sound(head.recipeBucketBits))
    return false;
  const std::size_t keyBuckets = (std::size_t{1} << head.keyBucketBits) + 1;
  const std::size_t recipeBuckets = (std::size_t{1} << head.recipeBucketBits) + 1;
  framesBegin_ = sizeof head + 8 * (keyBuckets + recipeBuckets) + sizeof(Entry) * (head.keys + head.recipes);
  if (framesBegin_ > all.size()) return false;
  // The mapping begins at a page, and all before the frames is a multiple of 8.
  const auto* buckets = reinterpret_cast<const std::uint64_t*>(all.data() + sizeof head);
  const auto* entries = reinterpret_cast<const Entry*>(buckets + keyBuckets + recipeBuckets);
  keys_ = {{buckets, keyBuckets}, {entries, head.keys}, static_cast<int>(64 - head.keyBucketBits)};
  recipes_ = {{buckets + keyBuckets, recipeBuckets},
              {entries + head.keys, head.recipes},
              static_cast<int>(64 - head.recipeBucketBits)};
  return true;
}

template <Digest (*digestIn)(Frame)>
Frame MergedSegment::search(const Index& index, const Digest& digest) const {
  const std::uint64_t bits = mixed(digest), bucket = bits >> index.shift;
  const std::uint64_t begin = index.buckets[bucket], end = index.buckets[bucket + 1];
  if (begin > end || end > index.entries.size()) return nullptr;
  const auto range = index.entries.subspan(begin, end - begin);
  auto at = std::lower_bound(range.begin(), range.end(), bits,
                             [](const Entry& entry, std::uint64_t wanted) { return entry.bits < wanted; });
  for (; at != range.end() && at->bits == bits; ++at) {
    if (at->offset < framesBegin_ || at->offset >= bytes().size() || at->offset % 8 != 0) continue;
    const Frame frame = bytes().data() + at->offset;
    if (soundFrameAt(bytes().substr(at->offset)) != 0 && digestIn(frame) == digest) return frame;
  }
  return nullptr;
}

template Frame MergedSegment::search<keyOf>(const Index&, const Digest&) const;
template Frame MergedSegment::search<recipeOf>(const Index&, const Digest&) const;

/// Lays out and writes one merged segment.
class MergedWriter {
 public:
  explicit MergedWriter(std::span<const Frame> frames) {
    std::vector<std::pair<std::uint64_t, Frame>> sorted;
    sorted.reserve(frames.size());
    for (const Frame frame : frames) sorted.emplace_back(mixed(keyOf(frame)), frame);
    const auto byBits = [](const auto& a, const auto& b) { return a.first < b.first; };
    if (!std::is_sorted(sorted.begin(), sorted.end(), byBits))
      std::sort(sorted.begin(), sorted.end(), byBits);
    std::uint64_t offset = 0;
    for (const auto& [bits, frame] : sorted) {
      frames_.push_back(frame);
      keys_.push_back({bits, offset});
      if (kindOf(frame) == FrameKind::Result) recipes_.push_back({mixed(recipeOf(frame)), offset});
      offset += sizeOf(frame);
    }
    const auto before = [](const Entry& a, const Entry& b) { return a.bits < b.bits; };
    const auto same = [](const Entry& a, const Entry& b) { return a.bits == b.bits; };
    std::stable_sort(recipes_.begin(), recipes_.end(), before);
    // Recipes whose mixed digests agree by chance would lose one: harmless, and as likely as 2^-64.
    recipes_.erase(std::unique(recipes_.begin(), recipes_.end(), same), recipes_.end());
  }

  int write(int descriptor) {
    MergedHead head;
    head.common.merged = 1;
    head.keys = keys_.size();
    head.recipes = recipes_.size();
    head.keyBucketBits = bucketBits(keys_.size());
    head.recipeBucketBits = bucketBits(recipes_.size());
    head.checksum = head.sum();
    const auto keyBuckets = bucketsOf(keys_, head.keyBucketBits);
    const auto recipeBuckets = bucketsOf(recipes_, head.recipeBucketBits);
    const std::uint64_t begin = sizeof head + 8 * (keyBuckets.size() + recipeBuckets.size()) +
                                sizeof(Entry) * (keys_.size() + recipes_.size());
    for (auto* entries : {&keys_, &recipes_})
      for (Entry& entry : *entries) entry.offset += begin;
    const std::string_view headBytes(reinterpret_cast<const char*>(&head), sizeof head);
    const int error = writeAll(descriptor, {headBytes, bytesOf(keyBuckets), bytesOf(recipeBuckets),
                                            bytesOf(keys_), bytesOf(recipes_)});
    return error != 0 ? error : writeFrames(descriptor);
  }

 private:
  using Entry = MergedSegment::Entry;

  static std::vector<std::uint64_t> bucketsOf(const std::vector<Entry>& entries, std::uint32_t bits) {
    std::vector<std::uint64_t> buckets((std::size_t{1} << bits) + 1, 0);
    for (const Entry& entry : entries) ++buckets[(entry.bits >> (64 - bits)) + 1];
    for (std::size_t i = 1; i < buckets.size(); ++i) buckets[i] += buckets[i - 1];
    return buckets;
  }
  template <class T>
  static std::string_view bytesOf(const std::vector<T>& items) {
    return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)};
  }
  int writeFrames(int descriptor) const {
    static constexpr std::size_t kBlock = std::size_t{1} << 20;
    std::string block;
    for (const Frame frame : frames_) {
      block.append(frame, sizeOf(frame));
      if (block.size() < kBlock) continue;
      if (const int error = writeAll(descriptor, {block}); error != 0) return error;
      block.clear();
    }
    return writeAll(descriptor, {block});
  }

  std::vector<Frame> frames_;
  std::vector<Entry> keys_, recipes_;
};

int writeMerged(int descriptor, std::span<const Frame> frames) {
  return MergedWriter(frames).write(descriptor);
}

}  // namespace sherd::store
