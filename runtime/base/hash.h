// Content digests: 128 bits of XXH3 (xxHash). Equal content gives equal digests on every machine of one byte
// order; collisions are as likely as a 128-bit hash makes them, and nobody is assumed to forge any.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sherd {

struct Digest {
  std::uint64_t high = 0, low = 0;
  friend auto operator<=>(const Digest&, const Digest&) = default;
  std::string hex() const;  ///< 32 lower-case hexadecimal digits
};

/// Of `size` bytes alone: to find damage in what was written before. O(size).
std::uint64_t checksum64(const void* data, std::size_t size);
Digest checksum128(const void* data, std::size_t size);

/// Feeds bytes into one digest. Every `add` also feeds the length, so that ("ab","c") differs from
/// ("a","bc").
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  Hasher& bytes(const void* data, std::size_t size);
  Hasher& add(std::string_view text) { return bytes(text.data(), text.size()); }
  Hasher& add(const Digest& d) { return bytes(&d, sizeof d); }
  /// Numbers by their bits; −0 counts as +0.
  Hasher& add(double number) {
    number += 0.0;
    return bytes(&number, sizeof number);
  }
  template <class T>
  requires std::is_integral_v<T> Hasher& add(T number) {
    const auto wide = static_cast<std::int64_t>(number);
    return bytes(&wide, sizeof wide);
  }
  /// Arrays of values without padding (numbers, vectors of numbers, index tuples), by their bytes.
  template <class T>
  Hasher& add(const std::vector<T>& values) {
    static_assert(std::is_trivially_destructible_v<T>);
    return bytes(values.data(), values.size() * sizeof(T));
  }
  Digest digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Digest of a digest followed by bytes, without a Hasher's set-up.
Digest digestOf(const Digest& first, std::span<const std::byte> rest);

}  // namespace sherd

template <>
struct std::hash<sherd::Digest> {
  std::size_t operator()(const sherd::Digest& d) const noexcept { return static_cast<std::size_t>(d.low); }
};
