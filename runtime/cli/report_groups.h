// The report's nodes by name: what is drawn as one box and listed in one row.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cli/report.h"

namespace sherd {

/// How a state is shown. The first matters most: a box of several states has the colour of the first of them.
struct ShownState {
  const char* name;   ///< ReportNode::state
  const char* style;  ///< of the page's style classes and marks
};
inline constexpr std::array<ShownState, 5> kShownStates{{{"failed", "failed"},
                                                         {"skipped", "skipped"},
                                                         {"run", "run"},
                                                         {"hit", "hit"},
                                                         {"not needed", "unneeded"}}};

/// All frames and wedges of one node.
struct ReportGroup {
  std::vector<int> runs;  ///< those that are shown: entries of ReportData::nodes, in their order; never empty
  std::size_t all = 0;    ///< how many there are, with those that are left out
  std::array<int, kShownStates.size()> counts{};
  std::size_t state = 0;  ///< entry of kShownStates
  double ms = 0;          ///< of all together
  std::uint64_t memoryBytes = 0, cacheBytes = 0;

  /// "run", or "2 failed, 38 run".
  std::string stateText() const;
};

/// A wire between groups; those of different frames and wedges are one.
struct GroupWire {
  int from = 0, to = 0;  ///< entries of ReportGroups::groups
  std::string output, input;
};

struct ReportGroups {
  std::vector<ReportGroup> groups;  ///< in the order of their first nodes
  std::vector<GroupWire> wires;
  std::size_t leftOut =
      0;  ///< nodes that are not among `groups`, since the page would be too large (report_fold.h)
};

/// Entry of kShownStates; a word that isn't there counts as "not needed".
std::size_t shownState(const std::string& state);
ReportGroups groupNodes(const ReportData& data);

}  // namespace sherd
