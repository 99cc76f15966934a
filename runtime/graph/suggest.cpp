#include "graph/suggest.h"

#include <algorithm>
#include <limits>

namespace sherd {
namespace {

constexpr std::size_t kLongestWord = 64;  // longer ones are not typing errors, and would cost quadratic time
constexpr std::size_t kMostListed = 12;

constexpr std::size_t kShortestPart = 3;  // fewer letters are in too many words to mean anything
constexpr std::size_t kLongestPart = 24;  // longer ones are not compared with the beginnings of all words

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lowered(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), lower);
  return result;
}

std::size_t largestDistance(std::string_view word) { return std::max<std::size_t>(1, word.size() / 3); }

/// Whether the candidate, cut to about the word's length, is close to it: "densty", "density_of_air". A slip
/// in the first letter is rare, and asking for it spares most of the comparisons.
bool beginsLike(std::string_view candidate, std::string_view word) {
  if (word.size() <= kShortestPart || word.size() > kLongestPart || candidate.size() <= word.size() ||
      candidate[0] != word[0])
    return false;
  const std::size_t limit = std::min<std::size_t>(largestDistance(word), 2);
  const std::size_t longest = std::min(candidate.size(), word.size() + limit);
  for (std::size_t size = word.size() - limit; size <= longest; ++size)
    if (editDistance(word, candidate.substr(0, size)) <= limit) return true;
  return false;
}

/// How much of a part word and candidate have in common; 0 is best.
enum Part { Begins, Contains, BeginsLike, MakesUp, None };

Part partOf(const std::string& word, const std::string& candidate) {
  if (word.size() < kShortestPart || candidate.size() < kShortestPart) return None;
  if (const std::size_t where = candidate.find(word); where != std::string::npos)
    return where == 0 ? Begins : Contains;
  if (beginsLike(candidate, word)) return BeginsLike;
  return 2 * candidate.size() >= word.size() && word.find(candidate) != std::string::npos ? MakesUp : None;
}

std::string withCommonPart(std::string_view word, const std::vector<std::string>& known) {
  const std::string wanted = lowered(word);
  Part best = None;
  std::string found;
  for (const std::string& candidate : known) {
    const Part part = partOf(wanted, lowered(candidate));
    if (part >= best) continue;
    best = part;
    found = candidate;
  }
  return found;
}

}  // namespace

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::string closest(std::string_view word, const std::vector<std::string>& known) {
  if (word.empty() || word.size() > kLongestWord) return {};
  const std::size_t limit = largestDistance(word);
  std::size_t best = std::numeric_limits<std::size_t>::max();
  std::string found;
  for (const std::string& candidate : known) {
    const std::size_t longer = std::max(candidate.size(), word.size());
    if (longer - std::min(candidate.size(), word.size()) > limit) continue;
    const std::size_t distance = editDistance(word, candidate);
    if (distance <= limit && distance < longer && distance < best) {
      best = distance;
      found = candidate;
    }
  }
  return found.empty() ? withCommonPart(word, known) : found;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known, std::string_view kind,
                       std::string_view command) {
  const std::string near = closest(word, known);
  if (!near.empty()) return "did you mean " + inQuotes(near) + "?";
  return listing(known, kind, command);
}

std::string listing(const std::vector<std::string>& known, std::string_view kind, std::string_view command) {
  if (known.empty()) return "there are no " + std::string(kind);
  const std::string list = "the known " + std::string(kind) + " are ";
  if (known.size() <= kMostListed) return list + quotedList(known);
  if (!command.empty()) return '`' + std::string(command) + "` lists the known " + std::string(kind);
  return list + quotedList({known.begin(), known.begin() + kMostListed}) + " and " +
         std::to_string(known.size() - kMostListed) + " more";
}

std::string quotedList(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + inQuotes(word);
  return list;
}

std::string inQuotes(std::string_view text, std::size_t longest) {
  std::string result = "\"";
  std::size_t end = std::min(text.size(), longest);
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  for (const char c : text.substr(0, end)) result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return result + (end < text.size() ? "…\"" : "\"");
}

}  // namespace sherd
