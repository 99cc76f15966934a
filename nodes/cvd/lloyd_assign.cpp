// Exact labels (LloydState of lloyd_state.h). Blocks of nodes are compared with sites in single precision;
// two sites whose distances are within its error are compared by their exact squares.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/parallel.h"
#include "cvd/contenders.h"
#include "cvd/lloyd_state.h"

namespace sherd {
namespace {

constexpr float kStill = 0;  ///< the drift of a site that a bound was just taken of

/// Labels of one block after another; what it writes is the block's own.
class BlockLabels {
 public:
  BlockLabels(LloydState& s, const Contenders& contenders, std::vector<Leaving>& leaving)
      : s_(s), contenders_(contenders), leaving_(leaving), seen_(s.siteCount, -1) {}

  void visit(Index block) {
    begin(block);
    if (contenders_.isByCell())
      for (std::size_t k = 0; k < cellCount_; ++k) compareCell(cells_[k]);
    else
      compareAll();
    for (; changed_ != 0; changed_ &= changed_ - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(changed_));
      if (s_.label[first_ + lane] != before_[lane])
        leaving_.push_back({static_cast<Index>(first_ + lane), before_[lane]});
    }
  }

 private:
  struct Cell {
    std::size_t site;
    unsigned lanes;  ///< a bit for each of its nodes
  };

  void begin(Index block) {
    block_ = block;
    first_ = at(block) * kNodeLanes;
    laneCount_ = std::min(kNodeLanes, s_.nodes - first_);
    valid_ = (1u << laneCount_) - 1u;
    changed_ = 0;
    std::copy_n(&s_.label[first_], laneCount_, before_);
    std::copy_n(&s_.up[first_], kNodeLanes, reach_);
    loose_ = areTight(&s_.isTight[first_]) ? 0 : valid_;
    cellCount_ = 0;
    for (unsigned rest = valid_; rest != 0; ++cellCount_) {
      const Index label = before_[std::countr_zero(rest)];
      cells_[cellCount_] = {at(label), lanesWithLabel(before_, label) & valid_};
      rest &= ~cells_[cellCount_].lanes;
    }
  }

  static bool areTight(const char* lanes) {
    char all[kNodeLanes];
    std::memset(all, 1, kNodeLanes);
    return std::memcmp(lanes, all, kNodeLanes) == 0;
  }

  /// The farthest that a node which was a cell's when the block's visit began may be from the cell's site.
  float reachOf(const Cell& cell) const {
    float reach = 0;
    for (unsigned rest = cell.lanes; rest != 0; rest &= rest - 1)
      reach = std::max(reach, reach_[std::countr_zero(rest)]);
    return reach;
  }

  /// With the sites that may take nodes from a cell, nearest first.
  void compareCell(const Cell& cell) {
    float reach = reachOf(cell);
    for (const Contender& other : contenders_.of(cell.site)) {
      if (other.half > reach) break;
      const std::size_t j = at(other.site);
      if (j == cell.site || seen_[j] == block_ || (cell.lanes & openTo(j)) == 0) continue;
      if ((cell.lanes & loose_) != 0) {
        tighten();
        reach = reachOf(cell);
        if (other.half > reach) break;
        if (seen_[j] == block_ || (cell.lanes & openTo(j)) == 0) continue;
      }
      compareWith(j);
    }
  }

  /// With all sites that bounds leave open; where neither a node's own site nor the other has moved, the
  /// comparison has been made before, with the same numbers.
  void compareAll() {
    unsigned movedLanes = 0;
    for (std::size_t k = 0; k < cellCount_; ++k)
      if (s_.moved[cells_[k].site] || s_.allStale) movedLanes |= cells_[k].lanes;
    if (movedLanes == 0) {
      for (const Index j : contenders_.movers())
        if ((openTo(at(j)) & valid_) != 0) compareOpen(at(j), valid_);
      return;
    }
    open_.resize(s_.siteCount);
    findOpenLanes(&s_.bound[at(block_) * s_.capacity], s_.drift.data(), s_.siteCount, &s_.up[first_],
                  open_.data());
    for (std::size_t k = 0; k < cellCount_; ++k)
      open_[cells_[k].site] = static_cast<std::uint16_t>(open_[cells_[k].site] & ~cells_[k].lanes);
    for (std::size_t j = 0; j < s_.siteCount; ++j) {
      const unsigned lanes = s_.moved[j] || s_.allStale ? valid_ : movedLanes;
      if ((open_[j] & lanes) != 0) compareOpen(j, lanes);
    }
  }

  /// With a site that bounds leave open to some of the lanes, unless tighter ones don't.
  void compareOpen(std::size_t j, unsigned lanes) {
    if ((lanes & loose_) != 0) {
      tighten();
      for (std::size_t k = 0; k < cellCount_; ++k)
        if (cells_[k].site == j) lanes &= ~cells_[k].lanes;
    }
    if (seen_[j] != block_ && (openTo(j) & lanes) != 0) compareWith(j);
  }

  void compareWith(std::size_t j) {
    LaneValues low, high;
    const unsigned open = compare(j, low, high);
    consider(j, open, low, high);
  }

  /// The lanes of which it isn't known that site j is farther than their own.
  unsigned openTo(std::size_t j) const {
    if (!s_.bounded) return valid_;
    std::uint16_t open;
    findOpenLanes(&s_.bound[at(block_) * s_.capacity + j], &s_.drift[j], 1, &s_.up[first_], &open);
    return open & valid_;
  }

  /// Bounds of the block's distances from site j, kept as well.
  unsigned compare(std::size_t j, LaneValues& low, LaneValues& high) {
    const unsigned open =
        compareLanes(s_.lanes.block(at(block_)), s_.lanesOf(j), s_.dimensions, &s_.up[first_], low, high);
    seen_[j] = block_;
    if (s_.bounded) keepBounds(low, s_.drift[j], s_.bound[at(block_) * s_.capacity + j]);
    return open & valid_;
  }

  /// Bounds of all nodes' distances from their own sites, and what these say of each other's.
  void tighten() {
    loose_ = 0;
    for (std::size_t k = 0; k < cellCount_; ++k) compare(cells_[k].site, lows_[k], highs_[k]);
    if (cellCount_ == 1 && changed_ == 0) {
      std::copy_n(lows_[0].lane, laneCount_, &s_.low[first_]);
      std::copy_n(highs_[0].lane, laneCount_, &s_.up[first_]);
      std::copy_n(highs_[0].lane, laneCount_, reach_);
      std::fill_n(&s_.isTight[first_], laneCount_, 1);
      return;
    }
    for (std::size_t k = 0; k < cellCount_; ++k)
      for (unsigned rest = cells_[k].lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        reach_[lane] = highs_[k].lane[lane];
        if ((changed_ >> lane & 1) == 0) setBounds(lane, lows_[k].lane[lane], highs_[k].lane[lane]);
      }
    for (std::size_t k = 0; k < cellCount_; ++k) {
      std::uint16_t open;
      findOpenLanes(&lows_[k], &kStill, 1, &s_.up[first_], &open);
      consider(cells_[k].site, open & valid_ & ~cells_[k].lanes, lows_[k], highs_[k]);
    }
  }

  void setBounds(std::size_t lane, float low, float high) {
    s_.low[first_ + lane] = low;
    s_.up[first_ + lane] = high;
    s_.isTight[first_ + lane] = 1;
  }

  /// Site j takes those of the lanes that are nearer to it than to their own.
  void consider(std::size_t j, unsigned lanes, const LaneValues& low, const LaneValues& high) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      const std::size_t n = first_ + lane;
      if (at(s_.label[n]) == j) continue;
      if (!(high.lane[lane] < s_.low[n]) && !isNearer(n, j)) continue;
      s_.label[n] = static_cast<Index>(j);
      changed_ |= 1u << lane;
      setBounds(lane, low.lane[lane], high.lane[lane]);
    }
  }

  /// By exact squares; of equally near sites the lower counts as nearer.
  bool isNearer(std::size_t n, std::size_t j) {
    const double own = s_.ownSquaredDistance(n), other = s_.squaredDistanceTo(n, j);
    return other < own || (other == own && static_cast<Index>(j) < s_.label[n]);
  }

  LloydState& s_;
  const Contenders& contenders_;
  std::vector<Leaving>& leaving_;
  std::vector<std::uint16_t> open_;
  std::vector<Index> seen_;  ///< per site: the block that it was last compared with

  Index block_ = -1;
  std::size_t first_ = 0, laneCount_ = 0, cellCount_ = 0;
  unsigned valid_ = 0;    ///< lanes that are nodes
  unsigned changed_ = 0;  ///< lanes that have had another label during the visit
  unsigned loose_ = 0;    ///< lanes whose own bounds aren't tight
  Index before_[kNodeLanes] = {};
  float reach_[kNodeLanes];  ///< no less than the distances from the sites of `before_`
  Cell cells_[kNodeLanes];
  LaneValues lows_[kNodeLanes], highs_[kNodeLanes];
};

}  // namespace

/// Makes labels exact. Returns how many changed. Cost: where sites moved, and next to that.
std::size_t LloydState::assign(const Exec& exec) {
  if (exec.cancelled()) {
    allStale = true;
    return 0;
  }
  const Contenders contenders(*this, exec);
  const std::vector<Index> blocks = contenders.blocks();
  const std::size_t grain = evenBlockOf(blocks.size(), dimensions * std::min<std::size_t>(siteCount, 32) * 4);
  std::vector<std::vector<Leaving>> leaving((blocks.size() + grain - 1) / grain);
  parallelFor(exec, blocks.size(), grain, [&](std::size_t begin, std::size_t end) {
    BlockLabels labels(*this, contenders, leaving[begin / grain]);
    for (std::size_t i = begin; i < end; ++i) labels.visit(blocks[i]);
  });
  std::fill(moved.begin(), moved.end(), 0);
  allStale = exec.cancelled();
  return moveNodes(leaving);
}

}  // namespace sherd
