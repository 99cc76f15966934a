#include "graph/loops.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr std::size_t kLongestShown = 12;

std::string loopText(const Graph& graph, const std::vector<int>& loop) {
  std::string text;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop.size() > kLongestShown && i == kLongestShown / 2) {
      text += "… → ";
      i = loop.size() - kLongestShown / 2;
    }
    text += graph.nodes[static_cast<std::size_t>(loop[i])].name + " → ";
  }
  return text + graph.nodes[static_cast<std::size_t>(loop.front())].name;
}

const Graph::Wire* wireAt(const Graph::Node& node, std::size_t i) {
  if (i < node.inputs.size()) return &node.inputs[i];
  i -= node.inputs.size();
  return i < node.wiredParams.size() ? &node.wiredParams[i] : nullptr;
}

std::string portName(const Graph::Node& node, const Graph::Wire* wire) {
  const bool isInput = wire >= node.inputs.data() && wire < node.inputs.data() + node.inputs.size();
  const auto place = static_cast<std::size_t>(wire->to);
  return isInput ? node.type->inputs[place].name : node.type->params[place].name;
}

}  // namespace

void reportLoops(const Graph& graph, Diagnostics& diagnostics) {
  enum class Mark { New, OnPath, Done };
  std::vector<Mark> marks(graph.nodes.size(), Mark::New);
  std::vector<std::pair<int, std::size_t>> path;  // a node and its next wire to follow
  for (std::size_t start = 0; start < graph.nodes.size(); ++start) {
    if (marks[start] != Mark::New) continue;
    path.emplace_back(static_cast<int>(start), 0);
    marks[start] = Mark::OnPath;
    while (!path.empty()) {
      const int at = path.back().first;
      const Graph::Wire* wire = wireAt(graph.nodes[static_cast<std::size_t>(at)], path.back().second++);
      if (wire == nullptr) {
        marks[static_cast<std::size_t>(at)] = Mark::Done;
        path.pop_back();
        continue;
      }
      Mark& mark = marks[static_cast<std::size_t>(wire->node)];
      if (mark == Mark::New) {
        mark = Mark::OnPath;
        path.emplace_back(wire->node, 0);
      } else if (mark == Mark::OnPath) {
        std::vector<int> loop;
        auto first = std::find_if(path.begin(), path.end(),
                                  [&](const auto& step) { return step.first == wire->node; });
        for (auto it = first; it != path.end(); ++it) loop.push_back(it->first);
        std::reverse(loop.begin(), loop.end());  // the search goes against the wires
        const std::string port = portName(graph.nodes[static_cast<std::size_t>(at)], wire);
        diagnostics.add(graph.originOf(at, port), graph.nameOf(at, port),
                        "the wires form a loop: " + loopText(graph, loop), "unplug one of them");
      }
    }
  }
}

}  // namespace sherd
