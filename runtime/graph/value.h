// Type-erased values on wires. graph and eval move, hash and size them without knowing what they are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/hash.h"

namespace sherd {

/// What a value type tells of itself. One object per type and shared library; types are equal by name.
struct ValueType {
  std::string name;
  Digest (*digest)(const void*);
  std::size_t (*bytes)(const void*);
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
constexpr const char* valueTypeName() {
  if constexpr (ScalarValue<T>)
    return ScalarName<T>::value;
  else
    return T::typeName;
}

/// The description of T. T is a scalar, or has T::typeName and, by argument-dependent look-up,
/// hashValue(Hasher&, const T&) and byteSize(const T&).
template <class T>
const ValueType& valueType() {
  static const ValueType type{valueTypeName<T>(),
                              [](const void* p) {
                                Hasher hasher;
                                hasher.add(std::string_view(valueTypeName<T>()));
                                if constexpr (std::is_same_v<T, std::string>)
                                  hasher.add(std::string_view(*static_cast<const T*>(p)));
                                else if constexpr (ScalarValue<T>)
                                  hasher.add(*static_cast<const T*>(p));
                                else
                                  hashValue(hasher, *static_cast<const T*>(p));
                                return hasher.digest();
                              },
                              [](const void* p) -> std::size_t {
                                if constexpr (ScalarValue<T>)
                                  return sizeof(T);
                                else
                                  return byteSize(*static_cast<const T*>(p));
                              }};
  return type;
}

/// An immutable, shared value; empty where a node left an output unset.
class Value {
 public:
  Value() = default;
  template <class T>
  static Value of(std::shared_ptr<const T> data) {
    Value v;
    v.data_ = std::move(data);
    v.type_ = &valueType<T>();
    return v;
  }

  bool empty() const { return data_ == nullptr; }
  const ValueType& type() const { return *type_; }
  Digest digest() const { return type_->digest(data_.get()); }
  std::size_t bytes() const { return type_->bytes(data_.get()); }
  /// Equal for values that share their data.
  const void* address() const { return data_.get(); }

  /// The value as T, or null where it is something else or empty.
  template <class T>
  std::shared_ptr<const T> as() const {
    if (empty() || type_->name != valueTypeName<T>()) return nullptr;
    return std::static_pointer_cast<const T>(data_);
  }

 private:
  std::shared_ptr<const void> data_;
  const ValueType* type_ = nullptr;
};

}  // namespace sherd
