#include "cli/schema.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/node_words.h"
#include "graph/param.h"

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

// The rules of the graph's reader, as regular expressions.
constexpr const char* kName =
    "^[^\\s./@${}:=\"'\\u0000-\\u001f\\u007f-\\u009f]"
    "([^./@${}:=\"'\\u0000-\\u001f\\u007f-\\u009f]*[^\\s./@${}:=\"'\\u0000-\\u001f\\u007f-\\u009f])?$";
constexpr const char* kLink = "^[^.]+(\\.[^.].*)?$";
constexpr const char* kOneVariable = "^\\$\\{[^{}]+\\}$";
constexpr const char* kSomeVariable = "\\$\\{";
constexpr const char* kFrames =
    "^ *-?[0-9]+(--?[0-9]+(x[1-9][0-9]*)?)? *(, *-?[0-9]+(--?[0-9]+(x[1-9][0-9]*)?)? *)*$";

Json reference(const std::string& definition) { return {{"$ref", "#/definitions/" + definition}}; }

Json described(std::string description, Json schema) {
  Json result{{"description", std::move(description)}};
  result.update(schema);
  return result;
}

/// An object with these keys only.
Json closedObject(Json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

/// An object whose keys are the user's names.
Json namedObject(Json values) {
  return {
      {"type", "object"}, {"propertyNames", reference("name")}, {"additionalProperties", std::move(values)}};
}

/// A value of the type, or the string "${x}".
Json orVariable(const char* type) {
  return {
      {"type", {type, "string"}},
      {"pattern", kOneVariable},
      {"patternErrorMessage", std::string("This would have to be of type ") + type + ", or \"${name}\"."}};
}

/// Applies to numbers only: a string in their place is held to be a variable by its pattern.
Json numberSchema(const char* type, const ParamInfo& info) {
  Json schema = orVariable(type);
  auto limit = [](double value) {
    return value == std::floor(value) && std::abs(value) < 1e15 ? Json(static_cast<std::int64_t>(value))
                                                                : Json(value);
  };
  if (std::isfinite(info.min)) schema[info.openMin ? "exclusiveMinimum" : "minimum"] = limit(info.min);
  if (std::isfinite(info.max)) schema[info.openMax ? "exclusiveMaximum" : "maximum"] = limit(info.max);
  return schema;
}

Json kindSchema(const ParamInfo& info) {
  switch (info.kind) {
    case ParamKind::Boolean:
      return orVariable("boolean");
    case ParamKind::Integer:
      return numberSchema("integer", info);
    case ParamKind::Number:
      return numberSchema("number", info);
    case ParamKind::Vector3: {
      Json schema = orVariable("array");
      schema.update({{"items", numberSchema("number", info)}, {"minItems", 3}, {"maxItems", 3}});
      return schema;
    }
    case ParamKind::List:
      return orVariable("array");
    case ParamKind::Choice:
      return {{"type", "string"}, {"anyOf", {{{"enum", info.choices}}, {{"pattern", kSomeVariable}}}}};
    default:
      return info.required ? Json{{"type", "string"}, {"minLength", 1}} : Json{{"type", "string"}};
  }
}

Json paramSchema(const ParamInfo& info) {
  std::string about = helpText(info) + " (" + kindText(info.kind);
  // The range names the unit where there is one.
  if (!info.unit.empty() && rangeText(info).empty()) about += ", " + info.unit;
  about += info.required ? ", required)" : ", default: " + defaultText(info) + ')';
  Json schema = described(about, kindSchema(info));
  const auto* text = std::get_if<std::string>(&info.fallback);
  if (info.kind == ParamKind::List)
    schema["default"] = Json::parse(*text);
  else if (!info.required && (text == nullptr || !text->empty()))
    std::visit([&](const auto& value) { schema["default"] = value; }, info.fallback);
  return schema;
}

Json linkSchema(const std::string& about) {
  return described(about, {{"type", "string"}, {"pattern", kLink}});
}

Json inputsSchema(const NodeType& type) {
  Json ports = Json::object(), required = Json::array();
  for (const PortInfo& port : type.inputs) {
    ports[port.name] = linkSchema(helpText(port) + " (" + port.type + ')');
    if (port.required) required.push_back(port.name);
  }
  for (const ParamInfo& info : type.params)
    if (!wireType(info.kind).empty())
      ports[info.name] =
          linkSchema("instead of the parameter: " + helpText(info) + " (" + wireType(info.kind) + ')');
  Json schema = described("\"node\" or \"node.port\" for each input; parameters can be wired, too",
                          closedObject(std::move(ports)));
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

Json mustHave(const char* part, const std::string& key) {
  return {{"required", {part}}, {"properties", {{part, {{"required", {key}}}}}}};
}

Json typeSchema(const NodeType& type) {
  Json params = Json::object(), choices = Json::array();
  for (const ParamInfo& info : type.params) {
    params[info.name] = paramSchema(info);
    if (info.required)
      choices.push_back({{"anyOf", {mustHave("params", info.name), mustHave("in", info.name)}}});
  }
  Json schema = described(
      type.help,
      {{"properties",
        {{"in", inputsSchema(type)},
         {"params", described("what is left out has its default", closedObject(std::move(params)))}}}});
  if (schema["properties"]["in"].contains("required")) schema["required"] = Json::array({"in"});
  if (!choices.empty()) schema["allOf"] = std::move(choices);
  return schema;
}

/// Older versions and names under which graphs still load, as parts of a regular expression.
std::string olderNames(const NodeType& type) {
  std::vector<std::string> names = type.formerNames;
  std::string text;
  auto add = [&](const std::string& name, int version) {
    text += (text.empty() ? "" : "|") + name + '@' + std::to_string(version);
  };
  for (const std::string& former : names) add(former, type.version);
  names.push_back(type.name);
  for (const Migration& migration : type.migrations)
    for (const std::string& name : names) add(name, migration.from);
  return text;
}

/// What has been replaced and what the file itself defines is accepted, but not offered.
Json typeKeySchema(const Registry& registry) {
  Json names = Json::array(), helps = Json::array(), choices = Json::array();
  std::string older;
  for (const NodeType* type : registry.all()) {
    names.push_back(versioned(*type));
    helps.push_back(type->help);
    const std::string more = olderNames(*type);
    older += (older.empty() || more.empty() ? "" : "|") + more;
  }
  choices.push_back({{"enum", std::move(names)}, {"enumDescriptions", std::move(helps)}});
  if (!older.empty()) choices.push_back(described("an older version", {{"pattern", "^(" + older + ")$"}}));
  choices.push_back(described("a subgraph", {{"pattern", "^[^@]+$"}}));
  return described("the node's type and version, or the name of a subgraph",
                   {{"type", "string"}, {"anyOf", std::move(choices)}});
}

Json nodeSchema(const Registry& registry) {
  Json cases = Json::array();
  for (const NodeType* type : registry.all())
    cases.push_back(
        {{"if", {{"required", {"type"}}, {"properties", {{"type", {{"const", versioned(*type)}}}}}}},
         {"then", reference(versioned(*type))}});
  const Json links = {{"type", "object"}, {"additionalProperties", reference("link")}};
  Json schema =
      closedObject({{"type", typeKeySchema(registry)},
                    {"in", links},
                    {"params", {{"type", "object"}, {"additionalProperties", reference("paramValue")}}}});
  schema["required"] = Json::array({"type"});
  if (!cases.empty()) schema["allOf"] = std::move(cases);
  return schema;
}

/// What an editor offers to insert as a new node. The user steps through the placeholders.
Json snippetJson(const NodeType& type, const Registry& registry) {
  const NodeSnippet snippet = snippetOf(type, registry);
  Json body{{"type", snippet.type}};
  int stop = 0;
  auto add = [&](const char* part, const auto& members) {
    for (const auto& [name, value] : members)
      body[part][name] = "${" + std::to_string(++stop) + ':' + value + '}';
  };
  add("in", snippet.in);
  add("params", snippet.params);
  return {{"label", snippet.type}, {"description", type.help}, {"body", std::move(body)}};
}

Json nodesSchema(const Registry& registry) {
  Json snippets = Json::array();
  for (const NodeType* type : registry.all()) snippets.push_back(snippetJson(*type, registry));
  Json node = reference("node");
  Json schema =
      namedObject({{"allOf", Json::array({std::move(node)})}, {"defaultSnippets", std::move(snippets)}});
  schema["minProperties"] = 1;
  return schema;
}

Json definitions() {
  Json all;
  all["name"] = {{"type", "string"}, {"pattern", kName}};
  all["link"] = linkSchema("\"node\" or \"node.port\"");
  all["paramValue"] = {{"type", {"number", "string", "boolean", "array"}},
                       {"items", {{"type", {"number", "string", "array", "object"}}}}};
  all["variable"] = {{"type", {"number", "string", "boolean", "array"}}};
  all["vars"] =
      described("values to override with --var, used as \"${name}\"", namedObject(reference("variable")));
  all["vars"]["propertyNames"] = {{"allOf", {reference("name"), {{"not", {{"enum", {"frame", "ASSETS"}}}}}}}};
  return all;
}

Json formatSchema() { return described("of this file", {{"const", 1}}); }

Json subgraphInputSchema() {
  const Json type = {{"type", "string"}, {"minLength", 1}};
  Json full = closedObject({{"type", described("type of the values that go in", type)},
                            {"optional", {{"type", "boolean"}, {"default", false}}},
                            {"help", {{"type", "string"}}}});
  full["required"] = Json::array({"type"});
  return described("type of the values that go in", {{"anyOf", {type, std::move(full)}}});
}

Json subgraphOutputSchema() {
  Json full = closedObject({{"from", reference("link")},
                            {"type", {{"type", "string"}, {"minLength", 1}}},
                            {"help", {{"type", "string"}}}});
  full["required"] = Json::array({"from"});
  return described("\"node.port\" within the subgraph", {{"anyOf", {reference("link"), std::move(full)}}});
}

/// Within a graph, or in a file of its own.
Json subgraphSchema(bool isFile) {
  Json properties{{"help", {{"type", "string"}}},
                  {"vars", reference("vars")},
                  {"inputs", namedObject(subgraphInputSchema())},
                  {"outputs", namedObject(subgraphOutputSchema())},
                  {"subgraphs", reference("subgraphs")},
                  {"nodes", reference("nodes")}};
  if (isFile) properties["format"] = formatSchema();
  Json schema = closedObject(std::move(properties));
  schema["required"] = isFile ? Json::array({"format", "nodes"}) : Json::array({"nodes"});
  return schema;
}

Json subgraphsSchema() {
  const Json file = described("a file with the subgraph",
                              {{"type", "string"}, {"minLength", 1}, {"not", {{"pattern", kSomeVariable}}}});
  return described("subgraphs by name, which nodes name as their type",
                   namedObject({{"anyOf", {reference("subgraph"), file}}}));
}

Json fileSchema() {
  const Json nodeNames = {{"type", {"array", "string"}}, {"items", {{"type", "string"}}}};
  const Json values = {{"type", "array"},
                       {"minItems", 1},
                       {"uniqueItems", true},
                       {"items", {{"type", {"number", "string", "boolean"}}}}};
  Json schema = closedObject(
      {{"format", formatSchema()},
       {"fps",
        described("frames per second", {{"type", "number"}, {"exclusiveMinimum", 0}, {"default", 24}})},
       {"vars", reference("vars")},
       {"frames", described("\"first-last\", \"first-lastxstep\", one frame, or several of these with commas",
                            {{"type", {"string", "integer"}}, {"pattern", kFrames}})},
       {"wedge", described("a list of values for each of these variables", namedObject(values))},
       {"targets", described("names for groups of nodes, for --target", namedObject(nodeNames))},
       {"subgraphs", reference("subgraphs")},
       {"nodes", described("nodes by name, in any order", {{"allOf", Json::array({reference("nodes")})}})}});
  schema["required"] = {"format", "nodes"};
  return schema;
}

/// In a file without subgraphs every type has its version.
Json versionsWithoutSubgraphs() {
  const Json withVersion = {{"pattern", "@"},
                            {"patternErrorMessage", "A type has its version: \"LoadMesh@1\"."}};
  const Json type = {{"properties", {{"type", withVersion}}}};
  return {{"if", {{"not", {{"required", {"subgraphs"}}}}}},
          {"then", {{"properties", {{"nodes", {{"additionalProperties", type}}}}}}}};
}

}  // namespace

std::string graphSchema(const Registry& registry) {
  Json all = definitions();
  all["graph"] = fileSchema();
  all["subgraphFile"] = subgraphSchema(true);
  all["subgraph"] = subgraphSchema(false);
  all["subgraphs"] = subgraphsSchema();
  all["nodes"] = nodesSchema(registry);
  all["node"] = nodeSchema(registry);
  for (const NodeType* type : registry.all()) all[versioned(*type)] = typeSchema(*type);

  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "sherd graph"}};
  schema["type"] = "object";
  schema["if"] = {{"anyOf", {{{"required", {"inputs"}}}, {{"required", {"outputs"}}}}}};
  schema["then"] = reference("subgraphFile");
  schema["else"] = reference("graph");
  schema["allOf"] = Json::array({versionsWithoutSubgraphs()});
  schema["allowComments"] = true;
  schema["allowTrailingCommas"] = true;
  schema["definitions"] = std::move(all);
  return schema.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace sherd
