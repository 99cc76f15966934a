// Words and numbers of a text file, line by line, for the readers of text formats.
#pragma once

#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/result.h"

namespace sherd {

/// Walks through a text that it refers to. Lines end with LF, CR LF or CR. A word that starts with '#' begins
/// a comment up to the line's end where comments are on, any '#' where they may follow a word without a
/// blank; a
/// '\' before a line's end joins two lines where joins are on.
class TextScanner {
 public:
  enum Features : unsigned { Plain = 0, Comments = 1, Joins = 2, CloseComments = 5 };

  explicit TextScanner(std::string_view text, unsigned features = Plain)
      : at_(text.data()), end_(text.data() + text.size()), features_(features) {}

  std::size_t line() const { return line_; }  ///< counted from 1
  bool atEnd() const { return at_ == end_; }
  const char* position() const { return at_; }

  /// The next word of this line; empty at its end.
  std::string_view word() {
    skipBlanks();
    const char* start = at_;
    while (at_ != end_ && !endsWord(*at_) && !(*at_ == '#' && (features_ & kClose) != 0)) ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
  }

  /// The next word, of this line or a later one; empty at the text's end.
  std::string_view wordOnAnyLine() {
    std::string_view w = word();
    while (w.empty() && !atEnd()) {
      nextLine();
      w = word();
    }
    return w;
  }

  /// What is left of this line, without the blanks around it.
  std::string_view rest() {
    skipBlanks();
    const char* start = at_;
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    const char* stop = at_;
    while (stop != start && (stop[-1] == ' ' || stop[-1] == '\t')) --stop;
    return {start, static_cast<std::size_t>(stop - start)};
  }

  /// Goes to the start of the next line, or to the text's end.
  void nextLine() {
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') {
      if (!skipJoin()) ++at_;
    }
    if (at_ != end_) passLineEnd();
  }

  /// "line 7: what", with what would be right.
  Error error(const std::string& what, const std::string& remedy) const {
    return failure("line " + std::to_string(line_) + ": " + what, remedy);
  }

 private:
  static constexpr unsigned kClose = 4;
  static bool blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }
  static bool endsWord(char c) { return blank(c) || c == '\n' || c == '\r'; }

  void passLineEnd() {
    const bool twoCharacters = *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n';
    at_ += twoCharacters ? 2 : 1;
    ++line_;
  }
  bool skipJoin() {
    if ((features_ & Joins) == 0 || *at_ != '\\') return false;
    if (at_ + 1 == end_ || (at_[1] != '\n' && at_[1] != '\r')) return false;
    ++at_;
    passLineEnd();
    return true;
  }
  void skipBlanks() {
    while (at_ != end_) {
      if (blank(*at_)) {
        ++at_;
      } else if (!skipJoin()) {
        break;
      }
    }
    if (at_ != end_ && *at_ == '#' && (features_ & Comments) != 0) {
      while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    }
  }

  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
  unsigned features_;
};

/// The text behind a UTF-8 byte order mark, which some editors put first.
inline std::string_view withoutByteOrderMark(std::string_view text) {
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

/// Reads all of `word` as a number, correctly rounded. "nan" and "inf" are numbers; what is too large for a
/// double is infinite, what is too small is 0.
inline bool parseNumber(std::string_view word, double& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, status] = std::from_chars(word.data(), end, value);
  if (status == std::errc::invalid_argument || stop != end) return false;
  if (status == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
  return true;
}

/// Reads all of `word` as a decimal integer.
inline bool parseInteger(std::string_view word, long long& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, status] = std::from_chars(word.data(), end, value);
  return status == std::errc{} && stop == end;
}

/// What to do about a word that should be a number.
inline constexpr const char* kNumberRemedy =
    "a number such as 1.5 or 2e-3 is expected; the file may be damaged, export it again";

/// A word of the file for a message: in quotes, shortened, control characters and non-ASCII bytes as '?'.
inline std::string quoted(std::string_view word) {
  std::string text = "'";
  for (char c : word.substr(0, 40)) text += c >= 0x20 && c < 0x7f ? c : '?';
  return text + (word.size() > 40 ? "…'" : "'");
}

}  // namespace sherd
