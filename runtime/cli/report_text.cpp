#include "cli/report_text.h"

#include <fmt/format.h>

#include <vector>

namespace sherd {
namespace {

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

std::vector<std::string_view> charactersOf(std::string_view text) {
  std::vector<std::string_view> characters;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin + 1;
    while (end < text.size() && continues(text[end])) ++end;
    characters.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return characters;
}

/// In UTF-8 what is wide starts about at U+1100, which three bytes encode from 0xe1 on; the signs and dashes
/// of U+2000 to U+2DFF, which begin with 0xe2, are not.
bool isWide(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character.front());
  return lead >= 0xe1 && lead != 0xe2;
}

}  // namespace

std::string htmlEscaped(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

std::string byteText(std::uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  auto value = static_cast<double>(bytes);
  const char* unit = "";
  for (const char* next : {"kB", "MB", "GB", "TB", "PB", "EB"}) {
    value /= 1000;
    unit = next;
    if (value < 999.5) break;
  }
  return value < 9.95 ? fmt::format("{:.1f} {}", value, unit) : fmt::format("{:.0f} {}", value, unit);
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

int shownLength(std::string_view text) {
  int length = 0;
  for (const std::string_view character : charactersOf(text)) length += isWide(character) ? 2 : 1;
  return length;
}

double widthInEms(std::string_view text) {
  double width = 0;
  for (const std::string_view character : charactersOf(text)) {
    const char c = character.front();
    const auto isOneOf = [c](std::string_view set) { return set.find(c) != std::string_view::npos; };
    if (character.size() > 1)
      width += isWide(character) ? 1.05 : 0.75;
    else if (isOneOf("ijl.,:;'|!()[]ftr/ -I"))
      width += 0.42;
    else if (isOneOf("mwMW@%=<>+~#_&^"))
      width += 0.95;
    else
      width += c >= 'A' && c <= 'Z' ? 0.76 : 0.635;
  }
  return width;
}

std::string elided(const std::string& text, int most) {
  if (shownLength(text) <= most) return text;
  const auto characters = charactersOf(text);
  std::string head, tail;
  int room = most - 1, length = 0;
  for (std::size_t i = 0; i < characters.size() && length < (room + 1) / 2; ++i) {
    head += characters[i];
    length += isWide(characters[i]) ? 2 : 1;
  }
  for (std::size_t i = characters.size(); i-- > 0 && length < room;) {
    tail.insert(0, characters[i]);
    length += isWide(characters[i]) ? 2 : 1;
  }
  return head + "…" + tail;
}

}  // namespace sherd
