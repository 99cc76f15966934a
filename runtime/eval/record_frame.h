// One record as bytes, in memory and in files alike: a head of fixed size, then what varies in length. Frames
// are padded to 8 bytes and carry a checksum of all of it, so that damage is found and the next frame behind
// it, too.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include "eval/result.h"

namespace sherd::store {

enum class FrameKind : std::uint32_t { Result = 1, FileDigest = 2 };

struct FrameHead {
  static constexpr std::uint32_t kMagic = 0x6672'6873;  // "shrf"
  std::uint32_t magic = kMagic;
  std::uint32_t size = 0;      ///< of the whole frame
  std::uint64_t checksum = 0;  ///< of everything behind it, and of the size
  std::int64_t time = 0;       ///< of recording, ns since 1970
  std::int64_t used = 0;       ///< when it was last used, to a day
  FrameKind kind = FrameKind::Result;
  std::uint32_t outputs = 0, messages = 0, written = 0;
  Digest key;     ///< of the result, or of the file's path
  Digest recipe;  ///< of the result, or the digest of the file's content
  double ms = 0;
};
static_assert(sizeof(FrameHead) == 88);
static_assert(sizeof(OutputRecord) == 24 && sizeof(FileIdentity) == 40, "no padding: kept by their bytes");

/// A pointer to the first byte of a sound frame.
using Frame = const char*;

inline FrameHead headOf(Frame frame) {
  FrameHead head;
  std::memcpy(&head, frame, sizeof head);
  return head;
}
inline Digest keyOf(Frame frame) {
  Digest key;
  std::memcpy(&key, frame + offsetof(FrameHead, key), sizeof key);
  return key;
}
inline Digest recipeOf(Frame frame) {
  Digest recipe;
  std::memcpy(&recipe, frame + offsetof(FrameHead, recipe), sizeof recipe);
  return recipe;
}
inline std::int64_t timeOf(Frame frame) {
  std::int64_t time;
  std::memcpy(&time, frame + offsetof(FrameHead, time), sizeof time);
  return time;
}
inline std::int64_t usedOf(Frame frame) {
  std::int64_t time;
  std::memcpy(&time, frame + offsetof(FrameHead, used), sizeof time);
  return time;
}
inline std::uint32_t sizeOf(Frame frame) {
  std::uint32_t size;
  std::memcpy(&size, frame + offsetof(FrameHead, size), sizeof size);
  return size;
}
inline FrameKind kindOf(Frame frame) {
  FrameKind kind;
  std::memcpy(&kind, frame + offsetof(FrameHead, kind), sizeof kind);
  return kind;
}

/// Spreads keys over tables of any power of two, by the upper bits.
inline std::uint64_t mixed(const Digest& digest) {
  std::uint64_t bits = (digest.low ^ (digest.high * 0x9E37'79B9'7F4A'7C15U)) * 0xD6E8'FEB8'6659'FD93U;
  bits ^= bits >> 32;
  return bits * 0x9E37'79B9'7F4A'7C15U;
}

/// Bytes of the frame; 0 where the record is too large for one (4 GiB).
std::size_t frameSize(const ResultRecord& record);
/// `to` has room for `size` = frameSize(record) bytes.
void writeFrame(const ResultRecord& record, std::int64_t time, std::size_t size, char* to);

/// Writes a copy, of the same time but used at `used`, to sizeOf(frame) bytes.
void writeUsed(Frame frame, std::int64_t used, char* to);

constexpr std::size_t kFileFrameSize = sizeof(FrameHead) + sizeof(FileIdentity);
void writeFileFrame(const Digest& path, const FileIdentity& identity, const Digest& content,
                    std::int64_t time, char* to);

/// The size of the sound frame that `bytes` begin with, or 0.
std::size_t soundFrameAt(std::string_view bytes);

/// Only for frames of kind Result.
void readOutputs(Frame frame, std::vector<OutputRecord>& outputs);
std::optional<ResultRecord> readResult(Frame frame);
/// Only for frames of kind FileDigest.
FileIdentity readIdentity(Frame frame);
/// What finding it out again takes, in ms: the result's own time, or that of reading the file.
double costOf(Frame frame);

struct FrameScan {
  std::size_t end = 0;      ///< behind the last sound frame
  std::size_t damaged = 0;  ///< bytes between sound frames
};
/// Calls each(frame) for the sound frames of `bytes`, which begin at `from`, a multiple of 8; goes on behind
/// damaged ones.
template <class F>
FrameScan eachFrame(std::string_view bytes, std::size_t from, F&& each) {
  FrameScan scan{from, 0};
  for (std::size_t at = from; at + sizeof(FrameHead) <= bytes.size();) {
    const std::size_t size = soundFrameAt(bytes.substr(at));
    if (size == 0) {
      at += 8;
      continue;
    }
    scan.damaged += at - scan.end;
    each(bytes.data() + at);
    scan.end = at += size;
  }
  return scan;
}

}  // namespace sherd::store
