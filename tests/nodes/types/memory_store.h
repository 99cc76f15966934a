// Keeps values as the disk cache does, entry by entry under type and digest, but in memory.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "base/value_type.h"

namespace sherd {

class MemoryStore {
 public:
  template <class T>
  Digest keep(const std::shared_ptr<const T>& value) {
    return keep(valueType<T>(), value);
  }

  /// What was kept, as a new object, or null. Parts that several values hold are loaded once.
  template <class T>
  std::shared_ptr<const T> load(const Digest& digest) {
    return std::static_pointer_cast<const T>(load(valueType<T>(), digest));
  }

  /// Forgets what was loaded, not what is kept.
  void restart() { loaded_.clear(); }
  std::size_t entries() const { return bytes_.size(); }
  const std::string& bytes(const ValueType& type, const Digest& digest) const {
    return bytes_.at({type.name, digest});
  }

  std::shared_ptr<const void> load(const ValueType& type, const Digest& digest) {
    const Key key{type.name, digest};
    if (const auto found = loaded_.find(key); found != loaded_.end()) return found->second;
    const auto kept = bytes_.find(key);
    if (kept == bytes_.end()) return nullptr;
    ArchiveReader from(kept->second, [this](const ValueType& t, const Digest& d) { return load(t, d); });
    const auto value = type.load(from);
    if (value == nullptr) return nullptr;
    EXPECT_EQ(type.digest(value.get()), digest) << type.name;
    return loaded_[key] = value;
  }

 private:
  using Key = std::pair<std::string, Digest>;

  Digest keep(const ValueType& type, const std::shared_ptr<const void>& value) {
    const Digest digest = type.digest(value.get());
    ArchiveWriter to;
    type.save(to, value.get());
    bytes_[{type.name, digest}] = to.bytes();
    for (const ArchivePart& part : to.parts()) {
      EXPECT_EQ(part.type->digest(part.data.get()), part.digest) << part.type->name;
      keep(*part.type, part.data);
    }
    return digest;
  }

  std::map<Key, std::string> bytes_;
  std::map<Key, std::shared_ptr<const void>> loaded_;
};

}  // namespace sherd
