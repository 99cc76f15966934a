#include "base/line_diff.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sherd {
namespace {

using Lines = std::vector<std::string_view>;

constexpr std::size_t kContext = 3;
constexpr std::size_t kLargestTable = 4000000;

struct Line {
  char sign;  ///< ' ', '-' or '+'
  std::string_view text;
};

Lines linesOf(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// Longest common subsequence of what lies between equal beginnings and ends.
void compareMiddle(const Lines& a, const Lines& b, std::vector<Line>& result) {
  const std::size_t n = a.size(), m = b.size();
  const bool isSmall = n == 0 || m <= kLargestTable / n;
  std::vector<std::uint32_t> longest(isSmall ? (n + 1) * (m + 1) : 0, 0);
  auto at = [&](std::size_t i, std::size_t j) -> std::uint32_t& { return longest[i * (m + 1) + j]; };
  if (isSmall)
    for (std::size_t i = n; i-- > 0;)
      for (std::size_t j = m; j-- > 0;)
        at(i, j) = a[i] == b[j] ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
  std::size_t i = 0, j = 0;
  while (i < n || j < m) {
    if (isSmall && i < n && j < m && a[i] == b[j]) {
      result.push_back({' ', a[i]});
      ++i, ++j;
    } else if (i < n && (j == m || !isSmall || at(i + 1, j) >= at(i, j + 1))) {
      result.push_back({'-', a[i++]});
    } else {
      result.push_back({'+', b[j++]});
    }
  }
}

std::vector<Line> compare(const Lines& before, const Lines& after) {
  const std::size_t shorter = std::min(before.size(), after.size());
  std::size_t front = 0, back = 0;
  while (front < shorter && before[front] == after[front]) ++front;
  while (back < shorter - front && before[before.size() - 1 - back] == after[after.size() - 1 - back]) ++back;
  std::vector<Line> result;
  for (std::size_t i = 0; i < front; ++i) result.push_back({' ', before[i]});
  auto middle = [&](const Lines& lines) {
    return Lines(lines.begin() + static_cast<std::ptrdiff_t>(front),
                 lines.end() - static_cast<std::ptrdiff_t>(back));
  };
  compareMiddle(middle(before), middle(after), result);
  for (std::size_t i = before.size() - back; i < before.size(); ++i) result.push_back({' ', before[i]});
  return result;
}

std::string range(std::size_t first, std::size_t count) {
  return std::to_string(count == 0 ? first : first + 1) + ',' + std::to_string(count);
}

}  // namespace

std::string unifiedDiff(std::string_view before, std::string_view after, const std::string& name) {
  if (before == after) return {};
  const std::vector<Line> lines = compare(linesOf(before), linesOf(after));
  std::string text = "--- " + name + "\n+++ " + name + '\n';
  std::size_t oldLine = 0, newLine = 0;
  for (std::size_t i = 0; i < lines.size();) {
    std::size_t change = i;
    while (change < lines.size() && lines[change].sign == ' ') ++change;
    if (change == lines.size()) break;
    const std::size_t begin = change - std::min(kContext, change - i);
    oldLine += begin - i;
    newLine += begin - i;
    std::size_t end = change, equal = 0;
    while (end < lines.size() && equal <= 2 * kContext) equal = lines[end++].sign == ' ' ? equal + 1 : 0;
    end -= equal > kContext ? equal - kContext : 0;
    std::string hunk;
    std::size_t olds = 0, news = 0;
    for (std::size_t k = begin; k < end; ++k) {
      hunk += lines[k].sign + std::string(lines[k].text) + '\n';
      olds += lines[k].sign != '+' ? 1 : 0;
      news += lines[k].sign != '-' ? 1 : 0;
    }
    text += "@@ -" + range(oldLine, olds) + " +" + range(newLine, news) + " @@\n" + hunk;
    oldLine += olds;
    newLine += news;
    i = end;
  }
  const bool oldEnds = before.empty() || before.back() == '\n',
             newEnds = after.empty() || after.back() == '\n';
  if (oldEnds != newEnds)
    text += std::string("\\ ") + (oldEnds ? "No newline" : "Now a newline") + " at end of file\n";
  return text;
}

}  // namespace sherd
