// The rules that a node type's table is held to.
#include "support/contract.h"

#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <regex>

#include "eval/key.h"
#include "graph/instances.h"
#include "graph/param.h"

namespace sherd::test {
namespace {

namespace fs = std::filesystem;

bool isNumeric(ParamKind kind) {
  return kind == ParamKind::Integer || kind == ParamKind::Number || kind == ParamKind::Vector3;
}

bool isWord(const std::string& name) {
  static const std::regex word("[a-z][a-z0-9_]*");
  return std::regex_match(name, word);
}

/// The text behind the last ", " if it holds no blank.
std::string unitAtTheEnd(const std::string& help) {
  const auto comma = help.rfind(", ");
  if (comma == std::string::npos) return {};
  const std::string unit = help.substr(comma + 2);
  return unit.find(' ') == std::string::npos ? unit : std::string();
}

void checkHelp(const std::string& where, const std::string& help, const ContractExceptions& exceptions,
               Faults& faults) {
  if (help.empty()) return faults.push_back(where + ": has no help; say what it is");
  const std::string first = help.substr(0, help.find_first_of(" ,;:"));
  if (std::isupper(static_cast<unsigned char>(help.front())) != 0 && !exceptions.names.contains(first))
    faults.push_back(where + ": its help starts with a capital: \"" + first + "\"; write it small");
  if (help.back() == '.') faults.push_back(where + ": its help ends with a full stop; leave it out");
}

void checkPorts(const NodeType& type, const ContractExceptions& exceptions, Faults& faults) {
  for (const auto* ports : {&type.inputs, &type.outputs})
    for (const PortInfo& port : *ports) {
      const std::string where = type.name + '.' + port.name;
      if (!isWord(port.name)) faults.push_back(where + ": is no name of small letters, digits and _");
      checkHelp(where, port.help, exceptions, faults);
    }
  for (const PortInfo& port : type.outputs) {
    const std::string where = type.name + '.' + port.name;
    if (port.type == valueTypeName<double>() && unitAtTheEnd(port.help).empty() &&
        !exceptions.dimensionless.contains(where))
      faults.push_back(where +
                       ": its help doesn't end with a unit (\"…, J\"); add it, or list it as dimensionless");
  }
}

bool inRange(const ParamInfo& info, double number) {
  const bool above = info.openMin ? number > info.min : number >= info.min;
  const bool below = info.openMax ? number < info.max : number <= info.max;
  return std::isfinite(number) && above && below;
}

std::vector<double> numbersOf(const ParamValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return {static_cast<double>(*integer)};
  if (const auto* number = std::get_if<double>(&value)) return {*number};
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return *list;
  return {};
}

void checkParam(const NodeType& type, const ParamInfo& info, const ContractExceptions& exceptions,
                Faults& faults) {
  const std::string where = type.name + '.' + info.name;
  if (!isWord(info.name)) faults.push_back(where + ": is no name of small letters, digits and _");
  checkHelp(where, info.help, exceptions, faults);
  if (isNumeric(info.kind) && info.unit.empty() && !exceptions.dimensionless.contains(where))
    faults.push_back(where + ": has no unit; give it one, or list it as dimensionless");
  for (const double number : numbersOf(info.fallback))
    if (!info.required && !inRange(info, number))
      faults.push_back(where + ": its default " + numberText(number) + " is out of its range");
  if (info.kind != ParamKind::Choice) return;
  const auto* fallback = std::get_if<std::string>(&info.fallback);
  bool found = false;
  for (const std::string& word : info.choices) {
    found = found || (fallback != nullptr && word == *fallback);
    if (!isWord(word))
      faults.push_back(where + ": \"" + word + "\" is no word of small letters, digits and _");
  }
  if (info.choices.size() < 2) faults.push_back(where + ": leaves no choice; list two words at least");
  if (!found) faults.push_back(where + ": its default is none of its words");
}

}  // namespace

Faults documentationFaults(const NodeType& type, const ContractExceptions& exceptions) {
  static const std::regex typeName("[A-Z][A-Za-z0-9]*");
  Faults faults;
  if (!std::regex_match(type.name, typeName))
    faults.push_back(type.name + ": is no name of letters and digits that starts with a capital");
  if (type.help.empty()) faults.push_back(type.name + ": has no help; say what it does");
  if (type.outputs.empty() && !type.writesFiles)
    faults.push_back(type.name + ": has no output and writes no files");
  checkPorts(type, exceptions, faults);
  for (const ParamInfo& info : type.params) checkParam(type, info, exceptions, faults);
  return faults;
}

Faults staleExceptions(const NodeType& type, const ContractExceptions& exceptions) {
  Faults faults;
  for (const std::string& entry : exceptions.dimensionless) {
    const auto dot = entry.find('.');
    if (entry.substr(0, dot) != type.name) continue;
    const std::string name = entry.substr(dot + 1);
    const ParamInfo* param = type.param(name);
    const PortInfo* output = type.output(name);
    const bool isParam = param != nullptr && isNumeric(param->kind) && param->unit.empty();
    const bool isOutput =
        output != nullptr && output->type == valueTypeName<double>() && unitAtTheEnd(output->help).empty();
    if (!isParam && !isOutput)
      faults.push_back(entry + ": is listed as dimensionless, but is no number without a unit");
  }
  return faults;
}

// ---- Keys

namespace {

/// Other values of a number: close by and far away, within the range.
std::vector<double> othersOf(const ParamInfo& info, double number) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> candidates{number + 1, number - 1};
  if (info.kind != ParamKind::Integer) {
    candidates.insert(candidates.end(),
                      {std::nextafter(number, kInfinity), std::nextafter(number, -kInfinity),
                       (number + info.min) / 2, (number + info.max) / 2});
  }
  std::set<double> others;
  for (const double candidate : candidates)
    if (candidate != number && inRange(info, candidate)) others.insert(candidate);
  return {others.begin(), others.end()};
}

/// Values that the parameter may have instead of its default; none of a file to read.
std::vector<ParamValue> otherValues(const ParamInfo& info) {
  std::vector<ParamValue> values;
  switch (info.kind) {
    case ParamKind::Boolean:
      return {!std::get<bool>(info.fallback)};
    case ParamKind::Integer:
      for (const double other : othersOf(info, numbersOf(info.fallback).at(0)))
        values.emplace_back(static_cast<std::int64_t>(other));
      return values;
    case ParamKind::Number:
      for (const double other : othersOf(info, numbersOf(info.fallback).at(0))) values.emplace_back(other);
      return values;
    case ParamKind::Vector3:
      for (std::size_t k = 0; k < 3; ++k) {
        auto numbers = std::get<std::vector<double>>(info.fallback);
        for (const double other : othersOf(info, numbers.at(k))) {
          numbers.at(k) = other;
          values.emplace_back(numbers);
        }
      }
      return values;
    case ParamKind::Choice:
      for (const std::string& word : info.choices)
        if (ParamValue(word) != info.fallback) values.emplace_back(word);
      return values;
    case ParamKind::Text:
      return {std::get<std::string>(info.fallback) + "a", std::get<std::string>(info.fallback) + "b"};
    case ParamKind::List:
      return {std::string("[1]"), std::string("[2]")};
    case ParamKind::OutputFile:
    case ParamKind::OutputDirectory:
      return {std::string("/out/a"), std::string("/out/b")};
    case ParamKind::InputFile:
      break;
  }
  return values;
}

/// Recipes of one type's node.
class Recipes {
 public:
  Recipes(const NodeType& type, const RecipeWriter& writer) : writer_(writer) {
    base_.type = &type;
    for (const ParamInfo& info : type.params) base_.params[info.name] = defaultParam(info, "/");
  }
  Digest with(const std::string& param, const ParamValue& value) const {
    Graph::Node node = base_;
    node.params[param] = value;
    write(node);
    return node.recipe;
  }
  /// By the file's content.
  Result<Digest> withFile(const std::string& param, const std::string& path) const {
    Graph::Node node = base_;
    node.params[param] = path;
    write(node);
    FileDigests files;
    return recipeWithFiles(node, node.params, files);
  }
  const ParamValue& usual(const std::string& param) const { return base_.params.at(param); }

 private:
  void write(Graph::Node& node) const { writer_ ? writer_(node) : writeRecipe(node); }

  const RecipeWriter& writer_;
  Graph::Node base_;
};

std::string writeFile(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
  return path.string();
}

void checkFileKey(const std::string& where, const ParamInfo& info, const Recipes& recipes,
                  const fs::path& scratch, Faults& faults) {
  const auto one = recipes.withFile(info.name, writeFile(scratch / "one" / "file", "content"));
  const auto moved = recipes.withFile(info.name, writeFile(scratch / "moved" / "file", "content"));
  const auto other = recipes.withFile(info.name, writeFile(scratch / "other" / "file", "contend"));
  for (const auto* recipe : {&one, &moved, &other})
    if (!recipe->ok()) return faults.push_back(where + ": " + recipe->error().text());
  if (*one == *other) faults.push_back(where + ": files of different content give the same key");
  if (*one != *moved) faults.push_back(where + ": the same file at another place gives another key");
}

}  // namespace

Faults keyFaults(const NodeType& type, const std::string& scratch, const RecipeWriter& writer) {
  Faults faults;
  const Recipes recipes(type, writer);
  std::map<Digest, std::string> known;
  for (const ParamInfo& info : type.params) {
    const std::string where = type.name + '.' + info.name;
    if (info.kind == ParamKind::InputFile) {
      checkFileKey(where, info, recipes, scratch, faults);
      continue;
    }
    std::vector<ParamValue> values = otherValues(info);
    if (values.empty()) faults.push_back(where + ": has but one value; it is no parameter");
    known.emplace(recipes.with(info.name, recipes.usual(info.name)), "the default");
    for (const ParamValue& value : values) {
      const std::string text = info.name + " = " + paramText(value);
      const auto [found, isNew] = known.emplace(recipes.with(info.name, value), text);
      if (!isNew) faults.push_back(where + ": " + text + " and " + found->second + " give the same key");
    }
  }
  return faults;
}

// ---- Bad values

namespace {

/// JSON that is of another kind than the parameter.
std::vector<std::string> wrongKinds(const ParamInfo& info) {
  switch (info.kind) {
    case ParamKind::Boolean:
      return {"null", "1", "\"yes\""};
    case ParamKind::Integer:
      return {"null", "true", "\"one\"", "0.5", "[1]"};
    case ParamKind::Number:
      return {"null", "true", "\"one\"", "[1]"};
    case ParamKind::Vector3:
      return {"null", "1", "[0, 0]", "[0, 0, 0, 0]", "[0, 0, \"one\"]"};
    case ParamKind::List:
      return {"null", "1", "true", "\"one\"", "{}", "[null]"};
    case ParamKind::Choice:
      return {"null", "1", "\"no such word\""};
    case ParamKind::Text:
      return {"null", "1", "true", "[]"};
    default:
      return {"null", "1", "[]"};
  }
}

/// Numbers just outside the range.
std::vector<double> outside(const ParamInfo& info) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool whole = info.kind == ParamKind::Integer;
  std::vector<double> numbers;
  if (std::isfinite(info.min))
    numbers.push_back(info.openMin ? info.min
                      : whole      ? std::ceil(info.min) - 1
                                   : std::nextafter(info.min, -kInfinity));
  if (std::isfinite(info.max))
    numbers.push_back(info.openMax ? info.max
                      : whole      ? std::floor(info.max) + 1
                                   : std::nextafter(info.max, kInfinity));
  return numbers;
}

std::vector<std::string> badValues(const ParamInfo& info) {
  std::vector<std::string> values = wrongKinds(info);
  if (info.required) values.push_back("\"\"");
  if (!isNumeric(info.kind)) return values;
  for (const double number : outside(info)) {
    const std::string text = numberText(number);
    if (info.kind != ParamKind::Vector3) {
      values.push_back(text);
      continue;
    }
    for (const auto& [before, after] : {std::pair("[", ", 0, 0]"), {"[0, ", ", 0]"}, {"[0, 0, ", "]"}})
      values.push_back(before + text + after);
  }
  return values;
}

/// Messages about a graph of one node with this parameter, which stands in the second line.
std::vector<std::string> messagesOf(const NodeType& type, const std::string& param, const std::string& value,
                                    const Registry& registry) {
  const std::string text = "{\"format\": 1, \"nodes\": {\"it\": {\"type\": " +
                           jsonString(type.name + '@' + std::to_string(type.version)) + ", \"params\": {\n" +
                           jsonString(param) + ": " + value + "}}}}";
  Environment environment;
  environment.currentDirectory = "/";
  environment.variable = [](const std::string&) { return std::nullopt; };
  Diagnostics diagnostics;
  const GraphFile file =
      readGraph(text, std::make_shared<const Source>(Source{"bad.json", "/"}), diagnostics);
  checkGraph(file, registry, {}, environment, diagnostics);
  std::vector<std::string> messages;
  for (const Diagnostic& diagnostic : diagnostics.sorted()) messages.push_back(diagnostic.text());
  return messages;
}

}  // namespace

Faults badValueFaults(const NodeType& type, const Registry& registry) {
  Faults faults;
  for (const ParamInfo& info : type.params) {
    const std::regex wanted("bad\\.json:2:[1-9][0-9]*: it\\." + info.name + ": (.|\n)+");
    for (const std::string& value : badValues(info)) {
      bool found = false;
      for (const std::string& message : messagesOf(type, info.name, value, registry))
        found = found || std::regex_match(message, wanted);
      if (!found)
        faults.push_back(type.name + '.' + info.name + ": " + value + " is not rejected with its place");
    }
  }
  return faults;
}

}  // namespace sherd::test
