#include "cli/text_table.h"

#include <algorithm>

namespace sherd {
namespace {

/// Characters, not bytes: units such as m³ take more of the latter.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::vector<std::size_t> columnWidths(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows)
    for (std::size_t c = 0; c + 1 < row.size(); ++c) {
      if (widths.size() <= c) widths.push_back(0);
      widths[c] = std::max(widths[c], widthOf(row[c]));
    }
  return widths;
}

/// Appends `text` to `line`, whose last line is `indent` characters wide, and breaks it between words.
void appendWrapped(std::string& line, const std::string& text, std::size_t indent, std::size_t right) {
  std::size_t column = indent;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (column > indent && column + 1 + widthOf(word) > right) {
      line += '\n' + std::string(indent, ' ') + word;
      column = indent + widthOf(word);
    } else {
      line += (begin == 0 ? "" : " ") + word;
      column += (begin == 0 ? 0 : 1) + widthOf(word);
    }
    begin = end + 1;
  }
}

}  // namespace

void printTable(const std::vector<Row>& rows, int width, std::ostream& out) {
  const std::vector<std::size_t> widths = columnWidths(rows);
  for (const Row& row : rows) {
    std::string line = "  ";
    for (std::size_t c = 0; c + 1 < row.size(); ++c)
      line += row[c] + std::string(widths[c] - widthOf(row[c]) + 2, ' ');
    const std::size_t indent = widthOf(line);
    const auto right = std::max<std::size_t>(indent + 30, static_cast<std::size_t>(std::max(width, 40)));
    appendWrapped(line, row.back(), indent, right);
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  }
}

}  // namespace sherd
