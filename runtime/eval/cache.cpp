#include "eval/cache.h"

#include <utility>

namespace sherd {
namespace {

std::size_t sizeOf(const CachedResult& result) {
  std::size_t bytes = 256;  // the entry itself, about
  for (const auto& [port, output] : result.outputs)
    bytes += port.size() + sizeof output + (output.value.empty() ? 0 : output.value.bytes());
  for (const Message& message : result.messages) bytes += sizeof message + message.text.size();
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

void Cache::insert(const Digest& key, CachedResult result) {
  const std::size_t bytes = sizeOf(result);
  if (bytes > mostBytes_) return;
  const std::lock_guard lock(mutex_);
  if (byKey_.contains(key)) return;  // equal keys stand for equal results
  while (bytes_ + bytes > mostBytes_) dropLast();
  entries_.push_front({key, std::move(result), bytes});
  byKey_.emplace(key, entries_.begin());
  bytes_ += bytes;
}

void Cache::dropLast() {
  bytes_ -= entries_.back().bytes;
  byKey_.erase(entries_.back().key);
  entries_.pop_back();
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
