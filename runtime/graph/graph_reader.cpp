#include "graph/graph_reader.h"

#include <algorithm>
#include <charconv>

#include "graph/name_rule.h"
#include "graph/suggest.h"

namespace sherd {

using Kind = JsonValue::Kind;

bool GraphReader::expect(const JsonValue& value, Kind kind, const std::string& where) {
  if (value.kind == kind) return true;
  diagnostics_.add(value.origin, where, "this is " + kindName(value.kind),
                   "it would have to be " + kindName(kind));
  return false;
}

void GraphReader::findUnknownKeys(const JsonValue& object, const Names& keys, const std::string& where,
                                  const std::string& kind) {
  for (const JsonMember& member : object.members)
    if (std::find(keys.begin(), keys.end(), member.key) == keys.end())
      diagnostics_.add(member.origin, where, "unknown key " + inQuotes(member.key),
                       suggestion(member.key, keys, "keys of " + kind));
}

void GraphReader::readFile(const JsonValue& root, GraphFile& file) {
  if (!expect(root, Kind::Object, "")) return;
  if (root.find("inputs") != nullptr || root.find("outputs") != nullptr) {
    readFormat(root);
    file.subgraph = std::make_shared<const Subgraph>(readSubgraph(root, ""));
    return;
  }
  findUnknownKeys(root, {"format", "fps", "vars", "frames", "wedge", "targets", "nodes", "subgraphs"}, "",
                  "a graph");
  readFormat(root);
  if (const JsonValue* fps = root.find("fps")) readFps(*fps, file);
  if (const JsonValue* vars = root.find("vars")) readVars(*vars, "", file.vars);
  if (const JsonValue* targets = root.find("targets")) readTargets(*targets, file);
  if (const JsonValue* subgraphs = root.find("subgraphs")) readSubgraphs(*subgraphs, "", file.subgraphs);
  if (const JsonValue* nodes = root.find("nodes"))
    readNodes(*nodes, "", file.nodes);
  else
    diagnostics_.add(root.origin, "", "the key \"nodes\" is missing", "a graph has nodes");
  keepFrames(root, file.frames);
  keep(root, "wedge", Kind::Object, file.wedge);
}

void GraphReader::keep(const JsonValue& root, const char* key, Kind kind, std::optional<Setting>& setting) {
  const JsonValue* value = root.find(key);
  if (value != nullptr && expect(*value, kind, key)) setting = Setting{key, value->origin, *value};
}

/// A range is a text; a single frame may be a number.
void GraphReader::keepFrames(const JsonValue& root, std::optional<Setting>& setting) {
  const JsonValue* value = root.find("frames");
  if (value == nullptr) return;
  if (value->kind == Kind::Integer || expect(*value, Kind::String, "frames"))
    setting = Setting{"frames", value->origin, *value};
}

void GraphReader::readFormat(const JsonValue& root) {
  const JsonValue* format = root.find("format");
  if (format == nullptr)
    diagnostics_.add(root.origin, "", "the key \"format\" is missing", "add \"format\": 1");
  else if (format->kind != Kind::Integer)
    diagnostics_.add(format->origin, "format", "this is " + describe(*format), "write \"format\": 1");
  else if (format->integer != 1)
    diagnostics_.add(format->origin, "format", "the format " + describe(*format) + " is unknown",
                     "this program reads format 1");
}

void GraphReader::readFps(const JsonValue& fps, GraphFile& file) {
  if (fps.isNumber() && fps.number > 0)
    file.fps = fps.number;
  else
    diagnostics_.add(fps.origin, "fps", "this is " + describe(fps), "it would have to be a number above 0");
}

void GraphReader::readVars(const JsonValue& vars, const std::string& inside, std::vector<Setting>& list) {
  if (!expect(vars, Kind::Object, inside + "vars")) return;
  for (const JsonMember& member : vars.members) {
    const std::string where = inside + "vars." + member.key;
    if (!isName(member.key))
      diagnostics_.add(member.origin, where, "this is no name for a variable", kNameRule);
    else if (member.key == "frame" || member.key == "time" || member.key == "ASSETS")
      diagnostics_.add(member.origin, where, "this variable is set by the program", "choose another name");
    else if (member.value.kind == Kind::Null || member.value.kind == Kind::Object)
      diagnostics_.add(member.value.origin, where, "this is " + kindName(member.value.kind),
                       "a variable is a number, string, boolean or list");
    else
      list.push_back({member.key, member.origin, member.value});
  }
}

void GraphReader::readTargets(const JsonValue& targets, GraphFile& file) {
  if (!expect(targets, Kind::Object, "targets")) return;
  for (const JsonMember& member : targets.members) {
    const std::string where = "targets." + member.key;
    if (!isName(member.key))
      diagnostics_.add(member.origin, where, "this is no name for a target", kNameRule);
    TargetEntry target{member.key, member.origin, {}};
    auto addNode = [&](const JsonValue& name) {
      if (expect(name, Kind::String, where)) target.nodes.emplace_back(name.text, name.origin);
    };
    if (member.value.kind == Kind::String)
      addNode(member.value);
    else if (expect(member.value, Kind::Array, where))
      for (const JsonValue& name : member.value.items) addNode(name);
    file.targets.push_back(std::move(target));
  }
}

void GraphReader::readNodes(const JsonValue& nodes, const std::string& inside, std::vector<NodeEntry>& list) {
  if (!expect(nodes, Kind::Object, inside + "nodes")) return;
  if (nodes.members.empty())
    diagnostics_.add(nodes.origin, inside + "nodes", "there are none",
                     inside.empty() ? "a graph has nodes" : "a subgraph has nodes");
  list.reserve(nodes.members.size());
  for (const JsonMember& member : nodes.members) {
    const std::string where = inside + member.key;
    if (!isName(member.key)) diagnostics_.add(member.origin, where, "this is no name for a node", kNameRule);
    if (!expect(member.value, Kind::Object, where)) continue;
    NodeEntry& node = list.emplace_back();
    node.name = member.key;
    node.origin = member.origin;
    readNode(member.value, where, node);
  }
}

void GraphReader::readNode(const JsonValue& value, const std::string& where, NodeEntry& node) {
  findUnknownKeys(value, {"type", "in", "params"}, where, "a node");
  if (const JsonValue* type = value.find("type"))
    readType(*type, where, node);
  else
    diagnostics_.add(node.origin, where, "the key \"type\" is missing", "add \"type\": \"SomeType@1\"");
  if (const JsonValue* in = value.find("in")) readLinks(*in, where, node);
  if (const JsonValue* params = value.find("params")) readParams(*params, where, node);
}

void GraphReader::readType(const JsonValue& value, const std::string& where, NodeEntry& node) {
  node.typeOrigin = value.origin;
  if (!expect(value, Kind::String, where)) return;
  const std::size_t at = value.text.find('@');
  node.type = value.text.substr(0, at);
  if (node.type.empty()) {
    diagnostics_.add(value.origin, where, inQuotes(value.text) + " names no node type",
                     "write \"SomeType@1\"");
    return;
  }
  if (at == std::string::npos) return;  // told once the type's version is known
  const char* end = value.text.data() + value.text.size();
  const auto [stop, problem] = std::from_chars(value.text.data() + at + 1, end, node.version);
  if (problem == std::errc() && stop == end && node.version > 0) return;
  diagnostics_.add(value.origin, where, inQuotes(value.text) + " names no version of a type",
                   "a whole number follows the @: " + inQuotes(node.type + "@1"));
  node.version = NodeEntry::kNoVersion;
}

void GraphReader::readLinks(const JsonValue& value, const std::string& where, NodeEntry& node) {
  node.inIsUnread = !expect(value, Kind::Object, where + ".in");
  if (node.inIsUnread) return;
  for (const JsonMember& member : value.members) {
    // A link that can't be read is kept without a node: its port is not also unconnected.
    LinkEntry& link = node.in.emplace_back(LinkEntry{member.key, member.value.origin, {}, {}});
    readLink(member.value, where + '.' + member.key, link);
  }
}

void GraphReader::readLink(const JsonValue& value, const std::string& where, LinkEntry& link) {
  link.origin = value.origin;
  if (!expect(value, Kind::String, where)) return;
  const std::string& text = value.text;
  const std::size_t dot = text.find('.');
  if (dot == 0 || text.empty() || dot + 1 == text.size()) {
    diagnostics_.add(link.origin, where, inQuotes(text) + " is no link", "write \"node\" or \"node.port\"");
    return;
  }
  link.node = text.substr(0, dot);
  if (dot != std::string::npos) link.output = text.substr(dot + 1);
}

void GraphReader::readParams(const JsonValue& value, const std::string& where, NodeEntry& node) {
  node.paramsAreUnread = !expect(value, Kind::Object, where + ".params");
  if (node.paramsAreUnread) return;
  for (const JsonMember& member : value.members)
    node.params.push_back({member.key, member.origin, member.value});
}

}  // namespace sherd
