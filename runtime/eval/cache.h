// Results of nodes by the content of what they were made from. In memory, bounded in bytes; the least
// recently used go first. Thread-safe.
#pragma once

#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/hash.h"
#include "eval/result.h"
#include "graph/value.h"

namespace sherd {

/// A value on a wire together with its digest, which is computed once. The digest alone may be known; both
/// are empty where the node left the output unset.
struct Output {
  Value value;
  Digest digest;
};
using Outputs = std::vector<Output>;  ///< in the order of the type's outputs

/// What a node made, and what is known of it.
struct CachedResult {
  Outputs outputs;
  ResultRecord record;
};

class Cache {
 public:
  static constexpr std::size_t kDefaultBytes = std::size_t{1} << 30;

  explicit Cache(std::size_t mostBytes = kDefaultBytes) : mostBytes_(mostBytes) {}

  /// O(1).
  std::optional<CachedResult> find(const Digest& key);
  /// Keeps the result in place of an older one of the same key, unless it alone is larger than the bound.
  /// Values that live on elsewhere count all the same.
  void insert(CachedResult result);

  void clear();
  std::size_t bytes() const;
  std::size_t size() const;

 private:
  struct Entry {
    CachedResult result;
    std::size_t bytes = 0;
  };
  void drop(std::list<Entry>::iterator entry);

  const std::size_t mostBytes_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  ///< most recently used first
  std::unordered_map<Digest, std::list<Entry>::iterator> byKey_;
  std::size_t bytes_ = 0;
};

}  // namespace sherd
