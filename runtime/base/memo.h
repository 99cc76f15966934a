// Parts of a node's work, kept beside the results of nodes. A node that computes many things that don't
// depend on each other keeps each as soon as it is there: then a run that needs some of them again finds
// them, and one that was killed goes on where it was.
//
// A part is a function of what its key is made of, and of nothing else: the content of what it is computed
// from, and a word for what it is. Whatever is damaged or was thrown away is computed again, so a result must
// be the same to the bit whether its parts were found or not.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/archive.h"
#include "base/hash.h"
#include "base/value_type.h"

namespace sherd {

/// Where they are kept. Thread-safe.
class Memo {
 public:
  virtual ~Memo() = default;
  /// None where there is nothing under this key, or nothing sound.
  virtual std::optional<std::string> find(const Digest& key) = 0;
  /// `ms`: what computing it took, which is weighed against its bytes when room is made. Where it can't be
  /// kept, nothing happens.
  virtual void keep(const Digest& key, std::string_view bytes, double ms) = 0;
};

namespace detail {
template <class T>
Digest memoKey(const Digest& key) {
  return Hasher().add(std::string_view(T::typeName)).add(T::archiveVersion).add(key).digest();
}
}  // namespace detail

/// The T under this key. T has typeName, and what base/archive.h asks for; it holds no parts of its own.
/// `memo`: may be null, for none.
template <ArchivedValue T>
std::optional<T> recall(Memo* memo, const Digest& key) {
  if (memo == nullptr) return std::nullopt;
  const std::optional<std::string> bytes = memo->find(detail::memoKey<T>(key));
  if (!bytes) return std::nullopt;
  ArchiveReader from(*bytes, {});
  std::optional<T> value = loadValue(from, std::type_identity<T>());
  if (!from.ok() || !from.atEnd()) return std::nullopt;
  return value;
}

template <ArchivedValue T>
void remember(Memo* memo, const Digest& key, const T& value, double ms) {
  if (memo == nullptr) return;
  ArchiveWriter to;
  saveValue(to, value);
  memo->keep(detail::memoKey<T>(key), to.bytes(), ms);
}

}  // namespace sherd
