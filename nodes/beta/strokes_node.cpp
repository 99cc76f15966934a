#include "beta/strokes_node.h"

#include <algorithm>
#include <cmath>

#include "graph/json.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

using Kind = JsonValue::Kind;

const std::vector<std::string> kFields{"points", "radius", "value", "falloff", "blend"};
const std::vector<std::pair<std::string, Blend>> kBlends{{"replace", Blend::Replace},
                                                         {"add", Blend::Add},
                                                         {"multiply", Blend::Multiply},
                                                         {"max", Blend::Max},
                                                         {"min", Blend::Min}};

class StrokeReader {
 public:
  explicit StrokeReader(std::size_t number) : name_("stroke " + std::to_string(number)) {}

  Result<Stroke> read(const JsonValue& value) const {
    if (value.kind != Kind::Object)
      return wrong("is " + describe(value),
                   R"(write { "points": [[x, y, z]], "radius": m, "value": number })");
    for (const JsonMember& member : value.members)
      if (std::find(kFields.begin(), kFields.end(), member.key) == kFields.end())
        return wrong("has no field " + inQuotes(member.key), suggestion(member.key, kFields, "fields"));
    Stroke stroke;
    SHERD_CHECK(readPoints(value.find("points"), stroke));
    SHERD_CHECK(readNumber(value, "radius", stroke.radius, true));
    SHERD_CHECK(readNumber(value, "value", stroke.value, true));
    SHERD_CHECK(readNumber(value, "falloff", stroke.falloff, false));
    if (!(stroke.radius > 0))
      return wrong("has a radius of " + numberText(stroke.radius), "it would have to be above 0 m");
    if (!(stroke.falloff >= 0 && stroke.falloff <= 1))
      return wrong("has a falloff of " + numberText(stroke.falloff),
                   "it would have to be at least 0 and at most 1");
    SHERD_CHECK(readBlend(value.find("blend"), stroke));
    return stroke;
  }

 private:
  Error wrong(const std::string& what, std::string remedy) const {
    return failure(name_ + ' ' + what, std::move(remedy), "strokes");
  }

  /// A text is what stands for a number while its variables are unknown: it is never one here.
  Result<void> readNumber(const JsonValue& object, const char* field, double& number, bool isRequired) const {
    const JsonValue* value = object.find(field);
    if (value == nullptr && !isRequired) return {};
    if (value == nullptr) return wrong(std::string("has no \"") + field + '"', "give it one");
    if (!value->isNumber() || !std::isfinite(value->number))
      return wrong(std::string("has a ") + field + " that is " + describe(*value),
                   "it would have to be a number");
    number = value->number;
    return {};
  }

  static bool isPoint(const JsonValue& value) {
    return value.kind == Kind::Array && value.items.size() == 3 &&
           std::all_of(value.items.begin(), value.items.end(),
                       [](const JsonValue& v) { return v.isNumber() && std::isfinite(v.number); });
  }

  Result<void> readPoints(const JsonValue* value, Stroke& stroke) const {
    const char* remedy = "write \"points\": [[x, y, z], …] in metres";
    if (value == nullptr) return wrong("has no \"points\"", remedy);
    const auto add = [&](const JsonValue& p) {
      stroke.points.emplace_back(p.items[0].number, p.items[1].number, p.items[2].number);
    };
    if (isPoint(*value)) {
      add(*value);
      return {};
    }
    if (value->kind != Kind::Array || value->items.empty()) return wrong("has no list of points", remedy);
    for (std::size_t i = 0; i < value->items.size(); ++i) {
      if (!isPoint(value->items[i]))
        return wrong("has a point that isn't three numbers, number " + std::to_string(i + 1), remedy);
      add(value->items[i]);
    }
    return {};
  }

  Result<void> readBlend(const JsonValue* value, Stroke& stroke) const {
    if (value == nullptr) return {};
    std::vector<std::string> words;
    for (const auto& [word, blend] : kBlends) {
      if (value->kind == Kind::String && value->text == word) {
        stroke.blend = blend;
        return {};
      }
      words.push_back(word);
    }
    return wrong("has a blend that is " + describe(*value),
                 "it would have to be one of " + quotedList(words));
  }

  std::string name_;
};

}  // namespace

Result<std::vector<Stroke>> readStrokes(const std::string& json) {
  Diagnostics diagnostics;
  const auto list = parseJson(json, std::make_shared<const Source>(), diagnostics);
  if (!list || list->kind != Kind::Array)
    return failure("strokes would have to be a list", "write \"strokes\": [{ … }]", "strokes");
  std::vector<Stroke> strokes;
  for (const JsonValue& item : list->items) {
    SHERD_ASSIGN(Stroke stroke, StrokeReader(strokes.size() + 1).read(item));
    strokes.push_back(std::move(stroke));
  }
  return strokes;
}

}  // namespace sherd
