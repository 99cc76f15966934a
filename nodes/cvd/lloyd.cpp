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

constexpr std::size_t kMaxBounds = std::size_t{1} << 26;
/// Wider than all rounding in distances (relative error below 1e-13 for 250 dimensions) and in the sums of
/// moves.
constexpr double kSlack = 1e-10;

constexpr std::size_t kTaskWork = std::size_t{1} << 16;  ///< about how many operations are worth a task

/// How many items of so many operations each are worth a task.
std::size_t blockOf(std::size_t operations) { return std::max<std::size_t>(1, kTaskWork / (operations + 1)); }

}  // namespace

struct Lloyd::Impl {
  const Embedding& embedding;
  const WeightField& weights;
  std::size_t nodes, dimensions, size;  ///< size: padded dimensions
  std::size_t siteCount = 0;
  std::size_t pinned = 0;  ///< the first so many sites don't move

  std::vector<double> x, p;  ///< padded coordinates of nodes and sites, one after another
  std::vector<Index> label;
  std::vector<double> distance2;            ///< per node, to its site
  std::vector<double> limit;                ///< per node: just above that distance
  std::vector<std::vector<Index>> members;  ///< per cell its nodes, ascending

  std::vector<double> radius2;  ///< per cell: the largest distance2 of its nodes
  std::vector<char> moved;      ///< per site: since labels were last exact
  std::vector<char> dirty;      ///< per cell: it has changed since its centroid was taken
  std::vector<char> resized;    ///< per cell: it has changed since radius2 was
  /// A site that may take nodes from a cell; half its distance to the cell's site.
  struct Contender {
    double half;
    Index site;
  };
  std::vector<std::vector<Contender>> contenders;  ///< per cell, nearest first, while labels are made exact
  bool allStale = false;  ///< labels come from elsewhere: every comparison has to be made

  // Of the distance of node n to site j is known: ≥ bound[n · capacity + j] − drift[j].
  bool bounded = true;
  std::size_t capacity = 0;
  std::vector<float> bound;
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
  float* boundsOf(std::size_t n) { return &bound[n * capacity]; }
  /// Keeps what is now known of a distance: a little less, so that rounding to float leaves a bound.
  void keepBound(std::size_t n, std::size_t j, double distance) {
    boundsOf(n)[j] = static_cast<float>((distance + drift[j]) * (1 - 0x1p-22));
  }
  bool isRuledOut(std::size_t n, std::size_t j) const {
    return bounded && static_cast<double>(bound[n * capacity + j]) - drift[j] * (1 + kSlack) > limit[n];
  }

  /// Part of a cell's members.
  struct Chunk {
    Index cell;
    std::size_t begin, end;
  };

  void addSite(const Eigen::Ref<const Eigen::VectorXd>& position, const Exec& exec);
  void reserveBounds();
  bool assign(const Exec& exec);
  template <class Touched>
  std::vector<Chunk> chunksOf(const Touched& touched) const;
  template <class Body>
  void forChunks(const Exec& exec, const std::vector<Chunk>& chunks, const Body& body);
  void measureCells(const Exec& exec);
  void findContenders(const Exec& exec);
  void compare(std::size_t n, std::size_t j);
  bool moveNodes(const std::vector<std::vector<Index>>& leaving);
  void listMembers();
  double moveToCentroids(const Exec& exec);
  bool centroid(const std::vector<Index>& members, std::vector<double>& out) const;
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
  std::vector<float> copy(nodes * wider, 0.0f);
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
  resized.push_back(1);
  drift.push_back(0);
  radius2.push_back(-1);
  members.emplace_back();
  if (j == 0) {
    std::fill(label.begin(), label.end(), 0);
    listMembers();
  }
  if (allStale) return;
  assign(exec);
}

/// Compares node n with site j.
void Lloyd::Impl::compare(std::size_t n, std::size_t j) {
  const double d2 = squaredDistanceTo(n, j);
  const auto current = static_cast<std::size_t>(label[n]);
  const bool nearer = d2 < distance2[n] || (d2 == distance2[n] && j < current);
  if (bounded) {
    if (nearer) keepBound(n, current, std::sqrt(distance2[n]));
    keepBound(n, j, std::sqrt(d2));
  }
  if (!nearer) return;
  label[n] = static_cast<Index>(j);
  setDistance(n, d2);
}

/// The members of cells for which touched(cell), in parts of a size that suits threads.
template <class Touched>
std::vector<Lloyd::Impl::Chunk> Lloyd::Impl::chunksOf(const Touched& touched) const {
  constexpr std::size_t most = 4096;
  std::vector<Chunk> chunks;
  for (std::size_t c = 0; c < siteCount; ++c) {
    if (!touched(c)) continue;
    for (std::size_t begin = 0; begin < members[c].size(); begin += most)
      chunks.push_back({static_cast<Index>(c), begin, std::min(members[c].size(), begin + most)});
  }
  return chunks;
}

/// body(number of the chunk, chunk), in parallel where that is worth it.
template <class Body>
void Lloyd::Impl::forChunks(const Exec& exec, const std::vector<Chunk>& chunks, const Body& body) {
  std::size_t total = 0;
  for (const Chunk& c : chunks) total += c.end - c.begin;
  const std::size_t tasks = 1 + total * 4 * size / kTaskWork;
  parallelFor(exec, chunks.size(), (chunks.size() + tasks - 1) / tasks,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) body(i, chunks[i]);
              });
}

/// Distances of nodes whose own site has moved, and radii of the cells that have changed.
void Lloyd::Impl::measureCells(const Exec& exec) {
  const std::vector<Chunk> chunks = chunksOf([&](std::size_t c) { return moved[c] || resized[c]; });
  std::vector<double> largest(chunks.size(), -1);
  forChunks(exec, chunks, [&](std::size_t i, const Chunk& chunk) {
    for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
      const std::size_t n = at(members[at(chunk.cell)][k]);
      if (moved[at(chunk.cell)]) setDistance(n, squaredDistanceTo(n, at(chunk.cell)));
      largest[i] = std::max(largest[i], distance2[n]);
    }
  });
  for (std::size_t c = 0; c < siteCount; ++c)
    if (moved[c] || resized[c]) radius2[c] = -1, resized[c] = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i)
    radius2[at(chunks[i].cell)] = std::max(radius2[at(chunks[i].cell)], largest[i]);
}

/// Per cell the sites that may be nearer to one of its nodes than its own: those within twice its radius (a
/// site at twice a node's distance is farther from it than its own, by the triangle inequality), and among
/// sites that stayed none, since that comparison has been made before, with the same numbers.
void Lloyd::Impl::findContenders(const Exec& exec) {
  std::vector<Index> movedSites;
  for (std::size_t j = 0; j < siteCount; ++j)
    if (moved[j]) movedSites.push_back(static_cast<Index>(j));
  contenders.resize(siteCount);
  parallelFor(exec, siteCount, blockOf(siteCount * size), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      contenders[c].clear();
      if (radius2[c] < 0) continue;
      const double reach2 = 4 * radius2[c] * (1 + kSlack);
      const auto look = [&](std::size_t j) {
        if (j == c) return;
        const double apart2 = squaredDistance(&p[c * size], &p[j * size], size);
        if (apart2 <= reach2) contenders[c].push_back({std::sqrt(apart2) / 2, static_cast<Index>(j)});
      };
      if (moved[c] || allStale)
        for (std::size_t j = 0; j < siteCount; ++j) look(j);
      else
        for (const Index j : movedSites) look(at(j));
      std::sort(contenders[c].begin(), contenders[c].end(), [](const Contender& a, const Contender& b) {
        return a.half != b.half ? a.half < b.half : a.site < b.site;
      });
    }
  });
}

/// Makes labels exact. Returns whether one changed. Cost: where sites moved, and next to that.
bool Lloyd::Impl::assign(const Exec& exec) {
  measureCells(exec);
  findContenders(exec);
  const std::vector<Chunk> chunks = chunksOf([&](std::size_t c) { return !contenders[c].empty(); });
  std::vector<std::vector<Index>> leaving(chunks.size());
  forChunks(exec, chunks, [&](std::size_t i, const Chunk& chunk) {
    for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
      const Index n = members[at(chunk.cell)][k];
      const double own = limit[at(n)];
      for (const Contender& other : contenders[at(chunk.cell)]) {
        if (other.half > own) break;
        if (!isRuledOut(at(n), at(other.site))) compare(at(n), at(other.site));
      }
      if (label[at(n)] != chunk.cell) leaving[i].push_back(n);
    }
  });
  std::fill(moved.begin(), moved.end(), 0);
  allStale = false;
  return moveNodes(leaving);
}

/// Brings `members` up to the labels, of which those of `leaving` have changed.
bool Lloyd::Impl::moveNodes(const std::vector<std::vector<Index>>& leaving) {
  std::vector<std::size_t> before(siteCount);
  std::vector<char> loses(siteCount, 0);
  for (std::size_t c = 0; c < siteCount; ++c) before[c] = members[c].size();
  bool any = false;
  for (const auto& list : leaving)
    for (const Index n : list) {
      members[at(label[at(n)])].push_back(n);
      any = true;
    }
  if (!any) return false;
  for (std::size_t c = 0; c < siteCount; ++c)
    for (std::size_t k = 0; k < before[c] && !loses[c]; ++k)
      loses[c] = label[at(members[c][k])] != static_cast<Index>(c);
  for (std::size_t c = 0; c < siteCount; ++c) {
    std::vector<Index>& list = members[c];
    if (list.size() == before[c] && !loses[c]) continue;
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(before[c]);
    std::sort(middle, list.end());
    std::inplace_merge(list.begin(), middle, list.end());
    std::erase_if(list, [&](Index n) { return label[at(n)] != static_cast<Index>(c); });
    dirty[c] = resized[c] = 1;
  }
  return true;
}

void Lloyd::Impl::listMembers() {
  for (auto& list : members) list.clear();
  for (std::size_t n = 0; n < nodes; ++n) members[at(label[n])].push_back(static_cast<Index>(n));
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

/// Moves the sites of cells that changed, but not those pinned. Returns the farthest move, m.
double Lloyd::Impl::moveToCentroids(const Exec& exec) {
  std::vector<double> step(siteCount, 0.0);
  parallelFor(exec, siteCount, blockOf(nodes * size / siteCount), [&](std::size_t begin, std::size_t end) {
    std::vector<double> target;
    for (std::size_t j = begin; j < end; ++j) {
      if (j < pinned || !dirty[j] || members[j].empty() || !centroid(members[j], target)) continue;
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
  const std::vector<Index> before = label;
  const std::vector<Index> flooded = floodLabels({x.data(), p.data(), nodes, siteCount, size}, graph);
  assign(exec);  // the nearest sites, for nodes that no flood has reached
  for (std::size_t n = 0; n < nodes; ++n) {
    if (flooded[n] < 0) continue;
    label[n] = flooded[n];
    setDistance(n, squaredDistanceTo(n, at(flooded[n])));
  }
  for (std::size_t n = 0; n < nodes; ++n)
    if (label[n] != before[n]) dirty[at(label[n])] = dirty[at(before[n])] = 1;
  listMembers();
  std::fill(resized.begin(), resized.end(), 1);
  allStale = true;
  bounded = false;
  return label != before;
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

void Lloyd::pin(std::size_t count) { impl_->pinned = std::min(count, impl_->siteCount); }
std::size_t Lloyd::siteCount() const { return impl_->siteCount; }
std::size_t Lloyd::pinnedCount() const { return impl_->pinned; }
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
