// Members and centroids of the cells (lloyd_state.h).
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "cvd/distance.h"
#include "cvd/lloyd_state.h"

namespace sherd {
namespace {

Index blockOfNode(Index n) { return n / static_cast<Index>(kNodeLanes); }

/// What the centroid of a cell is taken from, by weights or by volumes.
class Summed {
 public:
  Summed(const double* x, std::size_t dimensions, const std::vector<double>& weight)
      : x_(x), dimensions_(dimensions), weight_(weight) {}

  /// Brings a cell's sums up to its members.
  void refresh(const std::vector<Index>& members, CellSums& sums) {
    findRuns(members);
    const std::size_t width = dimensions_ + 1;
    const bool isSame = std::ranges::equal(blocks_, sums.block);
    if (!isSame) next_.resize(blocks_.size() * width);
    std::vector<double>& to = isSame ? sums.sum : next_;
    std::size_t old = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      while (old < sums.block.size() && sums.block[old] < blocks_[i]) ++old;
      const bool isKnown = old < sums.block.size() && sums.block[old] == blocks_[i] && !sums.isStale[old];
      if (!isKnown)
        sumOf(std::span(members).subspan(starts_[i], starts_[i + 1] - starts_[i]), &to[i * width]);
      else if (!isSame)
        std::copy_n(&sums.sum[old * width], width, &to[i * width]);
    }
    if (!isSame) sums.block = blocks_, std::swap(sums.sum, next_);
    sums.isStale.assign(sums.block.size(), 0);
  }

  /// Their total over its weight; false where that is 0.
  bool centroid(const CellSums& sums, std::vector<double>& out) const {
    const std::size_t width = dimensions_ + 1;
    out.assign(width, 0.0);
    for (std::size_t i = 0; i < sums.block.size(); ++i) addScaled(out.data(), &sums.sum[i * width], 1, width);
    const double total = out[dimensions_];
    if (!(total > 0)) return false;
    for (double& c : out) c /= total;
    return true;
  }

 private:
  /// The blocks that members lie in, and where each one's begin.
  void findRuns(const std::vector<Index>& members) {
    blocks_.clear();
    starts_.clear();
    for (std::size_t k = 0; k < members.size(); ++k)
      if (const Index block = blockOfNode(members[k]); blocks_.empty() || blocks_.back() != block) {
        blocks_.push_back(block);
        starts_.push_back(k);
      }
    starts_.push_back(members.size());
  }

  /// Σ w x̄, Σ w over some nodes.
  void sumOf(std::span<const Index> run, double* out) const {
    sumScaled(out, x_, weight_.data(), run, dimensions_);
    out[dimensions_] = 0;
    for (const Index n : run) out[dimensions_] += weight_[at(n)];
  }

  const double* x_;
  std::size_t dimensions_;
  const std::vector<double>& weight_;
  std::vector<Index> blocks_;
  std::vector<std::size_t> starts_;
  std::vector<double> next_;
};

void markStale(CellSums& sums, Index block) {
  const auto at = std::lower_bound(sums.block.begin(), sums.block.end(), block);
  if (at != sums.block.end() && *at == block)
    sums.isStale[static_cast<std::size_t>(at - sums.block.begin())] = 1;
}

}  // namespace

/// Brings `members` up to the labels. Returns how many have changed.
std::size_t LloydState::moveNodes(std::span<const std::vector<Leaving>> leaving) {
  std::vector<std::size_t> before(siteCount);
  std::vector<char> loses(siteCount, 0);
  for (std::size_t c = 0; c < siteCount; ++c) before[c] = members[c].size();
  std::size_t count = 0;
  for (const auto& list : leaving) {
    count += list.size();
    for (const Leaving& leaver : list) {
      const std::size_t to = at(label[at(leaver.node)]);
      members[to].push_back(leaver.node);
      markStale(sums[to], blockOfNode(leaver.node));
      markStale(sums[at(leaver.from)], blockOfNode(leaver.node));
      loses[at(leaver.from)] = 1;
    }
  }
  for (std::size_t c = 0; count > 0 && c < siteCount; ++c) {
    std::vector<Index>& list = members[c];
    if (list.size() == before[c] && !loses[c]) continue;
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(before[c]);
    if (loses[c]) {
      const auto stays = std::remove_if(list.begin(), middle,
                                        [&](Index n) { return label[at(n)] != static_cast<Index>(c); });
      std::inplace_merge(list.begin(), stays, std::move(middle, list.end(), stays));
      list.resize(list.size() - static_cast<std::size_t>(middle - stays));
    } else {
      std::inplace_merge(list.begin(), middle, list.end());
    }
    dirty[c] = resized[c] = 1;
  }
  return count;
}

/// Puts site j there; what depends on where it was is up to the caller.
void LloydState::place(std::size_t j, const double* at) {
  std::copy_n(at, dimensions, &p[j * dimensions]);
  squaredNorm[j] = lanes.convert(at, &site[j * dimensions]);
  LaneValues* block = &siteLanes[j / kNodeLanes * (dimensions + 1)];
  const std::size_t lane = j % kNodeLanes;
  for (std::size_t i = 0; i < dimensions; ++i) block[i].lane[lane] = site[j * dimensions + i] / -2;
  block[dimensions].lane[lane] = squaredNorm[j];
}

/// Moves site j by `step`, m: its nodes may be nearer or farther by so much.
void LloydState::moveTo(std::size_t j, const double* at, double step) {
  place(j, at);
  const float by = lanes.atLeast(step);
  drift[j] = (drift[j] + by) * kBoundUp;
  moved[j] = resized[j] = 1;
  for (const Index n : members[j]) {
    const auto lane = static_cast<std::size_t>(n);
    up[lane] = (up[lane] + by) * kBoundUp;
    low[lane] = low[lane] * kBoundDown - by;
    isTight[lane] = 0;
  }
}

/// Moves the sites of cells that changed, but not those pinned, to their centroids, or `relaxation` times as
/// far. Returns the farthest move, m.
double LloydState::moveToCentroids(double relaxation, const Exec& exec) {
  std::vector<double> step(siteCount, 0.0);
  const std::size_t grain = evenBlockOf(siteCount, nodes * dimensions / siteCount);
  parallelFor(exec, siteCount, grain, [&](std::size_t begin, std::size_t end) {
    Summed byWeight(x, dimensions, weights.weight), byVolume(x, dimensions, weights.volume);
    std::vector<double> target;
    CellSums volumes;
    for (std::size_t j = begin; j < end; ++j) {
      if (j < pinned || !dirty[j] || members[j].empty()) continue;
      byWeight.refresh(members[j], sums[j]);
      if (!byWeight.centroid(sums[j], target)) {
        volumes = {};
        byVolume.refresh(members[j], volumes);
        if (!byVolume.centroid(volumes, target)) {
          dirty[j] = 0;
          continue;
        }
      }
      const double* from = position(j);
      for (std::size_t i = 0; relaxation != 1 && i < dimensions; ++i)
        target[i] = from[i] + relaxation * (target[i] - from[i]);
      dirty[j] = relaxation != 1;
      if (std::equal(target.begin(), target.end() - 1, from)) continue;
      step[j] = std::sqrt(squaredDistance(target.data(), from, dimensions));
      moveTo(j, target.data(), step[j]);
    }
  });
  for (std::size_t j = 0; j < siteCount; ++j)
    if (moved[j]) version[j] = ++versions;
  return step.empty() ? 0.0 : *std::max_element(step.begin(), step.end());
}

}  // namespace sherd
