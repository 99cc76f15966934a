#include "simulate/separator.h"

#include <algorithm>

namespace sherd {
namespace {

constexpr std::size_t kPatience = 60;  // moves without a smaller separator, before a pass ends
constexpr int kPasses = 3;

}  // namespace

/// By how much the separator shrinks.
Index SeparatorRefinement::gain(Index n, Side to) const {
  Index pulled = 0;
  for (const Index m : graph_.of(n)) pulled += side_[at(m)] == other(to) ? 1 : 0;
  return 1 - pulled;
}

void SeparatorRefinement::offer(Index n) {
  for (const Side to : {Side::Low, Side::High}) queue_.push({gain(n, to), n, to});
}

void SeparatorRefinement::take(const Move& move) {
  const auto change = [this](Index n, Side to) {
    done_.emplace_back(n, side_[at(n)]);
    side_[at(n)] = to;
  };
  change(move.node, move.to);
  locked_[at(move.node)] = 1;
  std::vector<Index> pulled;
  for (const Index m : graph_.of(move.node))
    if (side_[at(m)] == other(move.to)) {
      change(m, Side::Between);
      pulled.push_back(m);
    }
  for (const Index n : pulled) {
    if (!locked_[at(n)]) offer(n);
    for (const Index m : graph_.of(n))  // that no longer pull it
      if (side_[at(m)] == Side::Between && !locked_[at(m)]) queue_.push({gain(m, move.to), m, move.to});
  }
}

/// Moves until none helps for long. True if the separator got smaller: `done_` then holds what changed.
bool SeparatorRefinement::pass(std::size_t count, std::array<std::size_t, 2>& sizes, std::size_t least) {
  std::size_t smallest = count, kept = 0, idle = 0;
  std::array<std::size_t, 2> now = sizes;
  while (!queue_.empty() && idle < kPatience) {
    const Move move = queue_.top();
    queue_.pop();
    const auto from = static_cast<std::size_t>(other(move.to)), to = static_cast<std::size_t>(move.to);
    if (side_[at(move.node)] != Side::Between || locked_[at(move.node)]) continue;
    if (gain(move.node, move.to) != move.gain) continue;  // a newer offer is in the queue
    const auto pulled = static_cast<std::size_t>(1 - move.gain);
    if (now[from] < least + pulled) continue;
    take(move);
    now[from] -= pulled;
    ++now[to];
    count = count + pulled - 1;
    ++idle;
    if (count >= smallest) continue;
    smallest = count;
    kept = done_.size();
    sizes = now;
    idle = 0;
  }
  for (const auto& [n, side] : done_) locked_[at(n)] = 0;
  for (std::size_t i = done_.size(); i-- > kept;) side_[at(done_[i].first)] = done_[i].second;
  done_.resize(kept);
  return kept > 0;
}

void SeparatorRefinement::refine(std::vector<Index>& between, std::array<std::size_t, 2>& sizes,
                                 std::size_t least) {
  for (int i = 0; i < kPasses; ++i) {
    queue_ = {};
    done_.clear();
    for (const Index n : between) offer(n);
    if (!pass(between.size(), sizes, least)) return;
    for (const auto& [n, side] : done_) between.push_back(n);
    std::sort(between.begin(), between.end());
    between.erase(std::unique(between.begin(), between.end()), between.end());
    std::erase_if(between, [this](Index n) { return side_[at(n)] != Side::Between; });
  }
}

}  // namespace sherd
