#include "graph/subgraphs.h"

#include <algorithm>
#include <set>

#include "graph/subgraph_instance.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

using State = Resolved::State;

class Expander {
 public:
  Expander(const SubgraphLibrary& library, Diagnostics& diagnostics)
      : library_(library), diagnostics_(diagnostics) {}

  /// The file's own nodes and all that they stand for.
  void expandNodes(GraphFile& file) {
    const std::vector<NodeEntry> nodes = std::move(file.nodes);
    file.nodes.clear();
    Instance top;
    top.scope = &library_.scope();
    addChildren(top, nodes, 0);
    if (isTooLarge_) return;
    emit(top, nodes, file);
    expandTargets(file);
  }

  /// A subgraph as the only content of a file, its inputs open.
  void expandAlone(const Subgraph& subgraph, const SubgraphScope& scope, const std::string& name,
                   GraphFile& file) {
    Instance top;
    top.subgraph = name;
    top.definition = &subgraph;
    top.scope = &scope;
    top.prefix = name.empty() ? "" : name + '/';
    stack_ = {&top};
    addChildren(top, subgraph.nodes, 0);
    stack_.clear();
    if (isTooLarge_) return;
    emitVariables(top, file);
    emit(top, subgraph.nodes, file);
    emitOutputs(top, file, nullptr);
    for (const DeclaredPort& port : subgraph.inputs)
      expect(port, port.origin, top.prefix + "inputs." + port.name, {}, file);
  }

  bool isUsed(const Subgraph* subgraph) const { return used_.contains(subgraph); }

 private:
  static constexpr std::size_t kDeepest = 64, kMostNodes = 250000;

  // --- The tree of what stands for what.

  void addChildren(Instance& instance, const std::vector<NodeEntry>& nodes, std::size_t depth) {
    used_.insert(instance.definition);
    count_ += nodes.size();
    for (const NodeEntry& node : nodes) {
      instance.names.insert(node.name);
      const KnownSubgraph* known = node.version == 0 ? instance.scope->find(node.type) : nullptr;
      if (known == nullptr) continue;
      auto child = std::make_unique<Instance>();
      child->subgraph = known->name;
      child->definition = known->definition;
      child->scope = known->scope;
      child->outer = &instance;
      child->node = &node;
      child->prefix = instance.prefix + node.name + '/';
      child->broken = !canExpand(*child, depth);
      if (!child->broken) {
        stack_.push_back(child.get());
        addChildren(*child, known->definition->nodes, depth + 1);
        stack_.pop_back();
      }
      instance.children.emplace(node.name, std::move(child));
    }
  }

  bool canExpand(const Instance& child, std::size_t depth) {
    if (child.definition == nullptr || isTooLarge_) return false;
    const std::string where = child.outer->prefix + child.node->name;
    auto refuse = [&](std::string what, std::string remedy) {
      diagnostics_.add(child.node->typeOrigin, where, std::move(what), std::move(remedy));
      return false;
    };
    const auto same = std::find_if(stack_.begin(), stack_.end(), [&](const Instance* around) {
      return around->definition == child.definition;
    });
    if (same != stack_.end()) {
      std::string loop;
      for (auto it = same; it != stack_.end(); ++it)
        loop += ((*it)->subgraph.empty() ? child.subgraph : (*it)->subgraph) + " → ";
      return refuse("the subgraph contains itself: " + loop + child.subgraph, "take it out of itself");
    }
    if (depth >= kDeepest) return refuse("subgraphs are nested more than 64 deep", "nest them less");
    isTooLarge_ = count_ + child.definition->nodes.size() > kMostNodes;
    if (isTooLarge_) return refuse("the subgraphs stand for more than 250,000 nodes", "use fewer");
    return true;
  }

  // --- The flat graph.

  void emit(Instance& instance, const std::vector<NodeEntry>& nodes, GraphFile& file) {
    for (const NodeEntry& node : nodes) {
      const auto child = instance.children.find(node.name);
      if (child == instance.children.end())
        emitNode(instance, node, file);
      else
        emitChild(instance, node, *child->second, file);
    }
  }

  void emitNode(Instance& instance, const NodeEntry& node, GraphFile& file) {
    NodeEntry& entry = file.nodes.emplace_back(node);
    entry.name = instance.prefix + node.name;
    entry.scope = instance.prefix;
    entry.in.clear();
    for (const LinkEntry& link : node.in) {
      const Resolved end = followLink(instance, link, instance.place(node, link.port), diagnostics_);
      if (end.state != State::Absent)
        entry.in.push_back({link.port, link.origin, end.node, end.output, end.named});
    }
  }

  void emitChild(Instance& instance, const NodeEntry& node, Instance& child, GraphFile& file) {
    const std::size_t group = file.groups.size();
    file.groups.push_back({instance.prefix + node.name, node.origin, {}, child.subgraph});
    if (child.broken) return;
    checkInputs(instance, node, child, file);
    checkParams(instance, node, *child.definition);
    emitVariables(child, file);
    file.groups[group].firstNode = file.nodes.size();
    emit(child, child.definition->nodes, file);
    file.groups[group].nodes = file.nodes.size() - file.groups[group].firstNode;
    emitOutputs(child, file, &group);
  }

  /// The links and missing links of a node that stands for a subgraph.
  void checkInputs(Instance& instance, const NodeEntry& node, const Instance& child, GraphFile& file) {
    const Subgraph& subgraph = *child.definition;
    std::set<std::string> wired;
    for (const LinkEntry& link : node.in) {
      wired.insert(link.port);
      const std::string where = instance.place(node, link.port);
      const Resolved end = followLink(instance, link, where, diagnostics_);
      if (const DeclaredPort* port = findPort(subgraph.inputs, link.port))
        expect(*port, link.origin, where, end, file);
      else
        diagnostics_.add(link.origin, where, child.subgraph + " has no input " + inQuotes(link.port),
                         isVariable(subgraph, link.port)
                             ? "it is a parameter: set it in \"params\""
                             : suggestion(link.port, namesOf(subgraph.inputs), "inputs"));
      if (end.state == State::Absent) wired.erase(link.port);
    }
    for (const DeclaredPort& port : subgraph.inputs)
      if (!port.optional && !wired.contains(port.name) && !node.inIsUnread)
        diagnostics_.add(
            node.origin, instance.place(node, port.name), "the input is not connected",
            port.type.empty() ? "wire an output to it" : "wire an output of type " + port.type + " to it");
  }

  static bool isVariable(const Subgraph& subgraph, const std::string& name) {
    return std::any_of(subgraph.vars.begin(), subgraph.vars.end(),
                       [&](const Setting& variable) { return variable.name == name; });
  }

  void checkParams(const Instance& instance, const NodeEntry& node, const Subgraph& subgraph) {
    for (const Setting& setting : node.params) {
      const std::string where = instance.place(node, setting.name);
      if (isVariable(subgraph, setting.name)) {
        const JsonValue::Kind kind = setting.value.kind;
        if (kind == JsonValue::Kind::Null || kind == JsonValue::Kind::Object)
          diagnostics_.add(setting.value.origin, where, "this is " + kindName(kind),
                           "it would have to be a number, string, boolean or list");
        continue;
      }
      std::vector<std::string> names;
      for (const Setting& variable : subgraph.vars) names.push_back(variable.name);
      diagnostics_.add(setting.origin, where, node.type + " has no parameter " + inQuotes(setting.name),
                       findPort(subgraph.inputs, setting.name) != nullptr
                           ? "it is an input: wire it in \"in\""
                           : suggestion(setting.name, names, "parameters"));
    }
  }

  static void emitVariables(const Instance& instance, GraphFile& file) {
    for (const Setting& variable : instance.definition->vars) {
      Setting& setting = file.vars.emplace_back(variable);
      setting.name = instance.prefix + variable.name;
      setting.scope = instance.prefix;
      if (instance.node == nullptr) continue;
      for (const Setting& given : instance.node->params)
        if (given.name == variable.name && given.value.kind != JsonValue::Kind::Null &&
            given.value.kind != JsonValue::Kind::Object)
          setting = {setting.name, given.origin, given.value, instance.outer->prefix};
    }
  }

  /// `group`: which of file.groups the instance is, or null.
  void emitOutputs(Instance& instance, GraphFile& file, const std::size_t* group) {
    for (const DeclaredPort& port : instance.definition->outputs) {
      const std::string where = instance.prefix + "outputs." + port.name;
      const Resolved end = followLink(instance, port.from, where, diagnostics_);
      if (!port.type.empty()) expect(port, port.from.origin, where, end, file);
      if (group != nullptr && end.state == State::Found)
        file.groups[*group].outputs.emplace_back(port.name,
                                                 end.output.empty() ? end.node : end.node + '.' + end.output);
    }
  }

  static void expect(const DeclaredPort& port, const Origin& origin, const std::string& where,
                     const Resolved& end, GraphFile& file) {
    if (port.type.empty()) return;
    const bool isFound = end.state == State::Found;
    file.expectedTypes.push_back({origin, where, port.type, port.typeOrigin, end.named,
                                  isFound ? end.node : "", isFound ? end.output : ""});
  }

  // --- Targets.

  static void expandTargets(GraphFile& file) {
    std::map<std::string, const GroupEntry*> groups;
    for (const GroupEntry& group : file.groups) groups.emplace(group.name, &group);
    for (TargetEntry& target : file.targets) {
      std::vector<std::pair<std::string, Origin>> nodes;
      for (auto& [name, origin] : target.nodes) {
        const auto group = groups.find(name);
        if (group == groups.end())
          nodes.emplace_back(name, origin);
        else
          for (std::string& node : nodesOfGroup(file, *group->second))
            nodes.emplace_back(std::move(node), origin);
      }
      target.nodes = std::move(nodes);
    }
  }

  const SubgraphLibrary& library_;
  Diagnostics& diagnostics_;
  std::vector<const Instance*> stack_;  ///< the subgraphs around the one that is being added
  std::set<const Subgraph*> used_;
  std::size_t count_ = 0;
  bool isTooLarge_ = false;  ///< which was reported; nothing more is expanded
};

GraphFile emptyLike(const GraphFile& file) {
  GraphFile other;
  other.source = file.source;
  other.fps = file.fps;
  return other;
}

}  // namespace

void expandSubgraphs(GraphFile& file, Diagnostics& diagnostics) {
  if (file.subgraph == nullptr && file.subgraphs.empty()) return;
  const SubgraphLibrary library(file.subgraph != nullptr ? file.subgraph->subgraphs : file.subgraphs,
                                diagnostics);
  Expander expander(library, diagnostics);
  if (file.subgraph != nullptr)
    expander.expandAlone(*file.subgraph, library.scope(), "", file);
  else
    expander.expandNodes(file);
  for (const KnownSubgraph& known : library.all()) {
    if (known.definition == nullptr || expander.isUsed(known.definition)) continue;
    GraphFile& alone = file.unused.emplace_back(emptyLike(file));
    expander.expandAlone(*known.definition, *known.scope, known.name, alone);
  }
}

}  // namespace sherd
