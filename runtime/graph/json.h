// JSON values that know where they stand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graph/diagnostics.h"

namespace sherd {

struct JsonMember;

struct JsonValue {
  enum class Kind { Null, Boolean, Integer, Number, String, Array, Object };
  Kind kind = Kind::Null;
  Origin origin;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0;                 ///< of a Number; an Integer has it too
  std::string text;                  ///< of a String
  std::optional<std::string> typed;  ///< of a value of the command line or environment: what was typed
  std::vector<JsonValue> items;      ///< of an Array
  std::vector<JsonMember> members;   ///< of an Object, in the file's order, without duplicates

  bool isNumber() const { return kind == Kind::Integer || kind == Kind::Number; }
  /// The member's value, or null.
  const JsonValue* find(std::string_view key) const;
};

struct JsonMember {
  std::string key;
  Origin origin;  ///< of the key
  JsonValue value;
};

/// Values nested deeper than this are an error.
constexpr int kDeepestJson = 64;

/// Parses all of `text`. The first error of syntax ends it (nothing is returned); duplicate keys are reported
/// and the first of them kept. Comments are skipped, a comma may trail. O(n).
std::optional<JsonValue> parseJson(std::string_view text, const SourcePtr& source, Diagnostics& diagnostics);

/// A word typed on the command line or found in the environment: JSON where it parses as such, else a string.
JsonValue parseTyped(const std::string& typed, const SourcePtr& source);

/// "a string", "an integer", …
std::string kindName(JsonValue::Kind kind);
/// A number, string or boolean as text, as it is put into the middle of a string; empty for the others.
/// Numbers have the fewest digits that read back to the same value.
std::optional<std::string> scalarText(const JsonValue& value);
/// The shortest decimal text that reads back as `number`.
std::string numberText(double number);
/// The value as JSON on one line.
std::string jsonText(const JsonValue& value);
/// The text as a JSON string, in quotation marks.
std::string jsonString(std::string_view text);
/// The value for a message: a string in quotation marks, a number as it is, else its kind.
std::string describe(const JsonValue& value);

}  // namespace sherd
