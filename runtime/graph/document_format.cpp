#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "graph/document.h"

namespace sherd {
namespace {

/// Characters, not bytes.
std::size_t widthOf(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool isContainer(const DocumentValue& value) { return value.isObject || value.isList; }

constexpr std::size_t kAnyWidth = std::numeric_limits<std::size_t>::max();

/// The value on one line; nothing where it holds comments or blank lines, or is longer than `room`.
std::optional<std::string> flat(const DocumentValue& value, std::size_t room) {
  if (!isContainer(value)) return widthOf(value.text) <= room ? std::optional(value.text) : std::nullopt;
  if (value.entries.empty() && value.atStart.empty() && value.atEnd.empty())
    return value.isList ? "[]" : "{}";
  if (!value.atStart.empty() || !value.atEnd.empty()) return std::nullopt;
  std::string text = value.isList ? "[" : "{ ";
  std::size_t width = 2 * text.size();  // with the closing bracket
  for (const DocumentEntry& entry : value.entries) {
    const bool isFirst = &entry == value.entries.data();
    if (!entry.before.empty() || !entry.after.empty() || (entry.blankBefore && !isFirst)) return std::nullopt;
    const auto inner = flat(entry.value, room);
    if (!inner) return std::nullopt;
    const std::string key = (isFirst ? "" : ", ") + (entry.keyText.empty() ? "" : entry.keyText + ": ");
    width += widthOf(key) + widthOf(*inner);
    if (width > room) return std::nullopt;
    text += key + *inner;
  }
  return text + (value.isList ? "]" : " }");
}

/// Something in a column of the text as it was typed.
struct Placed {
  int column = 0, gap = 0;
};

/// The column that these were lined up in: that of most of them where one is there by more than the usual
/// gap, else that of all. Nothing where there is none.
std::optional<int> columnOf(const std::vector<Placed>& places, int usualGap) {
  struct Column {
    std::size_t count = 0;
    bool isWide = false;
  };
  std::map<int, Column> columns;
  for (const Placed& place : places) {
    Column& column = columns[place.column];
    ++column.count;
    column.isWide = column.isWide || place.gap > usualGap;
  }
  for (const auto& [at, column] : columns)
    if (column.count == places.size() || (column.isWide && 2 * column.count > places.size())) return at;
  return std::nullopt;
}

bool areLinedUp(const std::vector<Placed>& places, int usualGap) {
  const auto column = columnOf(places, usualGap);
  return column && std::any_of(places.begin(), places.end(), [&](const Placed& place) {
           return place.column == *column && place.gap > usualGap;
         });
}

bool isOnOneLine(const DocumentComment& comment) { return comment.text.find('\n') == std::string::npos; }

/// Whether it was typed in the form that Hanging writes, whatever its width.
bool hangs(const DocumentValue& value) {
  if (value.entries.size() < 2 || !value.atStart.empty() || !value.atEnd.empty()) return false;
  if (value.entries.front().newLine || !value.entries.back().after.empty()) return false;
  for (const DocumentEntry& entry : value.entries) {
    if (!entry.before.empty() || entry.blankBefore) return false;
    if (!std::all_of(entry.after.begin(), entry.after.end(), isOnOneLine)) return false;
    if (!flat(entry.value, kAnyWidth) && !hangs(entry.value)) return false;
  }
  return std::any_of(value.entries.begin() + 1, value.entries.end(),
                     [](const DocumentEntry& entry) { return entry.newLine; });
}

/// Whether it was typed on one line, and may hang where that is too long.
bool mayHang(const DocumentValue& value) {
  return value.entries.size() > 1 && !value.entries.front().newLine && flat(value, kAnyWidth);
}

/// Writes values that hang: the first entry behind the bracket and the others below that, on new lines where
/// they were so or don't fit:
///     "hit": { "type": "Simulate@1", "in": { "body": "tets" },
///              "params": { "drop_height": 1 } }
class Hanging {
 public:
  /// `column` is where the text begins, from 0, and `after` how many characters stand behind it.
  Hanging(const DocumentValue& value, std::size_t column, std::size_t after) : start_(column) {
    write(value, after);
  }
  /// Nothing where a line is too long, comments behind it aside.
  std::optional<std::string> text() const { return fits_ ? std::optional(text_) : std::nullopt; }

 private:
  void write(const DocumentValue& value, std::size_t after) {
    text_ += value.isObject ? "{ " : "[";
    const std::size_t inner = column(), closing = (value.isObject ? 2 : 1) + after;
    for (const DocumentEntry& entry : value.entries) {
      const bool isLast = &entry == &value.entries.back();
      const std::string key = entry.keyText.empty() ? "" : entry.keyText + ": ";
      const auto fitting = [&](std::size_t from) {
        const std::size_t used = from + widthOf(key) + (isLast ? closing : 1);
        return flat(entry.value, used < Document::kLongestLine ? Document::kLongestLine - used : 0);
      };
      const bool isFirst = &entry == value.entries.data();
      if (!isFirst)
        text_ += entry.newLine || !(&entry - 1)->after.empty() || !fitting(column() + 1)
                     ? '\n' + std::string(inner, ' ')
                     : " ";
      const auto oneLine = fitting(column());
      text_ += key;
      if (oneLine)
        text_ += *oneLine;
      else if (hangs(entry.value) || mayHang(entry.value))
        write(entry.value, isLast ? closing : 1);
      else
        fits_ = false;
      if (!isLast) text_ += ',';
      for (const DocumentComment& comment : entry.after) text_ += "  " + comment.text;
    }
    text_ += value.isObject ? " }" : "]";
  }

  std::size_t column() const {
    const std::size_t line = text_.rfind('\n');
    return line == std::string::npos ? start_ + widthOf(text_)
                                     : widthOf(std::string_view(text_).substr(line + 1));
  }

  std::string text_;
  const std::size_t start_;
  bool fits_ = true;
};

class Writer {
 public:
  void comments(const std::vector<DocumentComment>& list, std::size_t depth, bool& isFirst) {
    for (const DocumentComment& comment : list) {
      line(depth, comment.blankBefore && !isFirst);
      text_ += comment.text;
      isFirst = false;
    }
  }

  void value(const DocumentValue& value, std::size_t depth, std::size_t after, bool isLinedUp = false) {
    const std::size_t column = widthOf(std::string_view(text_).substr(text_.rfind('\n') + 1));
    const std::size_t used = column + after;
    const std::size_t room = used < Document::kLongestLine ? Document::kLongestLine - used : 0;
    std::optional<std::string> text;
    if (!isContainer(value))
      text = value.text;
    else if (!isSection(value, depth))
      text = flat(value, room);
    if (!text && !isSection(value, depth) && (hangs(value) || (isLinedUp && mayHang(value))))
      text = Hanging(value, column, after).text();
    if (text)
      text_ += *text;
    else
      lines(value, depth);
  }

  /// Comments behind something, on its line as far as a comment up to the end of the line allows it.
  void trailing(const std::vector<DocumentComment>& list, std::size_t depth) {
    bool endsLine = false;
    for (const DocumentComment& comment : list) {
      if (endsLine)
        line(depth, false);
      else
        text_ += "  ";
      text_ += comment.text;
      endsLine = endsLine || comment.text.starts_with("//");
    }
  }

  /// Begins a line, after an empty one if `blank`.
  void line(std::size_t depth, bool blank) {
    if (!text_.empty()) text_ += blank ? "\n\n" : "\n";
    text_.append(2 * depth, ' ');
  }

  std::string& text() { return text_; }

 private:
  /// The root, and what holds objects right below it: read by eye, one entry a line.
  static bool isSection(const DocumentValue& value, std::size_t depth) {
    if (value.entries.empty() || !value.isObject) return false;
    return depth == 0 || (depth == 1 && std::any_of(value.entries.begin(), value.entries.end(),
                                                    [](const DocumentEntry& e) { return e.value.isObject; }));
  }

  void lines(const DocumentValue& value, std::size_t depth) {
    text_ += value.isObject ? '{' : '[';
    trailing(value.atStart, depth + 1);
    const std::vector<std::size_t> keyWidths = widthsOfKeys(value);
    std::vector<Commented> commented;
    bool isFirst = true;
    for (const DocumentEntry& entry : value.entries) {
      comments(entry.before, depth + 1, isFirst);
      line(depth + 1, entry.blankBefore && !isFirst);
      isFirst = false;
      const std::size_t begin = text_.size();
      const bool isLast = &entry == &value.entries.back();
      const std::size_t width = keyWidths[static_cast<std::size_t>(&entry - value.entries.data())];
      if (!entry.keyText.empty()) {
        text_ += entry.keyText + ": ";
        text_.append(width - std::min(width, widthOf(entry.keyText)), ' ');
      }
      this->value(entry.value, depth + 1, isLast ? 0 : 1, width > 0);
      if (!isLast) text_ += ',';
      if (!entry.after.empty() && text_.find('\n', begin) == std::string::npos) {
        const DocumentComment& comment = entry.after.front();
        commented.push_back(
            {text_.size(), widthOf(std::string_view(text_).substr(begin)), {comment.column, comment.gap}});
      }
      trailing(entry.after, depth + 1);
    }
    lineUp(commented);
    comments(value.atEnd, depth + 1, isFirst);
    line(depth, false);
    text_ += value.isObject ? '}' : ']';
  }

  /// Entries [begin, end) without an empty line between them.
  struct Group {
    std::size_t begin = 0, end = 0, width = 0;  ///< of the longest key
    std::vector<Placed> values;
  };

  static std::vector<Group> groupsOf(const DocumentValue& value) {
    std::vector<Group> groups;
    for (std::size_t i = 0; i < value.entries.size(); ++i) {
      const DocumentEntry& entry = value.entries[i];
      const bool isBlank = entry.blankBefore ||
                           std::any_of(entry.before.begin(), entry.before.end(),
                                       [](const DocumentComment& comment) { return comment.blankBefore; });
      if (groups.empty() || isBlank) groups.push_back({i, i, 0, {}});
      Group& group = groups.back();
      group.end = i + 1;
      group.width = std::max(group.width, widthOf(entry.keyText));
      group.values.push_back({entry.column, entry.gap});
    }
    return groups;
  }

  /// What the key of each entry is filled up to; 0 where its value was not lined up with others: with all of
  /// the object, or else with those of its group.
  static std::vector<std::size_t> widthsOfKeys(const DocumentValue& value) {
    std::vector<std::size_t> widths(value.entries.size(), 0);
    if (!value.isObject) return widths;
    const std::vector<Group> groups = groupsOf(value);
    std::size_t longest = 0;
    bool isOneColumn = true, isWide = false;
    for (const Group& group : groups) {
      longest = std::max(longest, group.width);
      const auto column = columnOf(group.values, 1);
      isOneColumn = isOneColumn && column && column == columnOf(groups.front().values, 1);
      isWide = isWide || areLinedUp(group.values, 1);
    }
    for (const Group& group : groups)
      for (std::size_t i = group.begin; i < group.end; ++i)
        widths[i] = isOneColumn && isWide ? longest : areLinedUp(group.values, 1) ? group.width : 0;
    return widths;
  }

  /// An entry on one line with a comment behind it.
  struct Commented {
    std::size_t at = 0, width = 0;  ///< where the gap before the comment is in the text; characters before it
    Placed place;
  };

  void lineUp(const std::vector<Commented>& commented) {
    std::vector<Placed> places;
    std::size_t width = 0;
    for (const Commented& line : commented) {
      places.push_back(line.place);
      width = std::max(width, line.width);
    }
    if (commented.empty() || !areLinedUp(places, 2)) return;
    std::string text;
    std::size_t from = commented.front().at;
    const std::size_t begin = from;
    for (const Commented& line : commented) {
      text.append(text_, from, line.at - from).append(width - line.width, ' ');
      from = line.at;
    }
    text_.replace(begin, std::string::npos, text.append(text_, from));
  }

  std::string text_;
};

}  // namespace

std::string Document::formatted() const {
  Writer writer;
  bool isFirst = true;
  writer.comments(root_.before, 0, isFirst);
  writer.line(0, root_.blankBefore && !isFirst);
  writer.value(root_.value, 0, 0);
  writer.trailing(root_.after, 0);
  isFirst = false;
  writer.comments(end_, 0, isFirst);
  return writer.text() + '\n';
}

}  // namespace sherd
