// What a value type tells of itself, so that graph and eval can move, hash, size, save and load its values
// without knowing what they are.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/archive.h"
#include "base/digest_memo.h"
#include "base/hash.h"

namespace sherd {

/// One object per type and shared library; types are equal by name.
struct ValueType {
  std::string name;
  Digest (*digest)(const void*);      ///< of the content, the name included
  std::size_t (*bytes)(const void*);  ///< in memory, about
  int archiveVersion = 0;             ///< of the bytes on disk
  /// Null where the type has no saveValue and loadValue: its values are then never kept on disk.
  void (*save)(ArchiveWriter&, const void*) = nullptr;
  std::shared_ptr<const void> (*load)(ArchiveReader&) = nullptr;  ///< null where the bytes make no value
};

/// Numbers and strings travel under these names; a port of one can be wired to a parameter of the same kind
/// (an Integer also to a Number).
template <class T>
struct ScalarName;
template <>
struct ScalarName<bool> {
  static constexpr const char* value = "Boolean";
};
template <>
struct ScalarName<std::int64_t> {
  static constexpr const char* value = "Integer";
};
template <>
struct ScalarName<double> {
  static constexpr const char* value = "Number";
};
template <>
struct ScalarName<std::string> {
  static constexpr const char* value = "String";
};

template <class T>
concept ScalarValue = requires {
  ScalarName<T>::value;
};

template <class T>
concept ArchivedValue = requires(ArchiveWriter& to, ArchiveReader& from, const T& value) {
  saveValue(to, value);
  { loadValue(from, std::type_identity<T>()) } -> std::same_as<std::optional<T>>;
  T::archiveVersion;
};

template <class T>
constexpr const char* valueTypeName() {
  if constexpr (ScalarValue<T>)
    return ScalarName<T>::value;
  else
    return T::typeName;
}

namespace detail {

template <class T>
Digest digestOf(const void* p) {
  const T& value = *static_cast<const T*>(p);
  Hasher hasher;
  hasher.add(std::string_view(valueTypeName<T>()));
  if constexpr (std::is_same_v<T, std::string>)
    hasher.add(std::string_view(value));
  else if constexpr (ScalarValue<T>)
    hasher.add(value);
  else
    hashValue(hasher, value);
  return hasher.digest();
}

template <class T>
std::size_t bytesOf(const void* p) {
  if constexpr (std::is_same_v<T, std::string>)
    return sizeof(T) + static_cast<const T*>(p)->size();
  else if constexpr (ScalarValue<T>)
    return sizeof(T);
  else
    return byteSize(*static_cast<const T*>(p));
}

template <class T>
void save(ArchiveWriter& to, const void* p) {
  const T& value = *static_cast<const T*>(p);
  if constexpr (std::is_same_v<T, std::string>)
    to.text(value);
  else if constexpr (ScalarValue<T>)
    to.put(value);
  else
    saveValue(to, value);
}

template <class T>
std::shared_ptr<const void> load(ArchiveReader& from) {
  std::optional<T> value;
  if constexpr (std::is_same_v<T, std::string>)
    value = from.text();
  else if constexpr (ScalarValue<T>)
    value = from.get<T>();
  else
    value = loadValue(from, std::type_identity<T>());
  if (!value || !from.ok() || !from.atEnd()) return nullptr;
  return std::make_shared<const T>(std::move(*value));
}

}  // namespace detail

/// The description of T. T is a scalar, or has T::typeName and, by argument-dependent look-up,
/// hashValue(Hasher&, const T&) and byteSize(const T&); to be kept on disk also what base/archive.h asks for.
template <class T>
const ValueType& valueType() {
  static const ValueType type = [] {
    ValueType made{valueTypeName<T>(), &detail::digestOf<T>, &detail::bytesOf<T>};
    if constexpr (ScalarValue<T>) {
      made.archiveVersion = 1;
      made.save = &detail::save<T>;
      made.load = &detail::load<T>;
    } else if constexpr (ArchivedValue<T>) {
      made.archiveVersion = T::archiveVersion;
      made.save = &detail::save<T>;
      made.load = &detail::load<T>;
    }
    return made;
  }();
  return type;
}

/// Feeds a value that another one holds, or that there is none, by its digest.
template <class T>
void hashPart(Hasher& hasher, const std::shared_ptr<const T>& value) {
  hasher.add(value != nullptr);
  if (value != nullptr) hasher.add(sharedDigest(valueType<T>(), value));
}

template <class T>
void ArchiveWriter::part(const std::shared_ptr<const T>& value) {
  put(value != nullptr);
  if (value == nullptr) return;
  const ValueType& type = valueType<T>();
  parts_.push_back({&type, value, sharedDigest(type, value)});
  put(parts_.back().digest);
}

template <class T>
std::shared_ptr<const T> ArchiveReader::part() {
  if (!get<bool>()) return nullptr;
  const Digest wanted = digest();
  if (!ok_) return nullptr;
  auto value = parts_ ? parts_(valueType<T>(), wanted) : nullptr;
  if (value == nullptr)
    fail();
  else
    rememberDigest(valueType<T>(), value, wanted);
  return std::static_pointer_cast<const T>(value);
}

}  // namespace sherd
