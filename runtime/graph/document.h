// A JSON file as text: where each part of it stands, with its comments, so that it can be laid out anew or
// changed in places without touching the rest.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graph/diagnostics.h"
#include "graph/json_scanner.h"

namespace sherd {

/// A comment, or what stands before or after one.
struct DocumentComment {
  std::string text;
  bool blankBefore = false;  ///< at least one empty line is before it
  int column = 0;            ///< from 1, in characters
  int gap = 0;               ///< characters between it and what stands before it on its line
};

struct DocumentEntry;

struct DocumentValue {
  std::size_t begin = 0, end = 0;  ///< its bytes in the text
  std::string text;                ///< of what is no object or list: as it was typed
  bool isObject = false, isList = false;
  std::vector<DocumentEntry> entries;
  std::vector<DocumentComment> atStart;  ///< on the line of the opening bracket
  std::vector<DocumentComment> atEnd;    ///< before the closing bracket

  /// The member's entry, or null.
  const DocumentEntry* find(std::string_view key) const;
};

/// An object's member or a list's item.
struct DocumentEntry {
  std::string key, keyText;              ///< decoded, and as it was typed; empty in a list
  std::size_t keyBegin = 0, keyEnd = 0;  ///< the key's bytes
  std::vector<DocumentComment> before;   ///< on lines of their own
  bool blankBefore = false;
  bool newLine = false;  ///< begins on another line than what is before it
  int column = 0;        ///< of the value, from 1, in characters; 0 where it isn't on the line of its key
  int gap = 0;           ///< characters between the colon and it
  DocumentValue value;
  std::vector<DocumentComment> after;  ///< on the line of its end
};

class Document {
 public:
  /// Reads the text; the errors of parseJson() are reported, and then it is not usable. O(n).
  Document(std::string text, const SourcePtr& source, Diagnostics& diagnostics);

  const std::string& text() const { return text_; }
  const DocumentValue& root() const { return root_.value; }

  /// Laid out anew: two spaces a level, short objects and lists on one line of at most kLongestLine
  /// characters; comments, order, numbers and blank lines (one at most) are kept. So is what was lined up by
  /// hand: values (of an object, or between its empty lines) and comments behind them, where most begin in
  /// one column; and objects and lists that begin on the line of their bracket and go on below their first
  /// entry. Content is unchanged, and doing it again changes nothing.
  std::string formatted() const;
  static constexpr std::size_t kLongestLine = 120;

 private:
  std::string text_;
  DocumentEntry root_;
  std::vector<DocumentComment> end_;  ///< behind all
};

/// A replacement of some bytes of a text.
struct TextEdit {
  std::size_t begin = 0, end = 0;
  std::string text;
};
/// The text with all edits made, which don't overlap.
std::string withEdits(const std::string& text, std::vector<TextEdit> edits);

}  // namespace sherd
