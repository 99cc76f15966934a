// The bytes that a value is kept as on disk: little-endian numbers, lengths before arrays, nothing else. The
// store around them knows type, version and checksum (eval/disk_store.h), so a reader that comes here meets
// what a writer of the same version wrote; it checks lengths all the same.
//
// A value that holds another by shared_ptr writes it as a part: an entry of its own under its own digest. So
// the tetrahedra that five results share are on disk once, and are shared again after loading.
//
//   void saveValue(ArchiveWriter& to, const Sites& sites);
//   std::optional<Sites> loadValue(ArchiveReader& from, std::type_identity<Sites>);
// found by argument-dependent look-up, with Sites::archiveVersion, which is raised whenever the bytes change.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/hash.h"

namespace sherd {

struct ValueType;

static_assert(std::endian::native == std::endian::little, "archives are little-endian");

/// A value that another one holds.
struct ArchivePart {
  const ValueType* type = nullptr;
  std::shared_ptr<const void> data;
  Digest digest;
};

class ArchiveWriter {
 public:
  /// Numbers, booleans and enumerations.
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void put(T number) { raw(&number, sizeof number); }
  void put(const Digest& digest) { raw(&digest, sizeof digest); }
  void text(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    raw(text.data(), text.size());
  }
  /// Arrays of values without padding and without pointers (numbers, fixed-size vectors, index tuples).
  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(std::is_trivially_destructible_v<T>);
    put(static_cast<std::uint64_t>(values.size()));
    raw(values.data(), values.size() * sizeof(T));
  }
  void raw(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  /// Null is kept as null. Defined in base/value_type.h.
  template <class T>
  void part(const std::shared_ptr<const T>& value);

  const std::string& bytes() const { return bytes_; }
  const std::vector<ArchivePart>& parts() const { return parts_; }

 private:
  std::string bytes_;
  std::vector<ArchivePart> parts_;
};

/// Where a reader finds parts: the value of this type and digest, or null.
using PartSource = std::function<std::shared_ptr<const void>(const ValueType& type, const Digest& digest)>;

/// After the first thing that can't be read, everything reads as zero or empty and ok() is false.
class ArchiveReader {
 public:
  ArchiveReader(std::string_view bytes, PartSource parts) : bytes_(bytes), parts_(std::move(parts)) {}

  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) T get() {
    if constexpr (std::is_same_v<T, bool>) {
      const auto byte = get<std::uint8_t>();
      if (byte > 1) fail();
      return byte == 1;
    } else {
      T number{};
      raw(&number, sizeof number);
      return number;
    }
  }
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void get(T& number) { number = get<T>(); }
  Digest digest() {
    Digest digest;
    raw(&digest, sizeof digest);
    return digest;
  }
  std::string text() {
    const std::size_t size = length(1);
    std::string text(bytes_.substr(at_, size));
    at_ += size;
    return text;
  }
  template <class T>
  void array(std::vector<T>& values) {
    values.resize(length(sizeof(T)));
    raw(values.data(), values.size() * sizeof(T));
  }
  void raw(void* data, std::size_t size) {
    if (size > bytes_.size() - at_) return fail();
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  /// A part that can't be had is a failure; one that was written as null is null. Defined in
  /// base/value_type.h.
  template <class T>
  std::shared_ptr<const T> part();

  bool ok() const { return ok_; }
  std::size_t remaining() const { return bytes_.size() - at_; }  ///< bytes
  bool atEnd() const { return at_ == bytes_.size(); }
  /// For a loader that finds something wrong itself.
  void fail() {
    ok_ = false;
    at_ = bytes_.size();
  }

 private:
  /// The length of an array, checked against the bytes that are left.
  std::size_t length(std::size_t elementSize) {
    const auto size = get<std::uint64_t>();
    if (size <= (bytes_.size() - at_) / elementSize) return size;
    fail();
    return 0;
  }

  std::string_view bytes_;
  PartSource parts_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace sherd
