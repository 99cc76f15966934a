#include "graph/name_rule.h"

#include <algorithm>

namespace sherd {
namespace {

/// One character that is a blank: a space, or one of Unicode's (U+00A0, U+2000 to U+200A, U+3000).
bool isBlank(std::string_view character) {
  if (character == " " || character == "\xC2\xA0" || character == "\xE3\x80\x80") return true;
  return character.size() == 3 && character.starts_with("\xE2\x80") &&
         static_cast<unsigned char>(character[2]) <= 0x8A;
}

/// Blanks take one to three bytes.
bool hasBlankEnd(std::string_view text) {
  for (std::size_t length = 1; length <= 3 && length <= text.size(); ++length)
    if (isBlank(text.substr(0, length)) || isBlank(text.substr(text.size() - length))) return true;
  return false;
}

/// U+0000 to U+001F, U+007F, and U+0080 to U+009F, which take two bytes.
bool hasControlCharacter(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 || byte == 0x7F) return true;
    if (byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0) return true;
  }
  return false;
}

}  // namespace

const char* const kNameRule =
    "a name holds letters, digits, spaces and signs, but none of . / @ $ { } : = \" ', and no space at its "
    "ends";

bool isName(std::string_view text) {
  return !text.empty() && !hasBlankEnd(text) && text.find_first_of("./@${}:=\"'") == std::string_view::npos &&
         !hasControlCharacter(text);
}

}  // namespace sherd
