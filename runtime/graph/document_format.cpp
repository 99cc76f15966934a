#include <algorithm>
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

/// The value on one line; nothing where it holds comments or blank lines, or is longer than `room`.
std::optional<std::string> flat(const DocumentValue& value, std::size_t room) {
  if (!isContainer(value)) return value.text;
  if (!value.atStart.empty() || !value.atEnd.empty()) return std::nullopt;
  std::string text;
  for (const DocumentEntry& entry : value.entries) {
    const bool isFirst = text.empty();
    if (!entry.before.empty() || !entry.after.empty() || (entry.blankBefore && !isFirst)) return std::nullopt;
    const auto inner = flat(entry.value, room);
    if (!inner) return std::nullopt;
    text += (isFirst ? "" : ", ") + (entry.keyText.empty() ? "" : entry.keyText + ": ") + *inner;
    if (widthOf(text) > room) return std::nullopt;
  }
  if (value.isList) return '[' + text + ']';
  return text.empty() ? "{}" : "{ " + text + " }";
}

class Writer {
 public:
  void comments(const std::vector<DocumentComment>& list, std::size_t depth, bool& isFirst) {
    for (const DocumentComment& comment : list) {
      line(depth, comment.blankBefore && !isFirst);
      text_ += comment.text;
      isFirst = false;
    }
  }

  void value(const DocumentValue& value, std::size_t depth, std::size_t after) {
    const std::size_t column = widthOf(std::string_view(text_).substr(text_.rfind('\n') + 1));
    const std::size_t used = column + after;
    const std::size_t room = used < Document::kLongestLine ? Document::kLongestLine - used : 0;
    const auto oneLine = isSection(value, depth) ? std::nullopt : flat(value, room);
    if (oneLine && (!isContainer(value) || widthOf(*oneLine) <= room || value.entries.empty()))
      text_ += *oneLine;
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
    bool isFirst = true;
    for (std::size_t i = 0; i < value.entries.size(); ++i) {
      const DocumentEntry& entry = value.entries[i];
      comments(entry.before, depth + 1, isFirst);
      line(depth + 1, entry.blankBefore && !isFirst);
      isFirst = false;
      const bool isLast = i + 1 == value.entries.size();
      if (!entry.keyText.empty()) text_ += entry.keyText + ": ";
      this->value(entry.value, depth + 1, isLast ? 0 : 1);
      if (!isLast) text_ += ',';
      trailing(entry.after, depth + 1);
    }
    comments(value.atEnd, depth + 1, isFirst);
    line(depth, false);
    text_ += value.isObject ? '}' : ']';
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
