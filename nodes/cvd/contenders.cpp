#include "cvd/contenders.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"

namespace sherd {
Contenders::Contenders(LloydState& state, const Exec& exec)
    : s_(state), isByCell_(state.nodes * state.siteCount >= kManyPairs) {
  for (std::size_t j = 0; j < s_.siteCount; ++j)
    if (s_.moved[j]) movers_.push_back(static_cast<Index>(j));
  if (isByCell_) findByCell(exec);
}

std::vector<Index> Contenders::blocks() const {
  std::vector<Index> list;
  const std::size_t count = s_.lanes.blockCount();
  const bool everywhere = !isByCell_ || std::none_of(s_.contenders.begin(), s_.contenders.end(),
                                                     [](const auto& c) { return c.empty(); });
  if (everywhere) {
    if (s_.siteCount < 2 || (movers_.empty() && !s_.allStale)) return list;
    for (std::size_t b = 0; b < count; ++b) list.push_back(static_cast<Index>(b));
    return list;
  }
  std::vector<char> isTouched(count, 0);
  for (std::size_t c = 0; c < s_.contenders.size(); ++c)
    if (!s_.contenders[c].empty())
      for (const Index n : s_.members[c]) isTouched[at(n) / kNodeLanes] = 1;
  for (std::size_t b = 0; b < count; ++b)
    if (isTouched[b]) list.push_back(static_cast<Index>(b));
  return list;
}

/// Only those within twice the cell's radius: a site at twice a node's distance is farther from it than its
/// own, by the triangle inequality.
void Contenders::findByCell(const Exec& exec) {
  s_.contenders.resize(s_.siteCount);
  parallelFor(exec, s_.siteCount, blockOf(s_.nodes / s_.siteCount), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) measure(c);
  });
  const std::size_t others = s_.allStale ? s_.siteCount : movers_.size();
  parallelFor(exec, (s_.siteCount + kNodeLanes - 1) / kNodeLanes, blockOf(2 * others * s_.dimensions),
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t b = begin; b < end; ++b) findOfBlock(b);
              });
}

void Contenders::measure(std::size_t cell) {
  s_.contenders[cell].clear();
  if (!s_.resized[cell]) return;
  s_.radius[cell] = -1;
  for (const Index n : s_.members[cell]) s_.radius[cell] = std::max(s_.radius[cell], s_.up[at(n)]);
  s_.resized[cell] = 0;
}

/// Sixteen cells at once: their sites are compared with the others like nodes.
void Contenders::findOfBlock(std::size_t block) {
  const std::size_t first = block * kNodeLanes, count = std::min(kNodeLanes, s_.siteCount - first);
  const unsigned valid = (1u << count) - 1u;
  LaneValues reach, low, high;
  std::fill_n(reach.lane, kNodeLanes, -1.0f);
  unsigned movedLanes = 0;
  for (std::size_t k = 0; k < count; ++k) {
    reach.lane[k] = 2 * s_.radius[first + k];
    if (s_.moved[first + k] || s_.allStale) movedLanes |= 1u << k;
  }
  const auto look = [&](std::size_t j, unsigned lanes) {
    lanes &= compareLanes(&s_.siteLanes[block * (s_.dimensions + 1)], s_.lanesOf(j), s_.dimensions,
                          reach.lane, low, high);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(lanes));
      if (first + k != j && !(s_.radius[first + k] < 0))
        s_.contenders[first + k].push_back({low.lane[k] / 2, static_cast<Index>(j)});
    }
  };
  // Between sites that stayed, the comparison has been made before, with the same numbers.
  if (movedLanes == 0)
    for (const Index j : movers_) look(at(j), valid);
  else
    for (std::size_t j = 0; j < s_.siteCount; ++j) look(j, s_.moved[j] ? valid : movedLanes);
  for (std::size_t k = 0; k < count; ++k)
    std::sort(s_.contenders[first + k].begin(), s_.contenders[first + k].end(),
              [](const Contender& a, const Contender& b) {
                return a.half != b.half ? a.half < b.half : a.site < b.site;
              });
}

}  // namespace sherd
