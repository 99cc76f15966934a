#include "cli/report_fold.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

constexpr std::uint64_t kBoxBytes =
    1400;  // of a box, a row and the frame of its details, without their texts
constexpr std::uint64_t kRunBytes = 250;
constexpr std::uint64_t kPortBytes = 150, kParamBytes = 110, kWireBytes = 300;
constexpr std::uint64_t kLineBytes = 5;

std::uint64_t bytesOf(const std::vector<std::string>& lines) {
  std::uint64_t bytes = 0;
  for (const std::string& line : lines) bytes += line.size() + kLineBytes;
  return bytes;
}

/// Of one run in the details: its parameters may be others than those of the node's first run.
std::uint64_t runBytes(const ReportNode& node) {
  std::uint64_t bytes = kRunBytes + node.context.size() + node.why.size() + node.error.size() +
                        bytesOf(node.messages) + bytesOf(node.written);
  for (const ReportParam& param : node.params)
    bytes += kParamBytes + param.name.size() + param.value.size() + param.fallback.size() +
             param.unit.size() + param.help.size();
  return bytes;
}

std::uint64_t boxBytes(const ReportNode& node) {
  std::uint64_t bytes =
      kBoxBytes + 4 * node.name.size() + 3 * node.type.size() + node.help.size() + node.graph.size();
  for (const auto* ports : {&node.inputs, &node.outputs})
    for (const ReportPort& port : *ports)
      bytes += kPortBytes + 2 * port.name.size() + port.type.size() + port.help.size();
  return bytes + kWireBytes * node.inputs.size();
}

class Fold {
 public:
  Fold(const ReportData& data, ReportGroups& grouped, std::uint64_t mostBytes)
      : data_(data), grouped_(grouped), most_(mostBytes), shown_(grouped.groups.size(), 0) {}

  void run() {
    if (everythingFits()) return;
    std::vector<std::vector<int>> kept(grouped_.groups.size());
    keepFirstRuns(kept);
    keepMoreRuns(kept);
    for (std::size_t g = 0; g < kept.size(); ++g) {
      std::sort(kept[g].begin(), kept[g].end());
      grouped_.groups[g].runs = std::move(kept[g]);
    }
    leaveOutEmptyGroups();
  }

 private:
  const ReportNode& node(int run) const { return data_.nodes[static_cast<std::size_t>(run)]; }
  bool matters(int a, int b) const {
    const std::size_t stateA = shownState(node(a).state), stateB = shownState(node(b).state);
    if (stateA != stateB) return stateA < stateB;
    if (node(a).ms != node(b).ms) return node(a).ms > node(b).ms;
    return a < b;
  }

  bool everythingFits() const {
    std::uint64_t bytes = 0;
    for (const ReportGroup& group : grouped_.groups) {
      bytes += boxBytes(node(group.runs.front()));
      for (const int run : group.runs) bytes += runBytes(node(run));
    }
    return bytes <= most_;
  }

  /// The run of each node that matters most, as far as they fit.
  void keepFirstRuns(std::vector<std::vector<int>>& kept) {
    std::vector<std::pair<int, std::size_t>> best;
    for (std::size_t g = 0; g < grouped_.groups.size(); ++g) {
      const std::vector<int>& runs = grouped_.groups[g].runs;
      best.emplace_back(
          *std::min_element(runs.begin(), runs.end(), [this](int a, int b) { return matters(a, b); }), g);
    }
    std::sort(best.begin(), best.end(),
              [this](const auto& a, const auto& b) { return matters(a.first, b.first); });
    for (const auto& [run, g] : best)
      if (take(boxBytes(node(run)) + runBytes(node(run)))) kept[g].push_back(run);
  }

  void keepMoreRuns(std::vector<std::vector<int>>& kept) {
    std::vector<std::pair<int, std::size_t>> others;
    for (std::size_t g = 0; g < kept.size(); ++g)
      if (!kept[g].empty())
        for (const int run : grouped_.groups[g].runs)
          if (run != kept[g].front()) others.emplace_back(run, g);
    std::sort(others.begin(), others.end(),
              [this](const auto& a, const auto& b) { return matters(a.first, b.first); });
    for (const auto& [run, g] : others)
      if (take(runBytes(node(run)))) kept[g].push_back(run);
  }

  /// Whether it fits. Once something did not, nothing that matters less is shown either.
  bool take(std::uint64_t bytes) {
    full_ = full_ || used_ + bytes > most_;
    if (!full_) used_ += bytes;
    return !full_;
  }

  void leaveOutEmptyGroups() {
    std::vector<ReportGroup> groups;
    for (std::size_t g = 0; g < grouped_.groups.size(); ++g) {
      shown_[g] = grouped_.groups[g].runs.empty() ? -1 : static_cast<int>(groups.size());
      if (shown_[g] >= 0)
        groups.push_back(std::move(grouped_.groups[g]));
      else
        ++grouped_.leftOut;
    }
    grouped_.groups = std::move(groups);
    std::vector<GroupWire> wires;
    for (GroupWire& wire : grouped_.wires) {
      wire.from = shown_[static_cast<std::size_t>(wire.from)];
      wire.to = shown_[static_cast<std::size_t>(wire.to)];
      if (wire.from >= 0 && wire.to >= 0) wires.push_back(std::move(wire));
    }
    grouped_.wires = std::move(wires);
  }

  const ReportData& data_;
  ReportGroups& grouped_;
  const std::uint64_t most_;
  std::uint64_t used_ = 0;
  bool full_ = false;
  std::vector<int> shown_;  ///< the new number of each group; −1: left out
};

}  // namespace

void foldReport(const ReportData& data, ReportGroups& grouped, std::uint64_t mostBytes) {
  Fold(data, grouped, mostBytes).run();
}

}  // namespace sherd
