#include "graph/param.h"

#include <algorithm>
#include <cmath>

#include "graph/suggest.h"

namespace sherd {
namespace {

Error wrong(std::string what, std::string remedy) {
  return Error{std::move(what), std::move(remedy), {}, Error::Kind::Input};
}

Error wrongKind(const ParamInfo& info, const std::string& what) {
  return wrong("this is " + what, "it would have to be " + expectation(info));
}

std::string absolutePath(const std::string& text, const std::filesystem::path& base) {
  if (text.empty()) return text;
  auto path = (base / text).lexically_normal();
  if (!path.has_filename() && path.has_relative_path()) path = path.parent_path();  // without the trailing /
  return path.string();
}

Result<void> checkRange(const ParamInfo& info, double number) {
  const bool below = info.openMin ? number <= info.min : number < info.min;
  const bool above = info.openMax ? number >= info.max : number > info.max;
  if (std::isfinite(number) && !below && !above) return {};
  const std::string range = rangeText(info);
  return wrong(numberText(number) + " is out of range",
               "it would have to be " + (range.empty() ? "a finite number" : range));
}

Result<ParamValue> fromInteger(const ParamInfo& info, std::int64_t integer) {
  SHERD_CHECK(checkRange(info, static_cast<double>(integer)));
  if (info.kind == ParamKind::Number) return ParamValue(static_cast<double>(integer));
  return ParamValue(integer);
}

Result<ParamValue> fromText(const ParamInfo& info, const std::string& text,
                            const std::filesystem::path& base) {
  if (text.find('\0') != std::string::npos) return wrong("this text holds a zero byte", "leave it out");
  if (info.kind == ParamKind::Choice) {
    if (std::find(info.choices.begin(), info.choices.end(), text) != info.choices.end())
      return ParamValue(text);
    return wrong(inQuotes(text) + " is none of its words", suggestion(text, info.choices, "words"));
  }
  if (info.required && text.empty())
    return wrong("this is empty", "it would have to be " + expectation(info));
  return ParamValue(isPath(info.kind) ? absolutePath(text, base) : text);
}

Result<ParamValue> fromNumber(const ParamInfo& info, double number) {
  SHERD_CHECK(checkRange(info, number));
  if (info.kind == ParamKind::Number) return ParamValue(number + 0.0);
  constexpr double kLargest = 9007199254740992.0;  // 2^53: all whole numbers up to here are doubles
  if (number != std::floor(number) || std::abs(number) > kLargest) return wrongKind(info, numberText(number));
  return ParamValue(static_cast<std::int64_t>(number));
}

Result<ParamValue> fromList(const ParamInfo& info, const JsonValue& value) {
  if (value.items.size() != 3) return wrongKind(info, "a list of " + std::to_string(value.items.size()));
  std::vector<double> numbers;
  for (const JsonValue& item : value.items) {
    if (!item.isNumber()) return wrongKind(info, "a list with " + kindName(item.kind));
    SHERD_CHECK(checkRange(info, item.number));
    numbers.push_back(item.number + 0.0);
  }
  return ParamValue(std::move(numbers));
}

Result<ParamValue> fromItems(const ParamInfo& info, const JsonValue& value) {
  std::string json = jsonText(value);
  if (info.accepts)
    if (const auto accepted = info.accepts(json); !accepted.ok())
      return wrong(accepted.error().what, accepted.error().remedy);
  return ParamValue(std::move(json));
}

}  // namespace

Result<ParamValue> readParam(const ParamInfo& info, const JsonValue& value,
                             const std::filesystem::path& base) {
  using Kind = JsonValue::Kind;
  switch (info.kind) {
    case ParamKind::Boolean:
      if (value.kind == Kind::Boolean) return ParamValue(value.boolean);
      break;
    case ParamKind::Integer:
    case ParamKind::Number:
      if (value.kind == Kind::Integer) return fromInteger(info, value.integer);
      if (value.kind == Kind::Number) return fromNumber(info, value.number);
      break;
    case ParamKind::Vector3:
      if (value.kind == Kind::Array) return fromList(info, value);
      break;
    case ParamKind::List:
      if (value.kind == Kind::Array) return fromItems(info, value);
      break;
    default:
      if (value.kind == Kind::String) return fromText(info, value.text, base);
      if (value.typed) return fromText(info, *value.typed, base);
  }
  if (value.kind == Kind::Null) return wrong("this is null", "leave the parameter out for its default");
  return wrongKind(info, describe(value));
}

Result<ParamValue> readParam(const ParamInfo& info, const Value& value, const std::filesystem::path& base) {
  switch (info.kind) {
    case ParamKind::Boolean:
      if (const auto boolean = value.as<bool>()) return ParamValue(*boolean);
      break;
    case ParamKind::Integer:
    case ParamKind::Number:
      if (const auto integer = value.as<std::int64_t>()) return fromInteger(info, *integer);
      if (const auto number = value.as<double>(); number && info.kind == ParamKind::Number)
        return fromNumber(info, *number);
      break;
    case ParamKind::Vector3:
    case ParamKind::List:
      break;
    default:
      if (const auto text = value.as<std::string>()) return fromText(info, *text, base);
  }
  return wrongKind(info, value.empty() ? "wired to an output that was left empty" : value.type().name);
}

bool isPath(ParamKind kind) {
  return kind == ParamKind::InputFile || kind == ParamKind::OutputFile || kind == ParamKind::OutputDirectory;
}

ParamValue defaultParam(const ParamInfo& info, const std::filesystem::path& base) {
  if (!isPath(info.kind)) return info.fallback;
  return absolutePath(std::get<std::string>(info.fallback), base);
}

std::string wireType(ParamKind kind) {
  switch (kind) {
    case ParamKind::Boolean:
      return ScalarName<bool>::value;
    case ParamKind::Integer:
      return ScalarName<std::int64_t>::value;
    case ParamKind::Number:
      return ScalarName<double>::value;
    case ParamKind::Vector3:
    case ParamKind::List:
      return {};
    default:
      return ScalarName<std::string>::value;
  }
}

bool acceptsWire(const ParamInfo& info, const std::string& valueType) {
  if (info.kind == ParamKind::Number && valueType == wireType(ParamKind::Integer)) return true;
  return !valueType.empty() && wireType(info.kind) == valueType;
}

void hashParam(Hasher& hasher, const ParamValue& value) {
  hasher.add(value.index());
  std::visit(
      [&](const auto& v) {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::vector<double>>) {
          for (const double number : v) hasher.add(number);  // one by one: −0 counts as +0
        } else if constexpr (std::is_same_v<T, std::string>) {
          hasher.add(std::string_view(v));
        } else {
          hasher.add(v);
        }
      },
      value);
}

std::string kindText(ParamKind kind) {
  switch (kind) {
    case ParamKind::Boolean:
      return "boolean";
    case ParamKind::Integer:
      return "integer";
    case ParamKind::Number:
      return "number";
    case ParamKind::Vector3:
      return "three numbers";
    case ParamKind::Text:
      return "text";
    case ParamKind::Choice:
      return "word";
    case ParamKind::InputFile:
      return "file to read";
    case ParamKind::OutputFile:
      return "file to write";
    case ParamKind::OutputDirectory:
      return "directory to write into";
    case ParamKind::List:
      return "list";
  }
  return {};
}

std::string rangeText(const ParamInfo& info) {
  const std::string unit = info.unit.empty() ? "" : ' ' + info.unit;
  std::string text;
  if (std::isfinite(info.min)) text = (info.openMin ? "above " : "at least ") + numberText(info.min);
  if (std::isfinite(info.max))
    text += (text.empty() ? "" : " and ") + std::string(info.openMax ? "below " : "at most ") +
            numberText(info.max);
  return text.empty() ? text : text + unit;
}

std::string expectation(const ParamInfo& info) {
  if (info.kind == ParamKind::Choice) return "one of " + quotedList(info.choices);
  std::string text;
  switch (info.kind) {
    case ParamKind::Boolean:
      text = "true or false";
      break;
    case ParamKind::Vector3:
      text = "a list of three numbers";
      break;
    case ParamKind::List:
      text = "a list";
      break;
    case ParamKind::Integer:
      text = "an integer";
      break;
    case ParamKind::Number:
      text = "a number";
      break;
    default:
      text = "a string";
  }
  if (isPath(info.kind)) text += ", the path of a " + kindText(info.kind);
  const std::string range = rangeText(info);
  if (!range.empty()) text += ", " + range;
  return text;
}

std::string paramText(const ParamValue& value) {
  struct Text {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return std::to_string(v); }
    std::string operator()(double v) const { return numberText(v); }
    std::string operator()(const std::string& v) const { return inQuotes(v); }
    std::string operator()(const std::vector<double>& v) const {
      std::string text;
      for (const double number : v) text += (text.empty() ? "[" : ", ") + numberText(number);
      return text + "]";
    }
  };
  return std::visit(Text{}, value);
}

}  // namespace sherd
