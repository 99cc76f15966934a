#include "graph/json.h"

#include <charconv>
#include <unordered_map>

#include "graph/json_scanner.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

using Kind = JsonToken::Kind;

class Parser {
 public:
  Parser(std::string_view text, const SourcePtr& source, Diagnostics& diagnostics)
      : scanner_(text), source_(source), diagnostics_(diagnostics) {}

  std::optional<JsonValue> parse() {
    JsonValue value;
    if (advance() && parseValue(value, 0)) {
      if (token_.kind == Kind::End) return value;
      fail("something follows the end", "the file would have to hold one value");
    }
    diagnostics_.add({source_, error_.line, error_.column}, where(), error_.what, error_.remedy);
    return std::nullopt;
  }

 private:
  bool advance() {
    do {
      if (!scanner_.next(token_)) {
        error_ = scanner_.error();
        return false;
      }
    } while (token_.kind == Kind::Comment);
    return true;
  }

  bool fail(std::string what, std::string remedy) {
    if (token_.kind == Kind::End) what = "the file ends too early";
    error_ = {token_.line, token_.column, std::move(what), std::move(remedy)};
    return false;
  }

  Origin here() const { return {source_, token_.line, token_.column}; }

  /// The place in the graph that the path of keys stands for: "node.port", or the keys with dots.
  std::string where() const {
    if (path_.size() >= 2 && path_[0] == "nodes")
      return path_.size() >= 4 ? path_[1] + '.' + path_[3] : path_[1];
    std::string text;
    for (const std::string& key : path_) text += (text.empty() ? "" : ".") + key;
    return text;
  }

  bool parseValue(JsonValue& value, int depth) {
    value.origin = here();
    switch (token_.kind) {
      case Kind::ObjectBegin:
        return parseObject(value, depth);
      case Kind::ArrayBegin:
        return parseArray(value, depth);
      case Kind::String:
        value.kind = JsonValue::Kind::String;
        value.text = std::move(token_.text);
        break;
      case Kind::Integer:
        value.kind = JsonValue::Kind::Integer;
        value.integer = token_.integer;
        value.number = static_cast<double>(token_.integer);
        break;
      case Kind::Real:
        value.kind = JsonValue::Kind::Number;
        value.number = token_.real;
        break;
      case Kind::True:
      case Kind::False:
        value.kind = JsonValue::Kind::Boolean;
        value.boolean = token_.kind == Kind::True;
        break;
      case Kind::Null:
        break;
      default:
        return fail("a value is missing", "a string, number, list or object would have to stand here");
    }
    return advance();
  }

  bool tooDeep(int depth) {
    if (depth < kDeepestJson) return false;
    fail("nested more than " + std::to_string(kDeepestJson) + " levels deep", "a graph needs five");
    return true;
  }

  bool parseArray(JsonValue& value, int depth) {
    value.kind = JsonValue::Kind::Array;
    if (tooDeep(depth) || !advance()) return false;
    while (token_.kind != Kind::ArrayEnd) {
      if (!parseValue(value.items.emplace_back(), depth + 1)) return false;
      if (!separator(Kind::ArrayEnd, ", or ] would have to stand here")) return false;
    }
    return advance();
  }

  bool parseObject(JsonValue& value, int depth) {
    value.kind = JsonValue::Kind::Object;
    if (tooDeep(depth) || !advance()) return false;
    std::unordered_map<std::string, int> lines;
    while (token_.kind != Kind::ObjectEnd) {
      if (token_.kind != Kind::String) return fail("a key is missing", "a string would have to stand here");
      JsonMember member{token_.text, here(), {}};
      path_.push_back(member.key);
      const auto [first, isNew] = lines.emplace(member.key, token_.line);
      if (!isNew)
        diagnostics_.add(member.origin, where(), "the key " + inQuotes(member.key) + " is there twice",
                         "the other one is in line " + std::to_string(first->second) + "; keep one of them");
      if (!advance()) return false;
      if (token_.kind != Kind::Colon)
        return fail("a colon is missing", "a key is followed by : and its value");
      if (!advance() || !parseValue(member.value, depth + 1)) return false;
      if (!separator(Kind::ObjectEnd, ", or } would have to stand here")) return false;
      path_.pop_back();
      if (isNew) value.members.push_back(std::move(member));
    }
    return advance();
  }

  /// A comma, or the closing bracket without reading it.
  bool separator(Kind end, const char* remedy) {
    if (token_.kind == end) return true;
    if (token_.kind == Kind::Comma) return advance();
    return fail("a comma is missing", remedy);
  }

  JsonScanner scanner_;
  const SourcePtr& source_;
  Diagnostics& diagnostics_;
  JsonToken token_;
  JsonError error_;
  std::vector<std::string> path_;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
  for (const JsonMember& member : members)
    if (member.key == key) return &member.value;
  return nullptr;
}

std::optional<JsonValue> parseJson(std::string_view text, const SourcePtr& source, Diagnostics& diagnostics) {
  return Parser(text, source, diagnostics).parse();
}

JsonValue parseTyped(const std::string& typed, const SourcePtr& source) {
  Diagnostics ignored;  // what is no JSON is a string: nobody types quotation marks in a shell
  JsonValue value;
  if (auto parsed = parseJson(typed, source, ignored); parsed && ignored.empty()) {
    value = std::move(*parsed);
  } else {
    value.kind = JsonValue::Kind::String;
    value.text = typed;
  }
  value.origin = {source, 0, 0};
  value.typed = typed;
  return value;
}

std::string kindName(JsonValue::Kind kind) {
  switch (kind) {
    case JsonValue::Kind::Null:
      return "null";
    case JsonValue::Kind::Boolean:
      return "a boolean";
    case JsonValue::Kind::Integer:
      return "an integer";
    case JsonValue::Kind::Number:
      return "a number";
    case JsonValue::Kind::String:
      return "a string";
    case JsonValue::Kind::Array:
      return "a list";
    case JsonValue::Kind::Object:
      return "an object";
  }
  return {};
}

std::string numberText(double number) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
  return {buffer, end};
}

std::optional<std::string> scalarText(const JsonValue& value) {
  if (value.kind == JsonValue::Kind::String) return value.text;
  if (value.typed && value.kind != JsonValue::Kind::Array && value.kind != JsonValue::Kind::Object)
    return value.typed;
  switch (value.kind) {
    case JsonValue::Kind::Boolean:
      return value.boolean ? "true" : "false";
    case JsonValue::Kind::Integer:
      return std::to_string(value.integer);
    case JsonValue::Kind::Number:
      return numberText(value.number);
    default:
      return std::nullopt;
  }
}

std::string jsonString(std::string_view text) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (byte < 0x20)
      result += {'\\', 'u', '0', '0', kDigits[byte >> 4], kDigits[byte & 15]};
    else
      result += c;
  }
  return result + '"';
}

std::string jsonText(const JsonValue& value) {
  std::string text;
  switch (value.kind) {
    case JsonValue::Kind::Null:
      return "null";
    case JsonValue::Kind::String:
      return jsonString(value.text);
    case JsonValue::Kind::Array:
      for (const JsonValue& item : value.items) text += (text.empty() ? "" : ", ") + jsonText(item);
      return '[' + text + ']';
    case JsonValue::Kind::Object:
      for (const JsonMember& member : value.members)
        text += (text.empty() ? "" : ", ") + jsonString(member.key) + ": " + jsonText(member.value);
      return text.empty() ? "{}" : "{ " + text + " }";
    default:
      return *scalarText(value);
  }
}

std::string describe(const JsonValue& value) {
  switch (value.kind) {
    case JsonValue::Kind::String:
      return "the string " + inQuotes(value.text);
    case JsonValue::Kind::Boolean:
    case JsonValue::Kind::Integer:
    case JsonValue::Kind::Number:
      return *scalarText(value);
    default:
      return kindName(value.kind);
  }
}

}  // namespace sherd
