// Results of nodes by the content of what they were made from. In memory, bounded in bytes; the least
// recently used go first. Thread-safe.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/exec.h"
#include "base/hash.h"
#include "eval/result.h"
#include "graph/value.h"

namespace sherd {

/// A value on a wire together with its digest, which is computed once.
struct Output {
  Value value;
  Digest digest;
};
using Outputs = std::map<std::string, Output>;

/// What a node made, and what it said while it did: a hit says it again.
struct CachedResult {
  Outputs outputs;
  std::vector<Message> messages;
};

class Cache {
 public:
  static constexpr std::size_t kDefaultBytes = std::size_t{1} << 30;

  explicit Cache(std::size_t mostBytes = kDefaultBytes) : mostBytes_(mostBytes) {}

  /// O(1).
  std::optional<CachedResult> find(const Digest& key);
  /// Keeps the result, unless it alone is larger than the bound. Values that live on elsewhere count all the
  /// same.
  void insert(const Digest& key, CachedResult result);

  std::size_t bytes() const;
  std::size_t size() const;

 private:
  struct Entry {
    Digest key;
    CachedResult result;
    std::size_t bytes = 0;
  };
  void dropLast();

  const std::size_t mostBytes_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  ///< most recently used first
  std::unordered_map<Digest, std::list<Entry>::iterator> byKey_;
  std::size_t bytes_ = 0;
};

}  // namespace sherd
