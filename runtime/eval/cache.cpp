#include "eval/cache.h"

#include <utility>

namespace sherd {
namespace {

std::size_t sizeOf(const CachedResult& result) {
  std::size_t bytes = 256;  // the entry itself, about
  for (const Output& output : result.outputs)
    bytes += sizeof output + (output.value.empty() ? 0 : output.value.bytes());
  for (const Message& message : result.record.messages) bytes += sizeof message + message.text.size();
  for (const WrittenFile& file : result.record.written) bytes += sizeof file + file.path.size();
  return bytes;
}

}  // namespace

std::optional<CachedResult> Cache::find(const Digest& key) {
  const std::lock_guard lock(mutex_);
  const auto found = byKey_.find(key);
  if (found == byKey_.end()) return std::nullopt;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->result;
}

void Cache::insert(CachedResult result) {
  const std::size_t bytes = sizeOf(result);
  const std::lock_guard lock(mutex_);
  if (const auto old = byKey_.find(result.record.key); old != byKey_.end()) drop(old->second);
  if (bytes > mostBytes_) return;
  while (bytes_ + bytes > mostBytes_) drop(std::prev(entries_.end()));
  const Digest key = result.record.key;
  entries_.push_front({std::move(result), bytes});
  byKey_.emplace(key, entries_.begin());
  bytes_ += bytes;
}

void Cache::drop(std::list<Entry>::iterator entry) {
  bytes_ -= entry->bytes;
  byKey_.erase(entry->result.record.key);
  entries_.erase(entry);
}

void Cache::clear() {
  const std::lock_guard lock(mutex_);
  byKey_.clear();
  entries_.clear();
  bytes_ = 0;
}

std::size_t Cache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::size_t Cache::size() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

}  // namespace sherd
