#include "graph/document.h"

#include <algorithm>

#include "graph/json.h"

namespace sherd {
namespace {

using Kind = JsonToken::Kind;

/// Builds the tree. The text is known to be good JSON but for comments and trailing commas.
class Builder {
 public:
  explicit Builder(const std::string& text) : text_(text) {
    JsonScanner scanner(text);
    JsonToken token;
    while (scanner.next(token)) {
      tokens_.push_back(token);
      if (token.kind == Kind::End) break;
    }
  }

  /// `end`: comments behind all.
  DocumentEntry build(std::vector<DocumentComment>& end) {
    DocumentEntry root;
    takeComments(root.before, root.blankBefore);
    readValue(root.value, root.before);
    takeTrailing(root.after);
    while (token().kind == Kind::Comment) end.push_back(takeComment());
    return root;
  }

 private:
  const JsonToken& token() const { return tokens_[at_]; }
  void advance() {
    const JsonToken& passed = tokens_[at_];
    const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(passed.begin);
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(passed.end);
    line_ = passed.line + static_cast<int>(std::count(begin, end, '\n'));
    column_ = passed.column + static_cast<int>(characters(text_, passed));
    ++at_;
  }
  static std::size_t characters(const std::string& text, const JsonToken& token) {
    return static_cast<std::size_t>(
        std::count_if(text.begin() + static_cast<std::ptrdiff_t>(token.begin),
                      text.begin() + static_cast<std::ptrdiff_t>(token.end),
                      [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
  }
  bool blankBefore() const { return at_ > 0 && token().line > line_ + 1; }

  DocumentComment takeComment() {
    DocumentComment comment{text_.substr(token().begin, token().end - token().begin), blankBefore(),
                            token().column, token().column - column_};
    comment.text.erase(comment.text.find_last_not_of(" \t\r") + 1);
    advance();
    return comment;
  }

  /// All comments up to the next token, and whether an empty line is before that.
  void takeComments(std::vector<DocumentComment>& list, bool& blank) {
    while (token().kind == Kind::Comment) list.push_back(takeComment());
    blank = blankBefore();
  }

  /// Comments that begin on the line where the last token ended, unless more than comments follows there.
  void takeTrailing(std::vector<DocumentComment>& list) {
    std::size_t end = at_;
    int line = line_;
    while (tokens_[end].kind == Kind::Comment && tokens_[end].line == line) {
      const auto& comment = tokens_[end];
      line += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(comment.begin),
                                          text_.begin() + static_cast<std::ptrdiff_t>(comment.end), '\n'));
      ++end;
    }
    const Kind next = tokens_[end].kind;
    const bool goesOn = tokens_[end].line == line && next != Kind::End && next != Kind::ObjectEnd &&
                        next != Kind::ArrayEnd && next != Kind::Comma;
    if (goesOn) return;
    while (at_ < end) list.push_back(takeComment());
  }

  /// Comments in odd places, as between a key and its value, go before the entry.
  void takeOdd(std::vector<DocumentComment>& before) {
    while (token().kind == Kind::Comment) before.push_back(takeComment());
  }

  void readValue(DocumentValue& value, std::vector<DocumentComment>& before) {
    takeOdd(before);
    value.begin = token().begin;
    value.isObject = token().kind == Kind::ObjectBegin;
    value.isList = token().kind == Kind::ArrayBegin;
    if (value.isObject || value.isList) {
      readEntries(value);
    } else {
      value.text = text_.substr(token().begin, token().end - token().begin);
      advance();
    }
    value.end = tokens_[at_ - 1].end;
  }

  void readEntries(DocumentValue& value) {
    const Kind close = value.isObject ? Kind::ObjectEnd : Kind::ArrayEnd;
    advance();
    takeTrailing(value.atStart);
    while (true) {
      DocumentEntry entry;
      takeComments(entry.before, entry.blankBefore);
      entry.newLine = token().line > line_;
      if (token().kind == close) {
        value.atEnd = std::move(entry.before);
        break;
      }
      if (value.isObject) readKey(entry);
      readValue(entry.value, entry.before);
      takeTrailing(entry.after);
      std::vector<DocumentComment> beforeComma;
      takeOddBeforeComma(beforeComma);
      entry.after.insert(entry.after.end(), beforeComma.begin(), beforeComma.end());
      if (token().kind == Kind::Comma) {
        advance();
        takeTrailing(entry.after);
      }
      value.entries.push_back(std::move(entry));
    }
    advance();
  }

  /// Comments on lines of their own between an entry and its comma; without a comma they end the list.
  void takeOddBeforeComma(std::vector<DocumentComment>& list) {
    std::size_t end = at_;
    while (tokens_[end].kind == Kind::Comment) ++end;
    if (tokens_[end].kind == Kind::Comma) takeOdd(list);
  }

  void readKey(DocumentEntry& entry) {
    entry.key = token().text;
    entry.keyBegin = token().begin;
    entry.keyEnd = token().end;
    entry.keyText = text_.substr(token().begin, token().end - token().begin);
    advance();
    takeOdd(entry.before);
    advance();  // the colon
    if (token().line != line_ || token().kind == Kind::Comment) return;
    entry.column = token().column;
    entry.gap = token().column - column_;
  }

  const std::string& text_;
  std::vector<JsonToken> tokens_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;  ///< where the token before the next one ended, if it was in one line
};

}  // namespace

const DocumentEntry* DocumentValue::find(std::string_view key) const {
  for (const DocumentEntry& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

Document::Document(std::string text, const SourcePtr& source, Diagnostics& diagnostics)
    : text_(std::move(text)) {
  if (const auto value = parseJson(text_, source, diagnostics)) root_ = Builder(text_).build(end_);
}

std::string withEdits(const std::string& text, std::vector<TextEdit> edits) {
  std::stable_sort(edits.begin(), edits.end(), [](const TextEdit& a, const TextEdit& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);  // insertions come first
  });
  std::string result;
  std::size_t at = 0;
  for (const TextEdit& edit : edits) {
    result += text.substr(at, edit.begin - at) + edit.text;
    at = edit.end;
  }
  return result + text.substr(at);
}

}  // namespace sherd
