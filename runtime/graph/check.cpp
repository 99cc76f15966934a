#include <algorithm>
#include <memory>
#include <set>
#include <unordered_map>

#include "graph/graph.h"
#include "graph/instances.h"
#include "graph/loops.h"
#include "graph/param.h"
#include "graph/subgraphs.h"
#include "graph/suggest.h"
#include "graph/sweep.h"

namespace sherd {
namespace {

/// A node type's names for fast look-up, made once per type.
struct TypeNames {
  std::unordered_map<std::string, std::size_t> inputs, outputs, params;
  std::vector<std::string> inputList, outputList, paramList;

  explicit TypeNames(const NodeType& type) {
    fill(type.inputs, inputs, inputList);
    fill(type.outputs, outputs, outputList);
    fill(type.params, params, paramList);
  }

 private:
  template <class T>
  static void fill(const std::vector<T>& from, std::unordered_map<std::string, std::size_t>& map,
                   std::vector<std::string>& list) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      map.emplace(from[i].name, i);
      list.push_back(from[i].name);
    }
  }
};

class Checker {
 public:
  Checker(const GraphFile& file, const Registry& registry, const Overrides& overrides,
          const Environment& environment, Diagnostics& diagnostics)
      : file_(file),
        registry_(registry),
        diagnostics_(diagnostics),
        variables_(file, overrides.vars, environment, diagnostics),
        wrongEnds_(checkSubgraphEnds(file, registry, diagnostics)),
        own_(file.nodes.size(), 0),
        swept_(file.nodes.size()) {
    graph_.source = file.source;
    graph_.fps = file.fps;
    for (const NodeEntry& entry : file.nodes) {
      graph_.index.emplace(entry.name, Graph::Instances{static_cast<int>(nodeNames_.size()), 1});
      nodeNames_.push_back(entry.name);
    }
    for (const GroupEntry& group : file.groups) nodeNames_.push_back(group.name);
    for (const Assignment& assignment : overrides.sets) takeOverride(assignment);
    sweep_ = readSweep(file, overrides, diagnostics);
    variables_.sweepOver(sweep_, file.fps);
  }

  Graph check() {
    const std::size_t before = diagnostics_.count();
    for (const NodeEntry& entry : file_.nodes) makeNode(entry);
    checkOverrides();
    for (std::size_t i = 0; i < file_.nodes.size(); ++i) {
      if (graph_.nodes[i].type == nullptr) continue;
      wire(i);
      readParams(i);
    }
    findTargets();
    reportLoops(graph_, diagnostics_);
    const bool hasTypes = std::all_of(graph_.nodes.begin(), graph_.nodes.end(),
                                      [](const Graph::Node& node) { return node.type != nullptr; });
    if (diagnostics_.count() > before || !hasTypes) return std::move(graph_);
    for (Graph::Node& node : graph_.nodes) writeRecipe(node);
    multiply(
        graph_, sweep_, own_,
        [this](int node, const std::vector<int>& at, Graph::Node& copy) { reread(node, at, copy); },
        diagnostics_);
    return std::move(graph_);
  }

 private:
  struct Override {
    Assignment assignment;
    std::string param;
  };
  /// A parameter that has another value at another frame or in another wedge.
  struct SweptParam {
    std::size_t param = 0;
    JsonValue value;
    std::string scope;
  };

  void takeOverride(const Assignment& assignment) {
    const std::size_t dot = assignment.name.find('.');
    const Origin origin{assignment.source, 0, 0};
    if (dot == std::string::npos || dot == 0 || dot + 1 == assignment.name.size()) {
      diagnostics_.add(origin, "", inQuotes(assignment.name) + " is no parameter",
                       "write --set node.param=value");
      return;
    }
    const std::string node = assignment.name.substr(0, dot);
    const int i = graph_.find(node);
    if (i < 0)
      diagnostics_.add(origin, "", "the graph has no node " + inQuotes(node), nearNode(node));
    else
      overrides_[i].push_back({assignment, assignment.name.substr(dot + 1)});
  }

  /// A suggestion compares with all names; a large graph with many errors has to do without at some point.
  std::string nearNode(const std::string& name) {
    if (nodeNames_.size() > comparisonsLeft_) return listing(nodeNames_, "nodes");
    comparisonsLeft_ -= nodeNames_.size();
    return suggestion(name, nodeNames_, "nodes");
  }

  static std::string commandFor(const NodeType& type) { return "sherd nodes " + type.name; }

  const TypeNames& namesOf(const NodeType& type) {
    auto& names = typeNames_[&type];
    if (names == nullptr) names = std::make_unique<TypeNames>(type);
    return *names;
  }

  void makeNode(const NodeEntry& entry) {
    Graph::Node& node = graph_.nodes.emplace_back();
    node.name = entry.name;
    node.origin = entry.origin;
    node.home = file_.source;
    if (entry.type.empty()) return;  // missing or malformed: told by the reader
    const NodeType* type = registry_.find(entry.type);
    if (type == nullptr) {
      std::vector<std::string> names;
      for (const NodeType* known : registry_.all()) names.push_back(known->name);
      for (const SubgraphEntry& known : file_.subgraphs) names.push_back(known.name);
      diagnostics_.add(entry.typeOrigin, entry.name, "there is no node type " + inQuotes(entry.type),
                       std::find(names.begin(), names.end(), entry.type) != names.end()
                           ? "it is a subgraph: write " + inQuotes(entry.type) + ", without a version"
                           : suggestion(entry.type, names, "node types", "sherd nodes"));
      return;
    }
    // Also of another version: what has to change in the node is told in the same go.
    node.type = type;
    if (entry.version == type->version || entry.version == NodeEntry::kNoVersion) return;
    const std::string current = inQuotes(type->name + '@' + std::to_string(type->version));
    if (entry.version == 0)
      diagnostics_.add(entry.typeOrigin, entry.name, inQuotes(entry.type) + " names no version",
                       "write " + current);
    else if (entry.version > type->version)
      diagnostics_.add(
          entry.typeOrigin, entry.name,
          inQuotes(entry.type + '@' + std::to_string(entry.version)) + " is newer than this program",
          "write " + current + ", or update sherd");
    else
      diagnostics_.add(
          entry.typeOrigin, entry.name,
          inQuotes(entry.type + '@' + std::to_string(entry.version)) + " is an old interface",
          "write " + current + " and adapt the node to what `sherd nodes " + type->name + "` says");
  }

  /// --set of a parameter that the type doesn't have is told by the option, not by the file.
  void checkOverrides() {
    for (auto& [i, list] : overrides_) {
      const NodeType* type = graph_.nodes[static_cast<std::size_t>(i)].type;
      if (type == nullptr) continue;
      const TypeNames& names = namesOf(*type);
      auto isKnown = [&](const Override& o) {
        if (names.params.contains(o.param)) return true;
        diagnostics_.add({o.assignment.source, 0, 0},
                         graph_.nodes[static_cast<std::size_t>(i)].name + '.' + o.param,
                         type->name + " has no parameter " + inQuotes(o.param),
                         suggestion(o.param, names.paramList, "parameters", commandFor(*type)));
        return false;
      };
      std::erase_if(list, [&](const Override& o) { return !isKnown(o); });
    }
  }

  bool isOverridden(int node, const std::string& param) const {
    const auto found = overrides_.find(node);
    return found != overrides_.end() && std::any_of(found->second.begin(), found->second.end(),
                                                    [&](const Override& o) { return o.param == param; });
  }

  void wire(std::size_t i) {
    const NodeEntry& entry = file_.nodes[i];
    Graph::Node& node = graph_.nodes[i];
    const TypeNames& names = namesOf(*node.type);
    std::vector<const LinkEntry*> inputs(node.type->inputs.size()), params(node.type->params.size());
    for (const LinkEntry& link : entry.in) {
      node.origins[link.port] = link.origin;
      if (const auto port = names.inputs.find(link.port); port != names.inputs.end()) {
        inputs[port->second] = &link;
      } else if (const auto param = names.params.find(link.port); param != names.params.end()) {
        params[param->second] = &link;
      } else {
        std::vector<std::string> known = names.inputList;
        known.insert(known.end(), names.paramList.begin(), names.paramList.end());
        diagnostics_.add(link.origin, node.name + '.' + link.port,
                         node.type->name + " has no input " + inQuotes(link.port),
                         suggestion(link.port, known, "inputs and parameters", commandFor(*node.type)));
      }
    }
    for (std::size_t p = 0; p < inputs.size(); ++p) wireInput(i, static_cast<int>(p), inputs[p]);
    for (std::size_t p = 0; p < params.size(); ++p) wireParam(i, static_cast<int>(p), params[p]);
  }

  void wireInput(std::size_t i, int to, const LinkEntry* link) {
    Graph::Node& node = graph_.nodes[i];
    const PortInfo& port = node.type->inputs[static_cast<std::size_t>(to)];
    const std::string where = node.name + '.' + port.name;
    if (link == nullptr) {
      if (port.required && !file_.nodes[i].inIsUnread)
        diagnostics_.add(node.origin, where, "the input is not connected",
                         "wire an output of type " + port.type + " to it");
      return;
    }
    const PortInfo* output = nullptr;
    const int from = findOutput(*link, where, output);
    if (output == nullptr) return;
    if (output->type == port.type)
      node.inputs.push_back({to, from, placeOf(*output, from)});
    else
      complainOfType(*link, from, *output, where, port.type);
  }

  int placeOf(const PortInfo& output, int node) const {
    return static_cast<int>(&output - graph_.nodes[static_cast<std::size_t>(node)].type->outputs.data());
  }

  void wireParam(std::size_t i, int to, const LinkEntry* link) {
    Graph::Node& node = graph_.nodes[i];
    const ParamInfo& param = node.type->params[static_cast<std::size_t>(to)];
    if (link == nullptr || isOverridden(static_cast<int>(i), param.name)) return;  // --set wins over a wire
    const std::string where = node.name + '.' + param.name;
    const PortInfo* output = nullptr;
    const int from = findOutput(*link, where, output);
    if (output == nullptr) return;
    if (acceptsWire(param, output->type)) {
      node.wiredParams.push_back({to, from, placeOf(*output, from)});
    } else if (wireType(param.kind).empty()) {
      diagnostics_.add(link->origin, where,
                       (param.kind == ParamKind::List ? "a list" : "a parameter of " + kindText(param.kind)) +
                           " can't be wired",
                       "set it in \"params\"");
    } else {
      complainOfType(*link, from, *output, where, wireType(param.kind));
    }
  }

  void complainOfType(const LinkEntry& link, int from, const PortInfo& output, const std::string& where,
                      const std::string& wanted) {
    std::vector<std::string> fitting;
    for (const PortInfo& other : graph_.nodes[static_cast<std::size_t>(from)].type->outputs)
      if (other.type == wanted) fitting.push_back(link.node + '.' + other.name);
    diagnostics_.add(
        link.origin, where, inQuotes(link.node + '.' + output.name) + " is of type " + output.type,
        "it would have to be " + wanted +
            (fitting.empty() ? "" : ", as " + quotedList(fitting) + (fitting.size() == 1 ? " is" : " are")));
  }

  /// The linked node and its output, or null where there is none; then that has been told, unless the node's
  /// type is unknown, which was told before.
  int findOutput(const LinkEntry& link, const std::string& where, const PortInfo*& output) {
    if (link.node.empty()) return -1;  // no link: told by the reader
    if (!wrongEnds_.empty() && wrongEnds_.contains(link.named.text())) return -1;
    const int from = graph_.find(link.node);
    if (from < 0) {
      diagnostics_.add(link.origin, where, "there is no node " + inQuotes(link.node), nearNode(link.node));
      return from;
    }
    const NodeType* type = graph_.nodes[static_cast<std::size_t>(from)].type;
    if (type == nullptr) return from;
    if (type->outputs.empty()) {
      diagnostics_.add(link.origin, where,
                       inQuotes(link.node) + " is a " + type->name + ", which has no outputs",
                       "wire another node");
    } else if (link.output.empty()) {
      output = &type->outputs.front();
    } else {
      const TypeNames& names = namesOf(*type);
      const auto found = names.outputs.find(link.output);
      if (found != names.outputs.end())
        output = &type->outputs[found->second];
      else
        diagnostics_.add(link.origin, where, type->name + " has no output " + inQuotes(link.output),
                         suggestion(link.output, names.outputList, "outputs", commandFor(*type)));
    }
    return from;
  }

  void readParams(std::size_t i) {
    const NodeEntry& entry = file_.nodes[i];
    Graph::Node& node = graph_.nodes[i];
    const TypeNames& names = namesOf(*node.type);
    std::set<std::string> given;  // a parameter that is given wrongly is not also missing
    for (const LinkEntry& link : entry.in) given.insert(link.port);
    for (const Setting& setting : entry.params) {
      const auto found = names.params.find(setting.name);
      const std::string where = node.name + '.' + setting.name;
      if (found == names.params.end())
        diagnostics_.add(
            setting.origin, where, node.type->name + " has no parameter " + inQuotes(setting.name),
            names.inputs.contains(setting.name)
                ? "it is an input: wire it in \"in\""
                : suggestion(setting.name, names.paramList, "parameters", commandFor(*node.type)));
      else if (isOverridden(static_cast<int>(i), setting.name))
        continue;
      else if (!given.insert(setting.name).second)
        diagnostics_.add(setting.origin, where, "the parameter is both set and wired", "keep one of the two");
      else
        readParam(i, found->second, setting.value, entry.scope);
    }
    if (const auto found = overrides_.find(static_cast<int>(i)); found != overrides_.end())
      for (const Override& o : found->second) {
        given.insert(o.param);
        readParam(i, names.params.at(o.param), parseTyped(o.assignment.text, o.assignment.source), {});
      }
    for (const ParamInfo& info : node.type->params) {
      if (!node.params.contains(info.name))
        node.params[info.name] = defaultParam(info, file_.source->directory);
      if (info.required && !given.contains(info.name) && !entry.inIsUnread && !entry.paramsAreUnread)
        diagnostics_.add(node.origin, node.name + '.' + info.name, "the parameter is missing",
                         "it would have to be " + expectation(info));
    }
  }

  void readParam(std::size_t i, std::size_t param, const JsonValue& value, const std::string& scope) {
    Graph::Node& node = graph_.nodes[i];
    const ParamInfo& info = node.type->params[param];
    node.origins[info.name] = value.origin;
    const std::uint64_t reads = readParam(node, info, value, scope);
    if (reads == 0) return;
    own_[i] |= reads;
    swept_[i].push_back({param, value, scope});
  }

  /// Sets the node's parameter, and tells what of the sweep it depends on.
  std::uint64_t readParam(Graph::Node& node, const ParamInfo& info, const JsonValue& value,
                          const std::string& scope) {
    const std::string where = node.name + '.' + info.name;
    auto expanded = variables_.expand(value, where, scope);
    if (!expanded) return 0;
    if (info.kind == ParamKind::OutputFile && expanded->value.kind == JsonValue::Kind::String)
      putFrame(*expanded, value.origin, where);
    auto read = sherd::readParam(info, expanded->value, expanded->base->directory);
    if (read.ok())
      node.params[info.name] = std::move(read).value();
    else
      diagnostics_.add(value.origin, where, read.error());
    if (isPath(info.kind) && expanded->base->typed) node.typedPaths.push_back(info.name);
    return expanded->reads;
  }

  /// "name.####.png" is the frame with four digits at least, as in other programs.
  void putFrame(Expanded& expanded, const Origin& origin, const std::string& where) {
    std::string& text = expanded.value.text;
    const std::size_t begin = text.find("##");
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(text.find_first_not_of('#', begin), text.size());
    const auto frame = variables_.frameText(static_cast<int>(end - begin));
    if (!frame) {
      diagnostics_.add(origin, where,
                       inQuotes(text) + " has a place for the frame, and the graph has no frames",
                       "leave the # out, or say --frames 1001-1040");
      return;
    }
    text.replace(begin, end - begin, *frame);
    expanded.reads |= 1;
  }

  void reread(int node, const std::vector<int>& at, Graph::Node& copy) {
    variables_.moveTo(at);
    for (const SweptParam& swept : swept_[static_cast<std::size_t>(node)])
      readParam(copy, copy.type->params[swept.param], swept.value, swept.scope);
  }

  void findTargets() {
    for (const TargetEntry& entry : file_.targets) {
      Graph::Target& target = graph_.targets.emplace_back();
      target.name = entry.name;
      for (const auto& [name, origin] : entry.nodes) {
        const int i = graph_.find(name);
        if (i >= 0)
          target.nodes.push_back(i);
        else
          diagnostics_.add(origin, "targets." + entry.name, "there is no node " + inQuotes(name),
                           nearNode(name));
      }
    }
  }

  const GraphFile& file_;
  const Registry& registry_;
  Diagnostics& diagnostics_;
  Variables variables_;
  std::set<std::string> wrongEnds_;  ///< links that were told of where a subgraph's ends are
  Graph graph_;
  std::vector<std::string> nodeNames_;
  std::size_t comparisonsLeft_ = 200000;
  std::unordered_map<const NodeType*, std::unique_ptr<TypeNames>> typeNames_;
  std::map<int, std::vector<Override>> overrides_;
  Sweep sweep_;
  std::vector<std::uint64_t> own_;              ///< per node: what of the sweep its own parameters depend on
  std::vector<std::vector<SweptParam>> swept_;  ///< per node: those parameters
};

}  // namespace

Graph checkGraph(const GraphFile& file, const Registry& registry, const Overrides& overrides,
                 const Environment& environment, Diagnostics& diagnostics) {
  const Overrides expanded = withSubgraphOverrides(file, overrides, diagnostics);
  Graph graph = Checker(file, registry, expanded, environment, diagnostics).check();
  graph.groups = groupsOf(file, graph);
  checkUnusedSubgraphs(file, registry, environment, diagnostics);
  return graph;
}

}  // namespace sherd
