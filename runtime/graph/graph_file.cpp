#include "graph/graph_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>

#include "graph/suggest.h"

namespace sherd {
namespace {

constexpr std::size_t kLargestFile = std::size_t{64} << 20;

bool isName(std::string_view name) {
  auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  auto more = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  return !name.empty() && letter(name[0]) && std::all_of(name.begin(), name.end(), more);
}

constexpr const char* kNameRule = "letters, digits, _ and - make a name, and a letter or _ begins it";

class Reader {
 public:
  Reader(GraphFile& graph, Diagnostics& diagnostics) : graph_(graph), diagnostics_(diagnostics) {}

  void read(const JsonValue& root) {
    if (!expect(root, JsonValue::Kind::Object, "")) return;
    static const std::vector<std::string> kKeys{"format", "fps",     "vars", "frames",
                                                "wedge",  "targets", "nodes"};
    for (const JsonMember& member : root.members) {
      if (std::find(kKeys.begin(), kKeys.end(), member.key) == kKeys.end())
        diagnostics_.add(member.origin, "", "unknown key " + inQuotes(member.key),
                         suggestion(member.key, kKeys, "keys of a graph"));
    }
    readFormat(root);
    if (const JsonValue* fps = root.find("fps")) readFps(*fps);
    if (const JsonValue* vars = root.find("vars")) readVars(*vars);
    if (const JsonValue* targets = root.find("targets")) readTargets(*targets);
    if (const JsonValue* nodes = root.find("nodes"))
      readNodes(*nodes);
    else
      diagnostics_.add(root.origin, "", "the key \"nodes\" is missing", "a graph has nodes");
    keep(root, "frames", JsonValue::Kind::String, graph_.frames);
    keep(root, "wedge", JsonValue::Kind::Object, graph_.wedge);
  }

 private:
  bool expect(const JsonValue& value, JsonValue::Kind kind, const std::string& where) {
    if (value.kind == kind) return true;
    diagnostics_.add(value.origin, where, "this is " + kindName(value.kind),
                     "it would have to be " + kindName(kind));
    return false;
  }

  void keep(const JsonValue& root, const char* key, JsonValue::Kind kind, std::optional<Setting>& setting) {
    const JsonValue* value = root.find(key);
    if (value != nullptr && expect(*value, kind, key)) setting = Setting{key, value->origin, *value};
  }

  void readFormat(const JsonValue& root) {
    const JsonValue* format = root.find("format");
    if (format == nullptr)
      diagnostics_.add(root.origin, "", "the key \"format\" is missing", "add \"format\": 1");
    else if (format->kind != JsonValue::Kind::Integer)
      diagnostics_.add(format->origin, "format", "this is " + describe(*format), "write \"format\": 1");
    else if (format->integer != 1)
      diagnostics_.add(format->origin, "format", "the format " + describe(*format) + " is unknown",
                       "this program reads format 1");
  }

  void readFps(const JsonValue& fps) {
    if (fps.isNumber() && fps.number > 0)
      graph_.fps = fps.number;
    else
      diagnostics_.add(fps.origin, "fps", "this is " + describe(fps), "it would have to be a number above 0");
  }

  void readVars(const JsonValue& vars) {
    if (!expect(vars, JsonValue::Kind::Object, "vars")) return;
    for (const JsonMember& member : vars.members) {
      const std::string where = "vars." + member.key;
      if (!isName(member.key))
        diagnostics_.add(member.origin, where, "this is no name for a variable", kNameRule);
      else if (member.key == "frame" || member.key == "ASSETS")
        diagnostics_.add(member.origin, where, "this variable is set by the program", "choose another name");
      else if (member.value.kind == JsonValue::Kind::Null || member.value.kind == JsonValue::Kind::Object)
        diagnostics_.add(member.value.origin, where, "this is " + kindName(member.value.kind),
                         "a variable is a number, string, boolean or list");
      else
        graph_.vars.push_back({member.key, member.origin, member.value});
    }
  }

  void readTargets(const JsonValue& targets) {
    if (!expect(targets, JsonValue::Kind::Object, "targets")) return;
    for (const JsonMember& member : targets.members) {
      const std::string where = "targets." + member.key;
      if (!isName(member.key))
        diagnostics_.add(member.origin, where, "this is no name for a target", kNameRule);
      TargetEntry target{member.key, member.origin, {}};
      auto addNode = [&](const JsonValue& name) {
        if (expect(name, JsonValue::Kind::String, where)) target.nodes.emplace_back(name.text, name.origin);
      };
      if (member.value.kind == JsonValue::Kind::String)
        addNode(member.value);
      else if (expect(member.value, JsonValue::Kind::Array, where))
        for (const JsonValue& name : member.value.items) addNode(name);
      graph_.targets.push_back(std::move(target));
    }
  }

  void readNodes(const JsonValue& nodes) {
    if (!expect(nodes, JsonValue::Kind::Object, "nodes")) return;
    if (nodes.members.empty()) diagnostics_.add(nodes.origin, "nodes", "there are none", "a graph has nodes");
    graph_.nodes.reserve(nodes.members.size());
    for (const JsonMember& member : nodes.members) {
      if (!isName(member.key))
        diagnostics_.add(member.origin, member.key, "this is no name for a node", kNameRule);
      if (!expect(member.value, JsonValue::Kind::Object, member.key)) continue;
      NodeEntry& node = graph_.nodes.emplace_back();
      node.name = member.key;
      node.origin = member.origin;
      readNode(member.value, node);
    }
  }

  void readNode(const JsonValue& value, NodeEntry& node) {
    static const std::vector<std::string> kKeys{"type", "in", "params"};
    for (const JsonMember& member : value.members) {
      if (member.key == "type")
        readType(member.value, node);
      else if (member.key == "in")
        readLinks(member.value, node);
      else if (member.key == "params")
        readParams(member.value, node);
      else
        diagnostics_.add(member.origin, node.name, "unknown key " + inQuotes(member.key),
                         suggestion(member.key, kKeys, "keys of a node"));
    }
    if (value.find("type") == nullptr)
      diagnostics_.add(node.origin, node.name, "the key \"type\" is missing", "add \"type\": \"SomeType@1\"");
  }

  void readType(const JsonValue& value, NodeEntry& node) {
    node.typeOrigin = value.origin;
    if (!expect(value, JsonValue::Kind::String, node.name)) return;
    const std::size_t at = value.text.find('@');
    node.type = value.text.substr(0, at);
    if (node.type.empty()) {
      diagnostics_.add(value.origin, node.name, inQuotes(value.text) + " names no node type",
                       "write \"SomeType@1\"");
      return;
    }
    if (at == std::string::npos) return;  // told once the type's version is known
    const char* end = value.text.data() + value.text.size();
    const auto [stop, problem] = std::from_chars(value.text.data() + at + 1, end, node.version);
    if (problem == std::errc() && stop == end && node.version > 0) return;
    diagnostics_.add(value.origin, node.name, inQuotes(value.text) + " names no version of a type",
                     "a whole number follows the @: " + inQuotes(node.type + "@1"));
    node.version = NodeEntry::kNoVersion;
  }

  void readLinks(const JsonValue& value, NodeEntry& node) {
    node.inIsUnread = !expect(value, JsonValue::Kind::Object, node.name + ".in");
    if (node.inIsUnread) return;
    for (const JsonMember& member : value.members) {
      const std::string where = node.name + '.' + member.key;
      // A link that can't be read is kept without a node: its port is not also unconnected.
      LinkEntry& link = node.in.emplace_back(LinkEntry{member.key, member.value.origin, {}, {}});
      if (!expect(member.value, JsonValue::Kind::String, where)) continue;
      const std::string& text = member.value.text;
      const std::size_t dot = text.find('.');
      if (dot == 0 || text.empty() || dot + 1 == text.size()) {
        diagnostics_.add(link.origin, where, inQuotes(text) + " is no link",
                         "write \"node\" or \"node.port\"");
        continue;
      }
      link.node = text.substr(0, dot);
      if (dot != std::string::npos) link.output = text.substr(dot + 1);
    }
  }

  void readParams(const JsonValue& value, NodeEntry& node) {
    node.paramsAreUnread = !expect(value, JsonValue::Kind::Object, node.name + ".params");
    if (node.paramsAreUnread) return;
    for (const JsonMember& member : value.members)
      node.params.push_back({member.key, member.origin, member.value});
  }

  GraphFile& graph_;
  Diagnostics& diagnostics_;
};

}  // namespace

GraphFile readGraph(std::string_view text, const SourcePtr& source, Diagnostics& diagnostics) {
  GraphFile graph;
  graph.source = source;
  if (const auto root = parseJson(text, source, diagnostics)) Reader(graph, diagnostics).read(*root);
  return graph;
}

GraphFile readGraphFile(const std::string& path, Diagnostics& diagnostics) {
  std::error_code problem;
  const auto absolute = std::filesystem::absolute(path, problem).lexically_normal();
  const auto source = std::make_shared<const Source>(Source{path, absolute.parent_path()});
  GraphFile nothing;
  nothing.source = source;
  auto refuse = [&](std::string what, std::string remedy) {
    diagnostics.add({source, 0, 0}, "", std::move(what), std::move(remedy));
    return nothing;
  };
  if (std::filesystem::is_directory(absolute, problem))
    return refuse("this is a directory", "name a graph file");
  errno = 0;
  std::ifstream file(absolute, std::ios::binary);
  if (!file)
    return refuse("the graph can't be opened: " + std::string(std::strerror(errno)), "name a graph file");
  std::string text;
  for (char block[1 << 16]; file && text.size() <= kLargestFile;) {
    file.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad())
    return refuse("the graph can't be read to its end", "check the disk and copy the file again");
  if (text.size() > kLargestFile) return refuse("the file is larger than 64 MB", "this is no graph file");
  return readGraph(text, source, diagnostics);
}

}  // namespace sherd
