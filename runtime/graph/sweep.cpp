#include "graph/sweep.h"

#include <algorithm>
#include <set>

#include "graph/suggest.h"

namespace sherd {
namespace {

std::vector<std::int64_t> readFrames(const Origin& origin, const std::string& text,
                                     Diagnostics& diagnostics) {
  auto list = parseFrames(text);
  if (list.ok()) return std::move(list->frames);
  diagnostics.add(origin, "frames", list.error());
  return {};
}

bool isScalar(const JsonValue& value) { return scalarText(value).has_value(); }

/// The values of one variable of the wedge; empty where something is wrong.
std::vector<JsonValue> readValues(const JsonMember& member, const std::string& where,
                                  Diagnostics& diagnostics) {
  const JsonValue& value = member.value;
  if (value.kind != JsonValue::Kind::Array || value.items.empty()) {
    diagnostics.add(value.origin, where,
                    "this is " + (value.items.empty() ? describe(value) : kindName(value.kind)),
                    "it would have to be a list of the values to try, as [1, 2, 3]");
    return {};
  }
  std::set<std::string> texts;
  for (const JsonValue& item : value.items) {
    if (!isScalar(item))
      diagnostics.add(item.origin, where, "this is " + kindName(item.kind),
                      "a wedge's value is a number, a text or a boolean");
    else if (!texts.insert(*scalarText(item)).second)
      diagnostics.add(item.origin, where, describe(item) + " is in the list already",
                      "leave one of the two out");
  }
  return value.items;
}

}  // namespace

Sweep readSweep(const GraphFile& file, const Overrides& overrides, Diagnostics& diagnostics) {
  Sweep sweep;
  if (overrides.frames) {
    const Source source{"--frames " + *overrides.frames, {}, true};
    sweep.frames = readFrames({std::make_shared<const Source>(source), 0, 0}, *overrides.frames, diagnostics);
  } else if (file.frames) {
    const JsonValue& value = file.frames->value;
    sweep.frames = readFrames(value.origin, scalarText(value).value_or(""), diagnostics);
  }
  if (!file.wedge) return sweep;
  std::vector<std::string> names;
  for (const Setting& variable : file.vars)
    if (variable.scope.empty() && variable.name.find('/') == std::string::npos)
      names.push_back(variable.name);
  for (const JsonMember& member : file.wedge->value.members) {
    const std::string where = "wedge." + member.key;
    if (std::find(names.begin(), names.end(), member.key) == names.end()) {
      diagnostics.add(member.origin, where, "the graph has no variable " + inQuotes(member.key),
                      suggestion(member.key, names, "variables"));
      continue;
    }
    std::vector<JsonValue> values = readValues(member, where, diagnostics);
    const bool isTyped = std::any_of(overrides.vars.begin(), overrides.vars.end(),
                                     [&](const Assignment& a) { return a.name == member.key; });
    if (!values.empty() && !isTyped) sweep.wedge.push_back({member.key, std::move(values)});
  }
  if (sweep.wedge.size() <= Sweep::kMostDimensions) return sweep;
  diagnostics.add(file.wedge->origin, "wedge", "a wedge of more than 63 variables", "run it in parts");
  sweep.wedge.clear();
  return sweep;
}

}  // namespace sherd
