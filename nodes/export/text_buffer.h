// Numbers and words appended to one string, without locale and without streams.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "types/vec.h"

namespace sherd {

class TextBuffer {
 public:
  TextBuffer& operator<<(std::string_view text) {
    text_.append(text);
    return *this;
  }
  TextBuffer& operator<<(char c) {
    text_.push_back(c);
    return *this;
  }
  TextBuffer& operator<<(std::int64_t number) { return append(number); }
  /// The fewest digits that read back as the same double; −0 as 0.
  TextBuffer& operator<<(double number) { return append(number + 0.0); }

  /// "key x y z\n"
  template <int N>
  TextBuffer& row(std::string_view key, const Eigen::Matrix<double, N, 1>& v) {
    *this << key;
    for (int i = 0; i < N; ++i) *this << ' ' << v[i];
    return *this << '\n';
  }
  /// A number's bytes, little-endian (which is the byte order of all machines that this runs on).
  template <class T>
  TextBuffer& binary(T number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    text_.append(bytes, sizeof number);
    return *this;
  }
  void reserve(std::size_t bytes) { text_.reserve(bytes); }
  std::string take() { return std::move(text_); }

 private:
  template <class T>
  TextBuffer& append(T number) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    text_.append(digits, end);
    return *this;
  }

  std::string text_;
};

}  // namespace sherd
