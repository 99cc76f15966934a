#include "graph/json_scanner.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "graph/suggest.h"

namespace sherd {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isWordCharacter(char c) {
  return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '.' || c == '-';
}

void appendUtf8(std::string& out, std::uint32_t code) {
  auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | (code >> 6));
    put(0x80 | (code & 63));
  } else if (code < 0x10000) {
    put(0xE0 | (code >> 12));
    put(0x80 | ((code >> 6) & 63));
    put(0x80 | (code & 63));
  } else {
    put(0xF0 | (code >> 18));
    put(0x80 | ((code >> 12) & 63));
    put(0x80 | ((code >> 6) & 63));
    put(0x80 | (code & 63));
  }
}

/// The length of the well-formed UTF-8 sequence at the front of `text` (Unicode, table 3-7), or 0.
std::size_t utf8Length(std::string_view text) {
  auto byte = [&](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  auto follows = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return text.empty() ? 0 : 1;
  if (first < 0xC2 || first > 0xF4 || !follows(1)) return 0;
  if (first < 0xE0) return 2;
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) || !follows(2)) return 0;
  if (first < 0xF0) return 3;
  if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F) || !follows(3)) return 0;
  return 4;
}

std::string byteName(char c) {
  static constexpr char kDigits[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return {'0', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

}  // namespace

JsonScanner::JsonScanner(std::string_view text) : text_(text) {
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
}

void JsonScanner::advance() {
  const auto byte = static_cast<unsigned char>(text_[at_++]);
  if (byte == '\n') {
    ++line_;
    column_ = 1;
  } else if ((byte & 0xC0) != 0x80) {  // continuation bytes belong to a character that is counted already
    ++column_;
  }
}

void JsonScanner::skipSpace() {
  while (!atEnd() && (peek() == ' ' || peek() == '\t' || peek() == '\n' || peek() == '\r')) advance();
}

bool JsonScanner::fail(std::string what, std::string remedy) {
  error_ = {line_, column_, std::move(what), std::move(remedy)};
  return false;
}

bool JsonScanner::next(JsonToken& token) {
  skipSpace();
  token.line = line_;
  token.column = column_;
  token.begin = at_;
  token.text.clear();
  auto single = [&](Kind kind) {
    advance();
    token.kind = kind;
    return true;
  };
  bool read = true;
  if (atEnd()) {
    token.kind = Kind::End;
  } else {
    switch (const char c = peek()) {
      case '{':
        read = single(Kind::ObjectBegin);
        break;
      case '}':
        read = single(Kind::ObjectEnd);
        break;
      case '[':
        read = single(Kind::ArrayBegin);
        break;
      case ']':
        read = single(Kind::ArrayEnd);
        break;
      case ':':
        read = single(Kind::Colon);
        break;
      case ',':
        read = single(Kind::Comma);
        break;
      case '"':
        read = scanString(token);
        break;
      case '/':
        read = scanComment(token);
        break;
      default:
        read = isDigit(c) || c == '-' ? scanNumber(token) : scanWord(token);
    }
  }
  token.end = at_;
  return read;
}

bool JsonScanner::scanComment(JsonToken& token) {
  token.kind = Kind::Comment;
  if (peek(1) == '/') {
    while (!atEnd() && peek() != '\n') advance();
    return true;
  }
  if (peek(1) != '*') return fail("a stray \"/\"", "comments begin with // or /*");
  const int line = line_, column = column_;
  for (advance(), advance(); !atEnd(); advance()) {
    if (peek() != '*' || peek(1) != '/') continue;
    advance();
    advance();
    return true;
  }
  error_ = {line, column, "a comment that is not closed", "it would have to end in */"};
  return false;
}

bool JsonScanner::scanString(JsonToken& token) {
  token.kind = Kind::String;
  advance();
  while (!atEnd() && peek() != '"') {
    if (peek() == '\n' || peek() == '\r') break;
    if (!(peek() == '\\' ? scanEscape(token.text) : scanCharacter(token.text))) return false;
  }
  if (peek() != '"' || atEnd()) {
    error_ = {token.line, token.column, "a string that is not closed",
              "it would have to end in \" on this line"};
    return false;
  }
  advance();
  return true;
}

bool JsonScanner::scanCharacter(std::string& out) {
  const std::size_t length = utf8Length(text_.substr(at_));
  if (length == 0) return fail("byte " + byteName(peek()) + " is not UTF-8", "save the file as UTF-8");
  if (static_cast<unsigned char>(peek()) < 0x20)
    return fail("control character " + byteName(peek()) + " in a string",
                "write it as an escape, such as \\t");
  for (std::size_t i = 0; i < length; ++i) {
    out += peek();
    advance();
  }
  return true;
}

bool JsonScanner::scanEscape(std::string& out) {
  static constexpr std::string_view kNames = "\"\\/bfnrt", kMeanings = "\"\\/\b\f\n\r\t";
  const std::size_t known = at_ + 1 < text_.size() ? kNames.find(peek(1)) : std::string_view::npos;
  if (known != std::string_view::npos) {
    out += kMeanings[known];
    advance();
    advance();
    return true;
  }
  if (peek(1) != 'u')
    return fail("an unknown escape in a string",
                R"(a backslash is written \\; in paths, / works everywhere)");
  std::uint32_t code = 0;
  if (!scanHex4(code)) return false;
  if (code >= 0xD800 && code < 0xDC00 && peek() == '\\' && peek(1) == 'u') {
    std::uint32_t low = 0;
    if (!scanHex4(low)) return false;
    if (low < 0xDC00 || low > 0xDFFF) return fail("half of a surrogate pair", "write the character itself");
    code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
  }
  if (code >= 0xD800 && code < 0xE000) return fail("half of a surrogate pair", "write the character itself");
  if (code == 0) return fail("\\u0000 in a string", "leave it out: no name or path may hold it");
  appendUtf8(out, code);
  return true;
}

bool JsonScanner::scanHex4(std::uint32_t& code) {
  code = 0;
  const std::string_view digits = text_.substr(at_ + 2 <= text_.size() ? at_ + 2 : text_.size(), 4);
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
  if (digits.size() != 4 || problem != std::errc() || end != digits.data() + 4)
    return fail("\\u without four hexadecimal digits", "write the character itself");
  for (int i = 0; i < 6; ++i) advance();
  return true;
}

bool JsonScanner::scanDigits(std::string_view after) {
  if (!isDigit(peek()))
    return fail("no digit after " + std::string(after), "numbers look like -1, 0.5 or 2e9");
  while (isDigit(peek())) advance();
  return true;
}

bool JsonScanner::scanNumber(JsonToken& token) {
  token.kind = Kind::Integer;
  if (peek() == '-') advance();
  if (peek() == '0' && isDigit(peek(1))) return fail("a number with a leading zero", "leave the zero out");
  if (!scanDigits("the sign")) return false;
  if (peek() == '.') {
    token.kind = Kind::Real;
    advance();
    if (!scanDigits("the decimal point")) return false;
  }
  if (peek() == 'e' || peek() == 'E') {
    token.kind = Kind::Real;
    advance();
    if (peek() == '+' || peek() == '-') advance();
    if (!scanDigits("the exponent")) return false;
  }
  if (!atEnd() && isWordCharacter(peek()))
    return fail("a number with something stuck to it",
                "numbers carry no unit; strings stand in double quotes");
  const char* begin = text_.data() + token.begin;
  const char* end = text_.data() + at_;
  if (token.kind == Kind::Integer && std::from_chars(begin, end, token.integer).ec == std::errc())
    return true;
  token.kind = Kind::Real;
  const auto problem = std::from_chars(begin, end, token.real).ec;
  if (problem == std::errc()) return true;
  // Out of range is either too small, which rounds to zero, or too large.
  const std::string copy(begin, end);
  token.real = std::strtod(copy.c_str(), nullptr);
  if (std::isfinite(token.real)) return true;
  error_ = {token.line, token.column, "a number that is too large", "the largest is about 1.8e308"};
  return false;
}

bool JsonScanner::scanWord(JsonToken& token) {
  std::size_t length = 0;
  while (at_ + length < text_.size() && isWordCharacter(peek(length))) ++length;
  const std::string_view word = text_.substr(at_, length);
  if (word == "true")
    token.kind = Kind::True;
  else if (word == "false")
    token.kind = Kind::False;
  else if (word == "null")
    token.kind = Kind::Null;
  else if (length == 0)
    return failAtByte();
  else
    return fail("unexpected word " + inQuotes(word), "strings and keys stand in double quotes");
  for (std::size_t i = 0; i < length; ++i) advance();
  return true;
}

bool JsonScanner::failAtByte() {
  if (peek() == '\'') return fail("a single quotation mark", "strings and keys stand in double quotes");
  if (peek() == '+') return fail("a number with a plus sign", "leave the sign out");
  const std::size_t length = utf8Length(text_.substr(at_));
  if (length == 0) return fail("byte " + byteName(peek()) + " is not UTF-8", "this is no graph file");
  if (static_cast<unsigned char>(peek()) < 0x20 || peek() == 0x7F)
    return fail("unexpected byte " + byteName(peek()), "this is no graph file");
  return fail("unexpected " + inQuotes(text_.substr(at_, length)), "strings and keys stand in double quotes");
}

}  // namespace sherd
