#include "graph/graph.h"

#include <algorithm>

#include "graph/suggest.h"

namespace sherd {

int Graph::find(const std::string& name) const {
  const auto found = index.find(name);
  return found == index.end() ? -1 : found->second;
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

namespace {

Error unknown(const std::string& what, const std::string& name, const std::vector<std::string>& known,
              const std::string& kind) {
  return Error{what + ' ' + inQuotes(name), suggestion(name, known, kind), {}, Error::Kind::Input};
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
    std::vector<std::string> names;
    for (const Graph::Node& node : graph.nodes) names.push_back(node.name);
    for (const auto& [name, nodes] : graph.groups) names.push_back(name);
    if (const auto group = graph.groups.find(to); group != graph.groups.end())
      wanted = group->second;
    else if (const int node = graph.find(to); node >= 0)
      wanted = {node};
    else
      return unknown("the graph has no node", to, names, "nodes");
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
