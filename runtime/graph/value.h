// Type-erased values on wires.
#pragma once

#include <memory>
#include <utility>

#include "base/value_type.h"

namespace sherd {

/// An immutable, shared value; empty where a node left an output unset.
class Value {
 public:
  Value() = default;
  Value(const ValueType& type, std::shared_ptr<const void> data) : data_(std::move(data)), type_(&type) {}
  template <class T>
  static Value of(std::shared_ptr<const T> data) {
    return {valueType<T>(), std::move(data)};
  }

  bool empty() const { return data_ == nullptr; }
  const ValueType& type() const { return *type_; }
  Digest digest() const { return sharedDigest(*type_, data_); }
  std::size_t bytes() const { return type_->bytes(data_.get()); }
  /// Equal for values that share their data.
  const void* address() const { return data_.get(); }
  const std::shared_ptr<const void>& data() const { return data_; }

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
