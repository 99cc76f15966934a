// Lloyd's iteration with exact labels (class Lloyd of cvd.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "cvd/cvd.h"
#include "cvd/distance.h"
#include "cvd/flood.h"

namespace sherd {
namespace {

constexpr std::size_t kMaxBounds = std::size_t{1} << 25;
/// Wider than all rounding in distances (relative error below 1e-13 for 250 dimensions) and in the sums of
/// moves.
constexpr double kSlack = 1e-10;

/// How many items of so many operations each are worth a task.
std::size_t blockOf(std::size_t operations) {
  return std::max<std::size_t>(1, (std::size_t{1} << 18) / (operations + 1));
}

}  // namespace

struct Lloyd::Impl {
  const Embedding& embedding;
  const WeightField& weights;
  std::size_t nodes, dimensions, size;  ///< size: padded dimensions
  std::size_t siteCount = 0;

  std::vector<double> x, p;  ///< padded coordinates of nodes and sites, one after another
  std::vector<Index> label;
  std::vector<double> distance2;  ///< per node, to its site
  std::vector<double> limit;      ///< per node: just above that distance
  std::vector<std::vector<Index>> members,
      contenders;             ///< per cell, while they are needed; their memory stays
  std::vector<Index> before;  ///< labels of the pass before

  std::vector<char> moved;  ///< per site: since labels were last exact
  std::vector<char> dirty;  ///< per site: its cell has changed since its centroid was taken
  bool allStale = false;    ///< labels come from elsewhere: every comparison has to be made

  // Of the distance of node n to site j is known: ≥ bound[n · capacity + j] − drift[j].
  bool bounded = true;
  std::size_t capacity = 0;
  std::vector<double> bound;
  std::vector<double> drift;  ///< per site: the sum of all its moves

  Impl(const Embedding& e, const WeightField& w)
      : embedding(e),
        weights(w),
        nodes(static_cast<std::size_t>(e.coordinates.cols())),
        dimensions(static_cast<std::size_t>(e.coordinates.rows())),
        size(paddedSize(dimensions)),
        x(nodes * size, 0.0),
        label(nodes, -1),
        distance2(nodes, std::numeric_limits<double>::infinity()),
        limit(distance2) {
    for (std::size_t n = 0; n < nodes; ++n)
      std::copy_n(e.coordinates.col(static_cast<Eigen::Index>(n)).data(), dimensions, &x[n * size]);
  }

  double squaredDistanceTo(std::size_t n, std::size_t j) const {
    return squaredDistance(&x[n * size], &p[j * size], size);
  }
  void setDistance(std::size_t n, double squared) {
    distance2[n] = squared;
    limit[n] = std::sqrt(squared) * (1 + kSlack);
  }
  double* boundsOf(std::size_t n) { return &bound[n * capacity]; }

  void addSite(const Eigen::Ref<const Eigen::VectorXd>& position, const Exec& exec);
  void reserveBounds();
  bool assign(const Exec& exec);
  void measureMoved(const Exec& exec);
  void findContenders(const Exec& exec);
  void assignNode(std::size_t n);
  void compare(std::size_t n, std::size_t j);
  bool relabel(const std::vector<Index>& old);
  double moveToCentroids(const Exec& exec);
  bool centroid(const std::vector<Index>& members, std::vector<double>& out) const;
  void listMembersOfDirtyCells();
  bool assignByFlooding(const NodeGraph& graph, const Exec& exec);
  template <class Assign>
  Result<Lloyd::End> iterate(const LloydLimits& limits, const Exec& exec, const Assign& assignLabels);
};

/// Makes room for the bounds of one more site; gives bounds up where they would take too much.
void Lloyd::Impl::reserveBounds() {
  if (!bounded || siteCount < capacity) return;
  const std::size_t wider = std::max<std::size_t>(16, 2 * capacity);
  if (nodes * wider > kMaxBounds) {
    bounded = false;
    bound = {};
    return;
  }
  std::vector<double> copy(nodes * wider, 0.0);
  for (std::size_t n = 0; n < nodes; ++n)
    std::copy_n(bound.data() + n * capacity, siteCount, copy.data() + n * wider);
  bound = std::move(copy);
  capacity = wider;
}

void Lloyd::Impl::addSite(const Eigen::Ref<const Eigen::VectorXd>& position, const Exec& exec) {
  reserveBounds();
  const std::size_t j = siteCount++;
  p.resize(siteCount * size, 0.0);
  std::copy_n(position.data(), dimensions, &p[j * size]);
  moved.push_back(1);
  dirty.push_back(1);
  drift.push_back(0);
  if (allStale) return;
  assign(exec);
}

/// Compares node n with site j where the bound doesn't rule it out.
inline void Lloyd::Impl::compare(std::size_t n, std::size_t j) {
  if (bounded && boundsOf(n)[j] * (1 - kSlack) - drift[j] * (1 + kSlack) > limit[n]) return;
  const double d2 = squaredDistanceTo(n, j);
  const auto current = static_cast<std::size_t>(label[n]);
  const bool nearer = d2 < distance2[n] || (d2 == distance2[n] && j < current);
  if (bounded) {
    if (nearer && label[n] >= 0) boundsOf(n)[current] = std::sqrt(distance2[n]) + drift[current];
    boundsOf(n)[j] = std::sqrt(d2) + drift[j];
  }
  if (!nearer) return;
  label[n] = static_cast<Index>(j);
  setDistance(n, d2);
}

/// Of the nodes whose own site has moved, the distance to it.
void Lloyd::Impl::measureMoved(const Exec& exec) {
  parallelFor(exec, nodes, blockOf(size), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (label[n] >= 0 && moved[at(label[n])]) setDistance(n, squaredDistanceTo(n, at(label[n])));
  });
}

/// Per cell the sites that may be nearer to one of its nodes than its own: those within twice its radius (any
/// other is farther from every node than its own site, by the triangle inequality), and among sites that
/// stayed none, since that comparison has been made before, with the same numbers.
void Lloyd::Impl::findContenders(const Exec& exec) {
  std::vector<double> radius2(siteCount, -1);
  for (std::size_t n = 0; n < nodes; ++n)
    if (label[n] >= 0) radius2[at(label[n])] = std::max(radius2[at(label[n])], distance2[n]);
  contenders.resize(siteCount);
  parallelFor(exec, siteCount, blockOf(siteCount * size), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      contenders[c].clear();
      if (radius2[c] < 0) continue;
      const bool all = moved[c] || allStale;
      const double reach2 = 4 * radius2[c] * (1 + kSlack);
      for (std::size_t j = 0; j < siteCount; ++j)
        if (j != c && (all || moved[j]) && squaredDistance(&p[c * size], &p[j * size], size) <= reach2)
          contenders[c].push_back(static_cast<Index>(j));
    }
  });
}

void Lloyd::Impl::assignNode(std::size_t n) {
  const Index own = label[n];
  if (own < 0)
    for (std::size_t j = 0; j < siteCount; ++j) compare(n, j);
  else
    for (const Index j : contenders[at(own)]) compare(n, at(j));
}

/// Makes labels exact. Returns whether one changed.
bool Lloyd::Impl::assign(const Exec& exec) {
  before = label;
  measureMoved(exec);
  findContenders(exec);
  parallelFor(exec, nodes, blockOf(16 * size), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) assignNode(n);
  });
  std::fill(moved.begin(), moved.end(), 0);
  allStale = false;
  return relabel(before);
}

/// Marks the cells that have gained or lost nodes; returns whether any has.
bool Lloyd::Impl::relabel(const std::vector<Index>& old) {
  bool changed = false;
  for (std::size_t n = 0; n < nodes; ++n) {
    if (label[n] == old[n]) continue;
    changed = true;
    dirty[at(label[n])] = 1;
    if (old[n] >= 0) dirty[at(old[n])] = 1;
  }
  return changed;
}

void Lloyd::Impl::listMembersOfDirtyCells() {
  members.resize(siteCount);
  for (auto& list : members) list.clear();
  for (std::size_t n = 0; n < nodes; ++n)
    if (dirty[at(label[n])]) members[at(label[n])].push_back(static_cast<Index>(n));
}

/// Weighted centroid, by volume where nothing weighs; false where the cell has neither.
bool Lloyd::Impl::centroid(const std::vector<Index>& members, std::vector<double>& out) const {
  for (const std::vector<double>* by : {&weights.weight, &weights.volume}) {
    double total = 0;
    for (const Index n : members) total += (*by)[at(n)];
    if (!(total > 0)) continue;
    out.assign(size, 0.0);
    for (const Index n : members) addScaled(out.data(), &x[at(n) * size], (*by)[at(n)] / total, size);
    return true;
  }
  return false;
}

/// Moves the sites of cells that changed. Returns the farthest move, m.
double Lloyd::Impl::moveToCentroids(const Exec& exec) {
  listMembersOfDirtyCells();
  std::vector<double> step(siteCount, 0.0);
  parallelFor(exec, siteCount, blockOf(nodes * size / siteCount), [&](std::size_t begin, std::size_t end) {
    std::vector<double> target;
    for (std::size_t j = begin; j < end; ++j) {
      if (members[j].empty() || !centroid(members[j], target)) continue;
      step[j] = std::sqrt(squaredDistance(target.data(), &p[j * size], size));
      if (!std::equal(target.begin(), target.end(), &p[j * size])) moved[j] = 1;
      std::copy(target.begin(), target.end(), &p[j * size]);
    }
  });
  std::fill(dirty.begin(), dirty.end(), 0);
  for (std::size_t j = 0; j < siteCount; ++j) drift[j] += step[j];
  return step.empty() ? 0.0 : *std::max_element(step.begin(), step.end());
}

bool Lloyd::Impl::assignByFlooding(const NodeGraph& graph, const Exec& exec) {
  const std::vector<Index> own = label;
  const std::vector<Index> flooded = floodLabels({x.data(), p.data(), nodes, siteCount, size}, graph);
  assign(exec);  // the nearest sites, for nodes that no flood has reached
  for (std::size_t n = 0; n < nodes; ++n) {
    if (flooded[n] < 0) continue;
    label[n] = flooded[n];
    setDistance(n, squaredDistanceTo(n, at(flooded[n])));
  }
  allStale = true;
  bounded = false;
  return relabel(own);
}

template <class Assign>
Result<Lloyd::End> Lloyd::Impl::iterate(const LloydLimits& limits, const Exec& exec,
                                        const Assign& assignLabels) {
  End end;
  while (!end.converged && end.iterations < limits.maxIterations) {
    if (exec.cancelled()) return cancelledError();  // labels may be incomplete from here on
    const double step = moveToCentroids(exec);
    const bool changed = assignLabels();
    ++end.iterations;
    end.converged = !changed || step <= limits.tolerance * embedding.diameter;
  }
  if (exec.cancelled()) return cancelledError();
  return end;
}

Lloyd::Lloyd(const Embedding& embedding, const WeightField& weights)
    : impl_(std::make_unique<Impl>(embedding, weights)) {}
Lloyd::~Lloyd() = default;
Lloyd::Lloyd(Lloyd&&) noexcept = default;

void Lloyd::addSite(const Eigen::Ref<const Eigen::VectorXd>& position, const Exec& exec) {
  impl_->addSite(position, exec);
}

Result<Lloyd::End> Lloyd::run(const LloydLimits& limits, const Exec& exec) {
  if (impl_->allStale) impl_->assign(exec);
  return impl_->iterate(limits, exec, [&] { return impl_->assign(exec); });
}

Result<Lloyd::End> Lloyd::runFlood(const LloydLimits& limits, const Exec& exec) {
  const NodeGraph graph(impl_->nodes, tetEdges(impl_->embedding.tets->tets));
  impl_->assignByFlooding(graph, exec);
  return impl_->iterate(limits, exec, [&] { return impl_->assignByFlooding(graph, exec); });
}

std::size_t Lloyd::siteCount() const { return impl_->siteCount; }
std::size_t Lloyd::nodeCount() const { return impl_->nodes; }
const std::vector<Index>& Lloyd::labels() const { return impl_->label; }
const std::vector<double>& Lloyd::squaredDistances() const { return impl_->distance2; }

Eigen::MatrixXd Lloyd::sites() const {
  Eigen::MatrixXd out(impl_->dimensions, impl_->siteCount);
  for (std::size_t j = 0; j < impl_->siteCount; ++j)
    std::copy_n(&impl_->p[j * impl_->size], impl_->dimensions, out.col(static_cast<Eigen::Index>(j)).data());
  return out;
}

double Lloyd::energy() const {
  double sum = 0;
  for (std::size_t n = 0; n < impl_->nodes; ++n) sum += impl_->weights.weight[n] * impl_->distance2[n];
  return sum;
}

}  // namespace sherd
