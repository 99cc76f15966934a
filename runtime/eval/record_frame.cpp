#include "eval/record_frame.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace sherd::store {
namespace {

constexpr std::size_t kUnchecked = offsetof(FrameHead, time);  // what stands before the bytes of the checksum

std::uint64_t checksumOf(Frame frame, std::size_t size) {
  return checksum64(frame + kUnchecked, size - kUnchecked) ^ size;
}

/// Finishes a frame whose head and body are in place.
void seal(char* frame, std::size_t size) {
  const std::uint64_t checksum = checksumOf(frame, size);
  std::memcpy(frame + offsetof(FrameHead, checksum), &checksum, sizeof checksum);
}

class Pen {
 public:
  explicit Pen(char* at) : at_(at) {}
  void put(const void* data, std::size_t size) {
    if (size > 0) std::memcpy(at_, data, size);
    at_ += size;
  }
  void text(std::string_view text) {
    const auto size = static_cast<std::uint32_t>(text.size());
    put(&size, sizeof size);
    put(text.data(), text.size());
  }
  const char* at() const { return at_; }

 private:
  char* at_;
};

/// Reads what a Pen wrote; ok() is false once something was missing.
class Eye {
 public:
  explicit Eye(std::string_view bytes) : bytes_(bytes) {}
  void take(void* data, std::size_t size) {
    if (size > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return;
    }
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  std::string text() {
    std::uint32_t size = 0;
    take(&size, sizeof size);
    if (size > bytes_.size()) {
      ok_ = false;
      return {};
    }
    std::string text(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return text;
  }
  bool ok() const { return ok_; }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace

std::size_t frameSize(const ResultRecord& record) {
  std::size_t size = sizeof(FrameHead) + record.outputs.size() * sizeof(OutputRecord);
  for (const Message& message : record.messages) size += 1 + 4 + message.text.size();
  for (const WrittenFile& file : record.written) size += sizeof(FileIdentity) + 4 + file.path.size();
  size = (size + 7) / 8 * 8;
  return size <= std::numeric_limits<std::uint32_t>::max() ? size : 0;
}

void writeFrame(const ResultRecord& record, std::int64_t time, std::size_t size, char* to) {
  FrameHead head;
  head.size = static_cast<std::uint32_t>(size);
  head.time = head.used = time;
  head.outputs = static_cast<std::uint32_t>(record.outputs.size());
  head.messages = static_cast<std::uint32_t>(record.messages.size());
  head.written = static_cast<std::uint32_t>(record.written.size());
  head.key = record.key;
  head.recipe = record.recipe;
  head.ms = record.ms;
  Pen pen(to);
  pen.put(&head, sizeof head);
  pen.put(record.outputs.data(), record.outputs.size() * sizeof(OutputRecord));
  for (const Message& message : record.messages) {
    const auto level = static_cast<std::uint8_t>(message.level);
    pen.put(&level, sizeof level);
    pen.text(message.text);
  }
  for (const WrittenFile& file : record.written) {
    pen.put(&file.identity, sizeof file.identity);
    pen.text(file.path);
  }
  static constexpr char kPadding[8] = {};
  pen.put(kPadding, static_cast<std::size_t>(to + size - pen.at()));
  seal(to, size);
}

void writeFileFrame(const Digest& path, const FileIdentity& identity, const Digest& content,
                    std::int64_t time, char* to) {
  FrameHead head;
  head.size = kFileFrameSize;
  head.time = head.used = time;
  head.kind = FrameKind::FileDigest;
  head.key = path;
  head.recipe = content;
  Pen pen(to);
  pen.put(&head, sizeof head);
  pen.put(&identity, sizeof identity);
  seal(to, kFileFrameSize);
}

void writeUsed(Frame frame, std::int64_t used, char* to) {
  const std::size_t size = sizeOf(frame);
  std::memcpy(to, frame, size);
  std::memcpy(to + offsetof(FrameHead, used), &used, sizeof used);
  seal(to, size);
}

std::size_t soundFrameAt(std::string_view bytes) {
  if (bytes.size() < sizeof(FrameHead)) return 0;
  std::uint32_t magic;
  std::memcpy(&magic, bytes.data(), sizeof magic);
  const std::size_t size = sizeOf(bytes.data());
  if (magic != FrameHead::kMagic || size < sizeof(FrameHead) || size % 8 != 0 || size > bytes.size())
    return 0;
  const FrameHead head = headOf(bytes.data());
  if (head.checksum != checksumOf(bytes.data(), size)) return 0;
  const std::size_t body = size - sizeof(FrameHead);
  switch (head.kind) {
    case FrameKind::Result:
      return head.outputs <= body / sizeof(OutputRecord) ? size : 0;
    case FrameKind::FileDigest:
      return size == kFileFrameSize ? size : 0;
  }
  return 0;
}

void readOutputs(Frame frame, std::vector<OutputRecord>& outputs) {
  std::uint32_t count;
  std::memcpy(&count, frame + offsetof(FrameHead, outputs), sizeof count);
  outputs.resize(count);
  if (count > 0) std::memcpy(outputs.data(), frame + sizeof(FrameHead), count * sizeof(OutputRecord));
}

std::optional<ResultRecord> readResult(Frame frame) {
  const FrameHead head = headOf(frame);
  ResultRecord record;
  record.key = head.key;
  record.recipe = head.recipe;
  record.ms = head.ms;
  readOutputs(frame, record.outputs);
  const std::size_t begin = sizeof head + head.outputs * sizeof(OutputRecord);
  Eye eye({frame + begin, head.size - begin});
  for (std::uint32_t i = 0; i < head.messages && eye.ok(); ++i) {
    std::uint8_t level = 0;
    eye.take(&level, sizeof level);
    record.messages.push_back({static_cast<LogLevel>(level), eye.text()});
  }
  for (std::uint32_t i = 0; i < head.written && eye.ok(); ++i) {
    WrittenFile file;
    eye.take(&file.identity, sizeof file.identity);
    file.path = eye.text();
    record.written.push_back(std::move(file));
  }
  if (!eye.ok()) return std::nullopt;
  return record;
}

FileIdentity readIdentity(Frame frame) {
  FileIdentity identity;
  std::memcpy(&identity, frame + sizeof(FrameHead), sizeof identity);
  return identity;
}

double costOf(Frame frame) {
  constexpr double kBytesPerMs = 1e6;
  if (kindOf(frame) == FrameKind::FileDigest)
    return static_cast<double>(readIdentity(frame).bytes) / kBytesPerMs;
  const double ms = headOf(frame).ms;
  return ms > 0 && std::isfinite(ms) ? ms : 0;
}

}  // namespace sherd::store
