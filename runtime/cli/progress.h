// What a user sees while a graph runs.
#pragma once

#include <chrono>
#include <map>
#include <string>

#include "cli/console.h"
#include "eval/evaluator.h"
#include "graph/graph.h"

namespace sherd {

/// Prints a line for each node that ends, with what it had to say below, and on a terminal one more line that
/// is written over again: the share done, what runs, and the time left.
class ProgressPrinter : public EvalListener {
 public:
  /// `quiet` leaves out all but warnings.
  ProgressPrinter(const Graph& graph, const std::vector<int>& needed, bool quiet, Console& console);

  void started(int node) override;
  void progress(int node, double share) override;
  void finished(const NodeReport& report) override;
  /// Removes the line that is written over.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostHits = 200;  ///< nodes, beyond which hits are not told one by one
  std::string nameOf(int node) const;
  void printMessages(const NodeReport& report);
  void showLine(bool now);
  void clearLine();

  const Graph& graph_;
  Console& console_;
  const bool quiet_;
  const std::size_t total_;
  std::size_t nameWidth_ = 0, typeWidth_ = 0;
  std::size_t ended_ = 0;
  std::map<int, double> running_;  ///< node → share of it done
  Clock::time_point start_ = Clock::now(), lastShown_{};
  bool shown_ = false;
};

/// "about 12 s left", or nothing as long as nobody can know.
std::string timeLeftText(double share, double elapsedMs);

/// At most `kMostMessages` of a node's messages are shown.
constexpr std::size_t kMostMessages = 20;

}  // namespace sherd
