#include "graph/graph.h"

#include <algorithm>

#include "graph/suggest.h"

namespace sherd {

int Graph::find(const std::string& name) const {
  const auto found = index.find(name);
  return found == index.end() ? -1 : found->second.first;
}

Origin Graph::originOf(int node, const std::string& port) const {
  const Node& at = nodes[static_cast<std::size_t>(node)];
  const auto found = at.origins.find(port);
  return found == at.origins.end() ? at.origin : found->second;
}

std::string Graph::nameOf(int node, const std::string& port) const {
  const std::string& name = nodes[static_cast<std::size_t>(node)].name;
  return port.empty() ? name : name + '.' + port;
}

std::string Graph::labelOf(int node) const {
  const Node& at = nodes[static_cast<std::size_t>(node)];
  const std::string& label = contexts[static_cast<std::size_t>(at.context)].label;
  return label.empty() ? at.name : at.name + " (" + label + ')';
}

void append(Graph& graph, const Graph& other, const std::string& shot) {
  if (graph.nodes.empty() && graph.shots == std::vector<std::string>{""}) graph.shots.clear();
  const int nodes = static_cast<int>(graph.nodes.size()), contexts = static_cast<int>(graph.contexts.size());
  graph.contexts.insert(graph.contexts.end(), other.contexts.begin(), other.contexts.end());
  for (Graph::Node node : other.nodes) {
    node.context = node.context == 0 ? 0 : node.context + contexts;
    node.shot = static_cast<int>(graph.shots.size());
    for (auto* wires : {&node.inputs, &node.wiredParams})
      for (Graph::Wire& wire : *wires) wire.node += nodes;
    graph.nodes.push_back(std::move(node));
  }
  graph.shots.push_back(shot);
}

namespace {

Error unknown(const std::string& what, const std::string& name, const std::vector<std::string>& known,
              const std::string& kind) {
  return Error{what + ' ' + inQuotes(name), suggestion(name, known, kind), {}, Error::Kind::Input};
}

/// All frames and wedges of a node, or of those whose outputs are a subgraph's.
std::vector<int> nodesNamed(const Graph& graph, const std::string& name) {
  if (const auto group = graph.groups.find(name); group != graph.groups.end()) return group->second;
  std::vector<int> nodes;
  if (const auto found = graph.index.find(name); found != graph.index.end())
    for (int k = 0; k < found->second.count; ++k) nodes.push_back(found->second.first + k);
  return nodes;
}

std::vector<int> defaultNodes(const Graph& graph) {
  std::vector<int> wanted;
  for (const Graph::Target& target : graph.targets)
    wanted.insert(wanted.end(), target.nodes.begin(), target.nodes.end());
  if (!graph.targets.empty()) return wanted;
  const int count = static_cast<int>(graph.nodes.size());
  for (int i = 0; i < count; ++i)
    if (graph.nodes[static_cast<std::size_t>(i)].type->writesFiles) wanted.push_back(i);
  if (!wanted.empty()) return wanted;
  std::vector<bool> used(graph.nodes.size(), false);
  for (const Graph::Node& node : graph.nodes)
    for (const auto* wires : {&node.inputs, &node.wiredParams})
      for (const Graph::Wire& wire : *wires) used[static_cast<std::size_t>(wire.node)] = true;
  for (int i = 0; i < count; ++i)
    if (!used[static_cast<std::size_t>(i)]) wanted.push_back(i);
  return wanted;
}

}  // namespace

Result<std::vector<int>> wantedNodes(const Graph& graph, const std::string& target, const std::string& to) {
  std::vector<int> wanted;
  if (!to.empty()) {
    wanted = nodesNamed(graph, to);
    std::vector<std::string> names;
    for (const auto& [name, instances] : graph.index) names.push_back(name);
    for (const auto& [name, nodes] : graph.groups) names.push_back(name);
    std::sort(names.begin(), names.end());
    if (wanted.empty()) return unknown("the graph has no node", to, names, "nodes");
  } else if (!target.empty()) {
    std::vector<std::string> names;
    for (const Graph::Target& known : graph.targets) {
      names.push_back(known.name);
      if (known.name == target) wanted = known.nodes;
    }
    if (std::find(names.begin(), names.end(), target) == names.end())
      return unknown("the graph has no target", target, names, "targets");
  } else {
    wanted = defaultNodes(graph);
  }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  return wanted;
}

std::vector<int> neededNodes(const Graph& graph, const std::vector<int>& wanted) {
  std::vector<bool> needed(graph.nodes.size(), false);
  std::vector<int> open = wanted;
  while (!open.empty()) {
    const auto i = static_cast<std::size_t>(open.back());
    open.pop_back();
    if (needed[i]) continue;
    needed[i] = true;
    for (const auto* wires : {&graph.nodes[i].inputs, &graph.nodes[i].wiredParams})
      for (const Graph::Wire& wire : *wires) open.push_back(wire.node);
  }
  std::vector<int> list;
  for (std::size_t i = 0; i < needed.size(); ++i)
    if (needed[i]) list.push_back(static_cast<int>(i));
  return list;
}

}  // namespace sherd
