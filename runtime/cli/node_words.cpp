#include "cli/node_words.h"

#include <algorithm>
#include <cctype>

#include "cli/console.h"
#include "graph/param.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

std::string stepText(const MigrationStep& step) {
  using Kind = MigrationStep::Kind;
  switch (step.kind) {
    case Kind::RenameParam:
      return "parameter " + inQuotes(step.from) + " is now " + inQuotes(step.to);
    case Kind::RenameInput:
      return "input " + inQuotes(step.from) + " is now " + inQuotes(step.to);
    case Kind::RenameOutput:
      return "output " + inQuotes(step.from) + " is now " + inQuotes(step.to);
    case Kind::RemoveParam:
      return "parameter " + inQuotes(step.from) + " is gone" + (step.json.empty() ? "" : ": " + step.json);
    case Kind::SetParam:
      return "the default of " + inQuotes(step.to) + " was " + step.json;
    case Kind::ConvertParam:
      return "the value of " + inQuotes(step.from) + " is converted";
  }
  return {};
}

/// "ExportCrackSurface" → "export_crack_surface", "ReadVDB" → "read_vdb", "CVD" → "cvd".
std::string keyFor(const std::string& typeName) {
  auto isUpper = [&](std::size_t i) { return std::isupper(static_cast<unsigned char>(typeName[i])) != 0; };
  std::string key;
  for (std::size_t i = 0; i < typeName.size(); ++i) {
    const bool endsWord = i > 0 && !isUpper(i - 1);
    const bool endsAcronym = i > 0 && i + 1 < typeName.size() && isUpper(i - 1) && !isUpper(i + 1);
    if (isUpper(i) && (endsWord || endsAcronym)) key += '_';
    key += static_cast<char>(std::tolower(static_cast<unsigned char>(typeName[i])));
  }
  return key;
}

/// Whether values of this type go through: then the node is no source of them.
bool takes(const NodeType& type, const std::string& valueType) {
  return std::any_of(type.inputs.begin(), type.inputs.end(),
                     [&](const PortInfo& port) { return port.type == valueType; });
}

/// "node" or "node.port" of a type that makes such values; prefers one that makes little else and needs none.
std::string linkTo(const std::string& valueType, const Registry& registry) {
  const NodeType* best = nullptr;
  std::size_t bestRank = 0, bestPort = 0;
  for (const NodeType* type : registry.all())
    for (std::size_t port = 0; port < type->outputs.size(); ++port) {
      if (type->outputs[port].type != valueType) continue;
      const std::size_t rank = 2 * port + (takes(*type, valueType) ? 1 : 0);
      if (best == nullptr || rank < bestRank) best = type, bestRank = rank, bestPort = port;
    }
  if (best == nullptr) return "NODE";
  return keyFor(best->name) + (bestPort == 0 ? "" : '.' + best->outputs[bestPort].name);
}

std::string placeholder(ParamKind kind) {
  switch (kind) {
    case ParamKind::InputFile:
    case ParamKind::OutputFile:
      return "FILE";
    case ParamKind::OutputDirectory:
      return "DIRECTORY";
    default:
      return "TEXT";
  }
}

std::string objectText(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string text;
  for (const auto& [name, value] : members)
    text += (text.empty() ? "{ \"" : ", \"") + name + "\": \"" + value + '"';
  return text + " }";
}

}  // namespace

std::string versioned(const NodeType& type) { return type.name + '@' + std::to_string(type.version); }

std::string defaultText(const ParamInfo& info) {
  if (info.required) return "required";
  if (info.kind == ParamKind::List) return std::get<std::string>(info.fallback);
  std::string text = paramText(info.fallback);
  if (!info.unit.empty()) text += ' ' + info.unit;
  return text;
}

std::string limitsText(const ParamInfo& info) {
  return info.kind == ParamKind::Choice ? "one of " + quotedList(info.choices) : rangeText(info);
}

std::string helpText(const ParamInfo& info) {
  const std::string limits = limitsText(info);
  if (info.help.empty() || limits.empty()) return info.help + limits;
  return info.help + "; " + limits;
}

std::string helpText(const PortInfo& input) {
  const char* before =
      input.gathers ? input.required ? "(of all frames and wedges) " : "(optional, of all frames and wedges) "
      : input.required ? ""
                       : "(optional) ";
  return before + input.help;
}

std::vector<std::string> waitTexts(const NodeType& type) {
  std::vector<std::string> texts;
  for (const Uninterruptible& wait : type.uninterruptibles)
    texts.push_back(wait.call + ", " + durationText(wait.longestMs) + " at most as measured");
  return texts;
}

std::vector<std::pair<std::string, std::string>> migrationTexts(const NodeType& type) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const Migration& migration : type.migrations) {
    std::string steps;
    for (const MigrationStep& step : migration.steps) steps += (steps.empty() ? "" : "; ") + stepText(step);
    texts.emplace_back(std::to_string(migration.from) + " → " + std::to_string(migration.from + 1), steps);
  }
  return texts;
}

NodeSnippet snippetOf(const NodeType& type, const Registry& registry) {
  NodeSnippet snippet{keyFor(type.name), versioned(type), {}, {}};
  for (const PortInfo& port : type.inputs)
    if (port.required) snippet.in.emplace_back(port.name, linkTo(port.type, registry));
  for (const ParamInfo& info : type.params)
    if (info.required) snippet.params.emplace_back(info.name, placeholder(info.kind));
  return snippet;
}

std::string snippetText(const NodeSnippet& snippet, std::size_t width) {
  const std::string head = '"' + snippet.key + "\": { ";
  std::vector<std::string> parts{"\"type\": \"" + snippet.type + '"'};
  if (!snippet.in.empty()) parts.push_back("\"in\": " + objectText(snippet.in));
  if (!snippet.params.empty()) parts.push_back("\"params\": " + objectText(snippet.params));
  auto joined = [&](const std::string& between) {
    std::string text = head;
    for (std::size_t i = 0; i < parts.size(); ++i) text += (i == 0 ? "" : between) + parts[i];
    return text + " }";
  };
  const std::string line = joined(", ");
  return line.size() <= width ? line : joined(",\n" + std::string(head.size(), ' '));
}

}  // namespace sherd
