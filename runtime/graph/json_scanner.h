// Splits JSON into tokens that know their place. More than JSON allows: // and /* */ comments (yielded as
// tokens, so that a formatter can keep them) and a byte order mark. Trailing commas are the parser's
// business.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sherd {

struct JsonToken {
  enum class Kind {
    ObjectBegin,
    ObjectEnd,
    ArrayBegin,
    ArrayEnd,
    Colon,
    Comma,
    String,
    Integer,
    Real,
    True,
    False,
    Null,
    Comment,
    End
  };
  Kind kind = Kind::End;
  int line = 1, column = 1;        ///< of its first character, from 1; columns in characters
  std::size_t begin = 0, end = 0;  ///< its bytes in the text
  std::string text;                ///< of a String: its content, decoded
  std::int64_t integer = 0;        ///< of an Integer
  double real = 0;                 ///< of a Real; also of a whole number that 64 bits don't hold
};

/// Why scanning or parsing stopped, and where.
struct JsonError {
  int line = 1, column = 1;
  std::string what, remedy;
};

class JsonScanner {
 public:
  /// `text` must outlive the scanner. Any bytes will do.
  explicit JsonScanner(std::string_view text);
  /// Reads the next token; false where there is none to be read: then error() tells why. O(its length).
  bool next(JsonToken& token);
  const JsonError& error() const { return error_; }

 private:
  using Kind = JsonToken::Kind;

  bool atEnd() const { return at_ >= text_.size(); }
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  void advance();  ///< by one byte, counting lines and characters
  void skipSpace();
  bool fail(std::string what, std::string remedy = {});
  bool failAtByte();
  bool scanComment(JsonToken& token);
  bool scanString(JsonToken& token);
  bool scanEscape(std::string& out);
  bool scanHex4(std::uint32_t& code);
  bool scanCharacter(std::string& out);
  bool scanNumber(JsonToken& token);
  bool scanDigits(std::string_view after);
  bool scanWord(JsonToken& token);

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
  JsonError error_;
};

}  // namespace sherd
