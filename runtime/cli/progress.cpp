#include "cli/progress.h"

#include <fmt/format.h>

#include <algorithm>

namespace sherd {
namespace {

constexpr std::size_t kWidestName = 32;

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 0, ' ');
}

std::string stateText(const NodeReport& report) {
  switch (report.state) {
    case NodeState::Run:
      return durationText(report.ms);
    case NodeState::Hit:
      return "cached";
    case NodeState::Failed:
      return "failed after " + durationText(report.ms);
    case NodeState::Skipped:
      return "skipped";
  }
  return {};
}

}  // namespace

std::string timeLeftText(double share, double elapsedMs) {
  if (elapsedMs < 1000 || share < 0.02 || share >= 1) return {};
  return "about " + durationText(std::max(1000.0, elapsedMs * (1 - share) / share)) + " left";
}

ProgressPrinter::ProgressPrinter(const Graph& graph, const std::vector<int>& needed, bool quiet,
                                 Console& console)
    : graph_(graph), console_(console), quiet_(quiet), total_(needed.size()) {
  for (const int i : needed) {
    const Graph::Node& node = graph.nodes[static_cast<std::size_t>(i)];
    nameWidth_ = std::min(kWidestName, std::max(nameWidth_, nameOf(i).size()));
    typeWidth_ = std::min(kWidestName, std::max(typeWidth_, node.type->name.size()));
  }
}

std::string ProgressPrinter::nameOf(int node) const {
  const std::string& shot =
      graph_.shots[static_cast<std::size_t>(graph_.nodes[static_cast<std::size_t>(node)].shot)];
  return (shot.empty() ? "" : shot + ": ") + graph_.labelOf(node);
}

void ProgressPrinter::started(int node) {
  running_[node] = 0;
  showLine(true);
}

void ProgressPrinter::progress(int node, double share) {
  running_[node] = share;
  showLine(false);
}

void ProgressPrinter::finished(const NodeReport& report) {
  running_.erase(report.node);
  ++ended_;
  const Graph::Node& node = graph_.nodes[static_cast<std::size_t>(report.node)];
  clearLine();
  const bool warned = std::any_of(report.messages.begin(), report.messages.end(),
                                  [](const Message& m) { return m.level == LogLevel::Warning; });
  // Of thousands of frames that are there already, the count at the end says enough.
  const bool isQuietHit = report.state == NodeState::Hit && total_ > kMostHits && !warned;
  if (report.state != NodeState::Skipped && !isQuietHit && (!quiet_ || warned)) {
    console_.out << padded(nameOf(report.node), nameWidth_) << "  " << padded(node.type->name, typeWidth_)
                 << "  " << stateText(report) << '\n';
    printMessages(report);
  }
  console_.out.flush();
  showLine(true);
}

void ProgressPrinter::printMessages(const NodeReport& report) {
  std::size_t shown = 0, left = 0;
  for (const Message& message : report.messages) {
    const bool warning = message.level == LogLevel::Warning;
    if (quiet_ && !warning) continue;
    if (shown++ < kMostMessages)
      console_.out << "    " << (warning ? "warning: " : "") << message.text << '\n';
    else
      ++left;
  }
  if (left > 0) console_.out << "    … and " << countText(left, "more message") << '\n';
}

void ProgressPrinter::showLine(bool now) {
  if (!console_.terminal || quiet_) return;
  const auto time = Clock::now();
  if (!now && time - lastShown_ < std::chrono::milliseconds(100)) return;
  lastShown_ = time;
  double done = static_cast<double>(ended_);
  std::string names;
  for (const auto& [node, share] : running_) {
    done += share;
    names += (names.empty() ? "" : ", ") + nameOf(node);
    if (share > 0) names += fmt::format(" {:.0f} %", share * 100);
  }
  const double share = total_ == 0 ? 1 : done / static_cast<double>(total_);
  std::string line = fmt::format("{:3.0f} %  {}", share * 100, names);
  const std::string left =
      timeLeftText(share, std::chrono::duration<double, std::milli>(time - start_).count());
  const auto width = static_cast<std::size_t>(std::max(console_.width - 1, 20));
  if (!left.empty() && line.size() + left.size() + 2 > width)
    line.resize(std::min(line.size(), width - std::min(width, left.size() + 2)));
  if (!left.empty()) line += "  " + left;
  if (line.size() > width) line.resize(width);
  console_.out << "\r\x1b[K" << line << std::flush;
  shown_ = true;
}

void ProgressPrinter::clearLine() {
  if (shown_) console_.out << "\r\x1b[K";
  shown_ = false;
}

void ProgressPrinter::end() {
  clearLine();
  console_.out.flush();
}

}  // namespace sherd
