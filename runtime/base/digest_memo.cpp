#include "base/digest_memo.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "base/value_type.h"

namespace sherd {
namespace {

constexpr std::size_t kWorthRemembering = 4096;  // bytes

struct Entry {
  explicit Entry(std::weak_ptr<const void> of) : owner(std::move(of)) {}
  const std::weak_ptr<const void> owner;  ///< tells whether the object at this address is still the same one
  std::mutex mutex;
  std::optional<Digest> digest;
};

/// A struct and its first member share their address, hence the type.
struct Key {
  const void* address;
  std::string type;
  friend bool operator==(const Key&, const Key&) = default;
};

struct KeyHash {
  std::size_t operator()(const Key& key) const { return std::hash<const void*>()(key.address); }
};

class DigestMemo {
 public:
  std::shared_ptr<Entry> entry(const ValueType& type, const std::shared_ptr<const void>& value) {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Entry>& found = entries_[Key{value.get(), type.name}];
    if (found != nullptr && isOf(*found, value)) return found;
    const auto made = found = std::make_shared<Entry>(value);
    if (entries_.size() >= sweepAt_) sweep();
    return made;
  }

 private:
  static bool isOf(const Entry& entry, const std::shared_ptr<const void>& value) {
    return !entry.owner.owner_before(value) && !value.owner_before(entry.owner);
  }

  /// At every doubling of what is alive, so that its cost spreads evenly.
  void sweep() {
    std::erase_if(entries_, [](const auto& item) { return item.second->owner.expired(); });
    sweepAt_ = std::max<std::size_t>(64, 2 * entries_.size());
  }

  std::mutex mutex_;
  std::unordered_map<Key, std::shared_ptr<Entry>, KeyHash> entries_;
  std::size_t sweepAt_ = 64;
};

/// Never destroyed: values in other static objects may be hashed after this file's would be gone.
DigestMemo& memo() {
  static DigestMemo& only = *new DigestMemo;
  return only;
}

bool worthRemembering(const ValueType& type, const std::shared_ptr<const void>& value) {
  return value.use_count() > 0 && type.bytes(value.get()) >= kWorthRemembering;
}

}  // namespace

Digest sharedDigest(const ValueType& type, const std::shared_ptr<const void>& value) {
  if (!worthRemembering(type, value)) return type.digest(value.get());
  const auto entry = memo().entry(type, value);
  // Held while hashing: a value's parts have entries of their own, and nothing holds itself.
  const std::lock_guard lock(entry->mutex);
  if (!entry->digest) entry->digest = type.digest(value.get());
  return *entry->digest;
}

void rememberDigest(const ValueType& type, const std::shared_ptr<const void>& value, const Digest& digest) {
  if (!worthRemembering(type, value)) return;
  const auto entry = memo().entry(type, value);
  const std::lock_guard lock(entry->mutex);
  entry->digest = digest;
}

}  // namespace sherd
