#include "eval/record_log.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>

namespace sherd::store {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr std::string_view kFolder = "records";

}  // namespace

std::int64_t RecordLog::now() {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME_COARSE, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

Frame RecordLog::newest(const Digest& key) const {
  if (const Frame frame = young_.find(key)) return frame;  // dropSuperseded: never older than a merged one
  Frame best = nullptr;
  for (const auto& [name, segment] : merged_) {
    const Frame frame = segment->find(key);
    if (frame != nullptr && (best == nullptr || timeOf(frame) > timeOf(best))) best = frame;
  }
  return best;
}

bool RecordLog::knowsRecipe(const Digest& recipe) const {
  const std::lock_guard lock(mutex_);
  return recipes_.find(recipe) != nullptr ||
         std::any_of(merged_.begin(), merged_.end(),
                     [&](const auto& entry) { return entry.second->findRecipe(recipe) != nullptr; });
}

void RecordLog::keep(Frame frame) {
  young_.put(frame);
  if (kindOf(frame) == FrameKind::Result) recipes_.put(frame);
}

/// Own records stand one behind the other, so that a batch is one piece.
char* RecordLog::room(std::size_t size) {
  if (static_cast<std::size_t>(chunkEnd_ - chunk_) < size) {
    appendPending();
    const std::size_t bytes = std::max(kChunkBytes, size);
    chunks_.push_back(std::make_unique_for_overwrite<char[]>(bytes));
    pending_ = chunk_ = chunks_.back().get();
    chunkEnd_ = chunk_ + bytes;
  }
  return chunk_;
}

void RecordLog::added(std::size_t size, bool atOnce) {
  keep(chunk_);
  chunk_ += size;
  if (atOnce || static_cast<std::size_t>(chunk_ - pending_) >= kBatchBytes) appendPending();
}

void RecordLog::add(const ResultRecord& record, bool atOnce) {
  const std::size_t size = frameSize(record);
  if (size == 0) return;
  const std::lock_guard lock(mutex_);
  writeFrame(record, now(), size, room(size));
  added(size, atOnce);
}

void RecordLog::addFile(const Digest& path, const FileIdentity& identity, const Digest& content) {
  const std::lock_guard lock(mutex_);
  writeFileFrame(path, identity, content, now(), room(kFileFrameSize));
  added(kFileFrameSize, false);
}

Frame RecordLog::markUsed(Frame frame) {
  const std::size_t size = sizeOf(frame);
  writeUsed(frame, now(), room(size));
  added(size, false);
  return chunk_ - size;
}

void RecordLog::appendPending() {
  const std::string_view batch(pending_, static_cast<std::size_t>(chunk_ - pending_));
  pending_ = chunk_;
  if (batch.empty() || !directory_.writable() || !ownSegment()) return;
  const int file = own_.descriptor.number();
  struct stat before {};
  ::fstat(file, &before);
  const int error = writeAll(file, {before.st_size == 0 ? youngHead() : std::string_view(), batch});
  if (error == 0) return;
  // Half a batch would only be skipped by readers, but the space may be what is missing.
  if (::ftruncate(file, before.st_size) != 0) directory_.writeFailed(errno);
  directory_.writeFailed(error);
}

/// Whether there is a segment to append to. One that was removed by `clear` in another process is replaced.
bool RecordLog::ownSegment() {
  struct stat info {};
  if (own_.descriptor.isOpen() && ::fstat(own_.descriptor.number(), &info) == 0 && info.st_nlink > 0)
    return true;
  own_ = directory_.create(kFolder, "s-");
  if (own_.error != 0) directory_.writeFailed(own_.error);
  return own_.error == 0;
}

void RecordLog::flush() {
  const std::lock_guard lock(mutex_);
  appendPending();
}

void RecordLog::close() {
  const std::lock_guard lock(mutex_);
  appendPending();
  if (!own_.descriptor.isOpen()) return;
  const std::string name = own_.path.substr(own_.path.rfind('/') + 1);
  readTo_[name] = sizes_[name] = fileBytes(own_.path);  // as others' from now on, and known already
  own_ = OwnFile();
}

void RecordLog::refresh() {
  const std::lock_guard lock(mutex_);
  // Merging puts the new segment in place before it removes the old ones: where something known is gone, a
  // second look finds what replaced it.
  bool second = false;
  for (int look = 0; look < 4; ++look) {
    const std::vector<std::string> names = namesIn(directory_.at(kFolder));
    const bool whole = takeUp(names);
    const auto gone = [&](const auto& entry) {
      return std::find(names.begin(), names.end(), entry.first) == names.end();
    };
    const bool lost = std::any_of(readTo_.begin(), readTo_.end(), gone) ||
                      std::any_of(merged_.begin(), merged_.end(), gone);
    if (second) {
      std::erase_if(readTo_, gone);
      std::erase_if(sizes_, gone);
      std::erase_if(merged_, gone);
    }
    if (whole && (second || !lost)) return;
    second = true;
  }
}

/// False where a segment went away meanwhile.
bool RecordLog::takeUp(const std::vector<std::string>& names) {
  const std::string own = own_.descriptor.isOpen() ? own_.path.substr(own_.path.rfind('/') + 1) : "";
  bool whole = true, anyMerged = false;
  for (const std::string& name : names) {
    if (!name.starts_with("m-") || merged_.contains(name)) continue;
    if (auto segment = MergedSegment::open(directory_.at(kFolder) + '/' + name)) {
      merged_[name] = std::move(segment);
      anyMerged = true;
    }
  }
  if (anyMerged) dropSuperseded();
  for (const std::string& name : names)
    if (name.starts_with("s-") && name != own && !readYoung(name)) whole = false;
  return whole;
}

/// Reads what was appended since. False where it isn't there any more.
bool RecordLog::readYoung(const std::string& name) {
  const std::string path = directory_.at(kFolder) + '/' + name;
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0) return false;
  const auto size = static_cast<std::uint64_t>(info.st_size);
  std::uint64_t& known = sizes_[name];
  if (size == known) return true;
  const Descriptor file = openToRead(path);
  if (!file.isOpen()) return errno != ENOENT;
  std::uint64_t& from = readTo_[name];
  if (from > size) from = 0;
  const std::string bytes = readFrom(file.number(), from, size - from);
  if (from == 0 && !isYoung(bytes)) return true;
  known = size;
  const std::size_t head = from == 0 ? kYoungHead : 0;
  auto chunk = std::make_unique_for_overwrite<char[]>(std::max<std::size_t>(bytes.size(), 1));
  std::memcpy(chunk.get(), bytes.data(), bytes.size());
  const FrameScan scan = eachFrame({chunk.get(), bytes.size()}, head, [&](Frame frame) {
    const Frame old = newest(keyOf(frame));
    if (old == nullptr || timeOf(frame) >= timeOf(old)) keep(frame);
  });
  from += scan.end;
  if (scan.end > head) chunks_.push_back(std::move(chunk));
  return true;
}

/// Forgets young frames that merged segments hold a newer one of.
void RecordLog::dropSuperseded() {
  FrameTable<keyOf> kept;
  FrameTable<keyOf> all = std::move(young_);
  young_.clear();
  all.each([&](Frame frame) {
    const Frame merged = newest(keyOf(frame));
    if (merged == nullptr || timeOf(frame) >= timeOf(merged)) kept.put(frame);
  });
  young_ = std::move(kept);
}

void RecordLog::clear() {
  const std::lock_guard lock(mutex_);
  pending_ = chunk_;
  const std::string folder = directory_.at(kFolder);
  for (const std::string& name : namesIn(folder))
    if (name.starts_with("s-") || name.starts_with("m-")) ::unlink((folder + '/' + name).c_str());
  own_ = OwnFile();
  young_.clear();
  recipes_.clear();
  merged_.clear();
  readTo_.clear();
  sizes_.clear();
  chunks_.clear();
  chunk_ = chunkEnd_ = pending_ = nullptr;
}

std::uint64_t RecordLog::count() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t results = 0;
  young_.each([&](Frame frame) { results += kindOf(frame) == FrameKind::Result; });
  for (const auto& [name, segment] : merged_)
    eachFrame(segment->bytes(), segment->framesBegin(), [&](Frame frame) {
      results += kindOf(frame) == FrameKind::Result && newest(keyOf(frame)) == frame;
    });
  return results;
}

std::uint64_t RecordLog::bytesOnDisk() const {
  const std::string folder = directory_.at(kFolder);
  std::uint64_t bytes = 0;
  for (const std::string& name : namesIn(folder)) bytes += fileBytes(folder + '/' + name);
  return bytes;
}

}  // namespace sherd::store
