#include "cli/report_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace sherd {

std::string ReportGroup::stateText() const {
  std::string text;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] == static_cast<int>(all)) return kShownStates[s].name;
    if (counts[s] > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[s], kShownStates[s].name);
  }
  return text;
}

std::size_t shownState(const std::string& state) {
  for (std::size_t s = 0; s < kShownStates.size(); ++s)
    if (state == kShownStates[s].name) return s;
  return kShownStates.size() - 1;
}

ReportGroups groupNodes(const ReportData& data) {
  ReportGroups grouped;
  std::map<std::pair<std::string, std::string>, int> known;
  std::vector<int> groupOf;
  for (std::size_t n = 0; n < data.nodes.size(); ++n) {
    const ReportNode& node = data.nodes[n];
    const auto [entry, isNew] =
        known.try_emplace({node.graph, node.name}, static_cast<int>(grouped.groups.size()));
    if (isNew) grouped.groups.emplace_back();
    ReportGroup& group = grouped.groups[static_cast<std::size_t>(entry->second)];
    const std::size_t state = shownState(node.state);
    group.state = isNew ? state : std::min(group.state, state);
    ++group.counts[state];
    group.runs.push_back(static_cast<int>(n));
    ++group.all;
    group.ms += node.ms;
    group.memoryBytes += node.memoryBytes;
    group.cacheBytes += node.cacheBytes;
    groupOf.push_back(entry->second);
  }
  std::set<std::tuple<int, std::string, int, std::string>> seen;
  for (const ReportWire& wire : data.wires) {
    const int from = groupOf.at(static_cast<std::size_t>(wire.from));
    const int to = groupOf.at(static_cast<std::size_t>(wire.to));
    if (seen.emplace(from, wire.output, to, wire.input).second)
      grouped.wires.push_back({from, to, wire.output, wire.input});
  }
  return grouped;
}

}  // namespace sherd
