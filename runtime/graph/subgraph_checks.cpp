#include <algorithm>
#include <unordered_map>

#include "graph/subgraphs.h"
#include "graph/suggest.h"

namespace sherd {
namespace {

/// All that travels on wires of the known node types, and what may be wired to parameters.
std::set<std::string> knownTypes(const Registry& registry) {
  std::set<std::string> types{"Boolean", "Integer", "Number", "String"};
  for (const NodeType* type : registry.all())
    for (const auto* ports : {&type->inputs, &type->outputs})
      for (const PortInfo& port : *ports) types.insert(port.type);
  return types;
}

/// An integer may go where a number is declared: parameters take it.
bool fits(const std::string& type, const std::string& declared) {
  return type == declared || (type == "Integer" && declared == "Number");
}

/// Finds what is wired to the ends of subgraphs and doesn't fit there.
class EndsCheck {
 public:
  EndsCheck(const GraphFile& file, const Registry& registry, Diagnostics& diagnostics)
      : diagnostics_(diagnostics), types_(knownTypes(registry)) {
    for (const NodeEntry& node : file.nodes) nodeTypes_.emplace(node.name, registry.find(node.type));
  }

  void check(const ExpectedType& expected) {
    if (!types_.contains(expected.type))
      diagnostics_.add(
          expected.typeOrigin, expected.where, "there is no type " + inQuotes(expected.type),
          suggestion(expected.type, {types_.begin(), types_.end()}, "types", "sherd nodes TYPE"));
    const auto node = nodeTypes_.find(expected.node);
    if (node == nodeTypes_.end() || node->second == nullptr) return;  // checkGraph tells of that
    const std::string named = expected.named.text();
    if (wrong_.contains(named)) return;
    const NodeType& type = *node->second;
    const PortInfo* output = expected.output.empty() && !type.outputs.empty() ? &type.outputs.front()
                                                                              : type.output(expected.output);
    if (output == nullptr)
      complainOfOutput(expected, type);
    else if (types_.contains(expected.type) && !fits(output->type, expected.type))
      diagnostics_.add(expected.origin, expected.where,
                       inQuotes(expected.node + '.' + output->name) + " is of type " + output->type,
                       "the subgraph declares type " + expected.type);
    else
      return;
    wrong_.insert(named);
  }

  std::set<std::string> wrong() { return std::move(wrong_); }

 private:
  void complainOfOutput(const ExpectedType& expected, const NodeType& type) {
    std::vector<std::string> names;
    for (const PortInfo& output : type.outputs) names.push_back(output.name);
    if (names.empty())
      diagnostics_.add(expected.origin, expected.where,
                       inQuotes(expected.node) + " is a " + type.name + ", which has no outputs",
                       "wire another node");
    else
      diagnostics_.add(expected.origin, expected.where,
                       type.name + " has no output " + inQuotes(expected.output),
                       suggestion(expected.output, names, "outputs", "sherd nodes " + type.name));
  }

  Diagnostics& diagnostics_;
  std::set<std::string> types_, wrong_;
  std::unordered_map<std::string, const NodeType*> nodeTypes_;
};

const GroupEntry* findGroup(const GraphFile& file, const std::string& name) {
  for (const GroupEntry& group : file.groups)
    if (group.name == name) return &group;
  return nullptr;
}

/// The variables of a node that stood for a subgraph, without its name.
std::vector<std::string> variablesOf(const GraphFile& file, const GroupEntry& group) {
  std::vector<std::string> names;
  const std::string prefix = group.name + '/';
  for (const Setting& variable : file.vars)
    if (variable.name.starts_with(prefix) && variable.name.find('/', prefix.size()) == std::string::npos)
      names.push_back(variable.name.substr(prefix.size()));
  return names;
}

}  // namespace

std::vector<std::string> nodesOfGroup(const GraphFile& file, const GroupEntry& group) {
  std::vector<std::string> nodes;
  for (const auto& [name, link] : group.outputs) {
    std::string node = link.substr(0, link.find('.'));
    if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(std::move(node));
  }
  if (!nodes.empty()) return nodes;
  for (std::size_t i = 0; i < group.nodes; ++i) nodes.push_back(file.nodes[group.firstNode + i].name);
  return nodes;
}

std::map<std::string, std::vector<int>> groupsOf(const GraphFile& file, const Graph& graph) {
  std::map<std::string, std::vector<int>> groups;
  for (const GroupEntry& group : file.groups)
    for (const std::string& node : nodesOfGroup(file, group))
      if (const auto found = graph.index.find(node); found != graph.index.end())
        for (int k = 0; k < found->second.count; ++k) groups[group.name].push_back(found->second.first + k);
  return groups;
}

std::set<std::string> checkSubgraphEnds(const GraphFile& file, const Registry& registry,
                                        Diagnostics& diagnostics) {
  if (file.expectedTypes.empty()) return {};
  EndsCheck check(file, registry, diagnostics);
  for (const ExpectedType& expected : file.expectedTypes) check.check(expected);
  return check.wrong();
}

void checkUnusedSubgraphs(const GraphFile& file, const Registry& registry, const Environment& environment,
                          Diagnostics& diagnostics) {
  // It may read the frame, which there is once it is used.
  for (const GraphFile& unused : file.unused)
    checkGraph(unused, registry, {.vars = {}, .sets = {}, .frames = "1"}, environment, diagnostics);
}

Overrides withSubgraphOverrides(const GraphFile& file, const Overrides& overrides, Diagnostics& diagnostics) {
  Overrides result{overrides.vars, {}, overrides.frames};
  for (const Assignment& assignment : overrides.sets) {
    const std::size_t dot = assignment.name.find('.');
    const GroupEntry* group = findGroup(file, assignment.name.substr(0, dot));
    if (group == nullptr || dot == std::string::npos || dot + 1 == assignment.name.size()) {
      result.sets.push_back(assignment);
      continue;
    }
    const std::string name = assignment.name.substr(dot + 1);
    const std::vector<std::string> known = variablesOf(file, *group);
    if (std::find(known.begin(), known.end(), name) != known.end())
      result.vars.push_back({group->name + '/' + name, assignment.text, assignment.source});
    else
      diagnostics.add({assignment.source, 0, 0}, assignment.name,
                      group->subgraph + " has no parameter " + inQuotes(name),
                      suggestion(name, known, "parameters"));
  }
  return result;
}

void refuseSubgraphFile(const GraphFile& file, Diagnostics& diagnostics) {
  if (file.subgraph == nullptr) return;
  const std::string name = file.source->name;
  diagnostics.add({file.source, 0, 0}, "", "this is a subgraph, which can't be run by itself",
                  "name it in a graph, as in \"subgraphs\": { \"Name\": \"" + name +
                      "\" }, and use it with \"type\": \"Name\"");
}

}  // namespace sherd
