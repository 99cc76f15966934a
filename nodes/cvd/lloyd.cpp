// Lloyd's iteration: sites, passes and what is told of them (class Lloyd of cvd.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "cvd/cvd.h"
#include "cvd/distance.h"
#include "cvd/flood.h"
#include "cvd/lloyd_state.h"

namespace sherd {
namespace {

constexpr std::size_t kCalm =
    100;  ///< one node in so many changes its label: sites move no farther from then on

/// Sites move farther than to their centroids until few labels change in a pass. After that it ends when no
/// label changes or sites stay, or after so many passes.
template <class Assign>
Result<Lloyd::End> iterate(LloydState& state, const LloydLimits& limits, const Exec& exec,
                           const Assign& assignLabels) {
  Lloyd::End end;
  double relaxation = limits.relaxation;
  while (!end.converged && end.iterations < limits.maxIterations) {
    if (exec.cancelled()) return cancelledError();  // labels may be incomplete from here on
    const double step = state.moveToCentroids(relaxation, exec);
    const std::size_t changed = assignLabels();
    ++end.iterations;
    if (relaxation == 1)
      end.converged = changed == 0 || step <= limits.tolerance * state.embedding.diameter;
    else if (changed * kCalm <= state.nodes)
      relaxation = 1;
  }
  if (exec.cancelled()) return cancelledError();
  return end;
}

}  // namespace

LloydState::LloydState(const Embedding& e, const WeightField& w, const Exec& exec)
    : embedding(e),
      weights(w),
      x(e.coordinates.data()),
      nodes(static_cast<std::size_t>(e.coordinates.cols())),
      dimensions(static_cast<std::size_t>(e.coordinates.rows())),
      lanes(e.coordinates, e.diameter, exec),
      label(nodes, -1),
      up(lanes.blockCount() * kNodeLanes, std::numeric_limits<float>::infinity()),
      low(up.size(), 0.0f),
      isTight(up.size(), 0),
      distance2(nodes, std::numeric_limits<double>::infinity()),
      measured(nodes, 0) {
  std::fill(isTight.begin() + static_cast<std::ptrdiff_t>(nodes), isTight.end(), 1);  // no nodes
}

double LloydState::squaredDistanceTo(std::size_t n, std::size_t j) const {
  return squaredDistance(x + n * dimensions, position(j), dimensions);
}

double LloydState::ownSquaredDistance(std::size_t n) {
  const std::size_t j = at(label[n]);
  if (measured[n] != version[j]) {
    distance2[n] = squaredDistanceTo(n, j);
    measured[n] = version[j];
  }
  return distance2[n];
}

void LloydState::measureAll() {
  if (siteCount == 0) return;
  for (std::size_t n = 0; n < nodes; ++n) ownSquaredDistance(n);
}

/// Makes room for the bounds of one more site; gives bounds up where they would take too much.
void LloydState::reserveBounds(const Exec& exec) {
  if (!bounded || siteCount < capacity) return;
  const std::size_t wider = std::max<std::size_t>(8, 2 * capacity);
  if (nodes * wider > kMaxBounds) {
    bounded = false;
    bound.reset();
    return;
  }
  auto copy = std::make_unique_for_overwrite<LaneValues[]>(lanes.blockCount() * wider);
  parallelFor(exec, lanes.blockCount(), blockOf(wider * kNodeLanes), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      std::copy_n(bound.get() + b * capacity, siteCount, copy.get() + b * wider);
      std::fill_n(copy.get() + b * wider + siteCount, wider - siteCount, LaneValues{});
    }
  });
  bound = std::move(copy);
  capacity = wider;
}

void LloydState::addSite(const Eigen::Ref<const Eigen::VectorXd>& at, const Exec& exec) {
  reserveBounds(exec);
  const std::size_t j = siteCount++;
  p.resize(siteCount * dimensions);
  site.resize(siteCount * dimensions);
  squaredNorm.push_back(0);
  if (j % kNodeLanes == 0) siteLanes.resize(siteLanes.size() + dimensions + 1, LaneValues{});
  drift.push_back(0);
  radius.push_back(0);
  version.push_back(++versions);
  for (std::vector<char>* all : {&moved, &dirty, &resized}) all->push_back(1);
  members.emplace_back();
  sums.emplace_back();
  place(j, at.data());
  if (j == 0) {
    std::fill(label.begin(), label.end(), 0);
    listMembers();
  }
  if (!allStale) assign(exec);
}

void LloydState::listMembers() {
  for (auto& list : members) list.clear();
  for (std::size_t n = 0; n < nodes; ++n) members[at(label[n])].push_back(static_cast<Index>(n));
}

std::size_t LloydState::assignByFlooding(const NodeGraph& graph, const Exec& exec) {
  const std::vector<Index> before = label;
  const std::vector<Index> flooded = floodLabels({x, p.data(), nodes, siteCount, dimensions}, graph, exec);
  assign(exec);  // the nearest sites, for nodes that no flood has reached
  for (std::size_t n = 0; n < nodes; ++n) {
    if (flooded[n] < 0 || flooded[n] == label[n]) continue;
    label[n] = flooded[n];
    up[n] = std::numeric_limits<float>::infinity();
    low[n] = 0;
    isTight[n] = 0;
  }
  std::size_t changed = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    if (label[n] == before[n]) continue;
    dirty[at(label[n])] = dirty[at(before[n])] = 1;
    ++changed;
  }
  listMembers();
  std::fill(sums.begin(), sums.end(), CellSums{});
  std::fill(resized.begin(), resized.end(), 1);
  allStale = true;
  return changed;
}

Lloyd::Lloyd(const Embedding& embedding, const WeightField& weights, const Exec& exec)
    : state_(std::make_unique<LloydState>(embedding, weights, exec)) {}
Lloyd::~Lloyd() = default;
Lloyd::Lloyd(Lloyd&&) noexcept = default;

void Lloyd::addSite(const Eigen::Ref<const Eigen::VectorXd>& position, const Exec& exec) {
  state_->addSite(position, exec);
}

Result<Lloyd::End> Lloyd::run(const LloydLimits& limits, const Exec& exec) {
  if (state_->allStale) state_->assign(exec);
  return iterate(*state_, limits, exec, [&] { return state_->assign(exec); });
}

Result<Lloyd::End> Lloyd::runFlood(const LloydLimits& limits, const Exec& exec) {
  const NodeGraph graph(state_->nodes, tetEdges(state_->embedding.tets->tets));
  state_->assignByFlooding(graph, exec);
  return iterate(*state_, limits, exec, [&] { return state_->assignByFlooding(graph, exec); });
}

void Lloyd::pin(std::size_t count) { state_->pinned = std::min(count, state_->siteCount); }
std::size_t Lloyd::siteCount() const { return state_->siteCount; }
std::size_t Lloyd::pinnedCount() const { return state_->pinned; }
std::size_t Lloyd::nodeCount() const { return state_->nodes; }
const std::vector<Index>& Lloyd::labels() const { return state_->label; }

const std::vector<double>& Lloyd::squaredDistances() const {
  state_->measureAll();
  return state_->distance2;
}

Eigen::MatrixXd Lloyd::sites() const {
  return Eigen::Map<const Eigen::MatrixXd>(state_->p.data(), static_cast<Eigen::Index>(state_->dimensions),
                                           static_cast<Eigen::Index>(state_->siteCount));
}

double Lloyd::energy() const {
  state_->measureAll();
  double sum = 0;
  for (std::size_t n = 0; n < state_->nodes; ++n) sum += state_->weights.weight[n] * state_->distance2[n];
  return sum;
}

}  // namespace sherd
