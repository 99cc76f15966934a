#include "tessellate/site_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 128;  ///< nodes a task

std::vector<Index> sitesByRank(const Eigen::MatrixXd& sites) {
  std::vector<Index> order(static_cast<std::size_t>(sites.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  const auto before = [&](Index a, Index b) {
    const auto p = sites.col(a), q = sites.col(b);
    for (Eigen::Index i = 0; i < sites.rows(); ++i)
      if (p[i] != q[i]) return p[i] < q[i];
    return a < b;
  };
  std::sort(order.begin(), order.end(), before);
  return order;
}

/// Does the site of rank w undercut that of rank k: less, or equal and of lower rank, at all four nodes?
bool undercuts(const std::array<const double*, 4>& g, Index w, Index k) {
  // Without branches, which would go either way.
  if (w < k) return (g[0][w] <= g[0][k]) & (g[1][w] <= g[1][k]) & (g[2][w] <= g[2][k]) & (g[3][w] <= g[3][k]);
  return (g[0][w] < g[0][k]) & (g[1][w] < g[1][k]) & (g[2][w] < g[2][k]) & (g[3][w] < g[3][k]);
}

/// Per node the least one of the same coordinates.
std::vector<Index> firstOfPlace(const Eigen::MatrixXd& nodes) {
  std::vector<Index> order(static_cast<std::size_t>(nodes.cols())), first(order.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto compare = [&](Index a, Index b) {
    const double *p = nodes.col(a).data(), *q = nodes.col(b).data();
    return std::lexicographical_compare_three_way(p, p + nodes.rows(), q, q + nodes.rows());
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const auto c = compare(a, b);
    return c < 0 || (c == 0 && a < b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool isFirst = i == 0 || compare(order[i - 1], order[i]) != 0;
    first[static_cast<std::size_t>(order[i])] =
        isFirst ? order[i] : first[static_cast<std::size_t>(order[i - 1])];
  }
  return first;
}

/// Per node the largest distance to a neighbour.
std::vector<double> longestEdges(const Eigen::MatrixXd& nodes, std::span<const Tetra> tets) {
  std::vector<double> longest(static_cast<std::size_t>(nodes.cols()), 0);
  for (const Tetra& t : tets)
    for (const auto& e : kTetraEdge) {
      const Index a = t[static_cast<std::size_t>(e[0])], b = t[static_cast<std::size_t>(e[1])];
      const double length = (nodes.col(a) - nodes.col(b)).norm();
      longest[static_cast<std::size_t>(a)] = std::max(longest[static_cast<std::size_t>(a)], length);
      longest[static_cast<std::size_t>(b)] = std::max(longest[static_cast<std::size_t>(b)], length);
    }
  return longest;
}

}  // namespace

SiteValues::SiteValues(const Partition& partition, const Exec& exec) : siteOf_(sitesByRank(partition.sites)) {
  const Eigen::MatrixXd& nodes = partition.embedding->coordinates;
  const Eigen::VectorXd mean = nodes.rowwise().mean();
  Eigen::MatrixXd sites(nodes.rows(), static_cast<Eigen::Index>(siteOf_.size()));
  for (std::size_t r = 0; r < siteOf_.size(); ++r)
    sites.col(static_cast<Eigen::Index>(r)) = partition.sites.col(siteOf_[r]) - mean;
  const Eigen::VectorXd squared = sites.colwise().squaredNorm().transpose();
  std::vector<double> longest;
  std::vector<Index> place;
  TaskGroup tasks;  // each one thread's work
  tasks.run([&] { longest = longestEdges(nodes, partition.embedding->tets->tets); });
  tasks.run([&] { place = firstOfPlace(nodes); });
  near_.resize(static_cast<std::size_t>(nodes.cols()));
  values_.resize(sites.cols(), nodes.cols());
  least_.resize(static_cast<std::size_t>(nodes.cols()));
  parallelFor(exec, least_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
    const Eigen::MatrixXd block = nodes.middleCols(first, count).colwise() - mean;
    values_.middleCols(first, count).noalias() = -2 * (sites.transpose() * block);
    values_.middleCols(first, count).colwise() += squared;
  });
  // A product's last bits may hang on where a column stands in its block.
  tasks.wait();
  for (std::size_t n = 0; n < place.size(); ++n)
    if (place[n] != static_cast<Index>(n)) values_.col(static_cast<Eigen::Index>(n)) = values_.col(place[n]);
  parallelFor(exec, least_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (auto n = static_cast<Eigen::Index>(begin); n < static_cast<Eigen::Index>(end); ++n) {
      const double* g = values_.col(n).data();
      least_[static_cast<std::size_t>(n)] = static_cast<Index>(std::min_element(g, g + siteOf_.size()) - g);
      findNear(static_cast<std::size_t>(n), (nodes.col(n) - mean).squaredNorm(),
               longest[static_cast<std::size_t>(n)]);
    }
  });
}

/// A site that is least at a point x of a tetrahedron around node n is no farther from n than the least there
/// by more than twice the way from n to x: |n − p| ≤ |n − x| + |x − p| ≤ |n − x| + |x − q| ≤ 2 |n − x| + |n −
/// q|.
void SiteValues::findNear(std::size_t node, double squaredNorm, double way) {
  const double* g = at(static_cast<Index>(node));
  const double lowest = g[least_[node]], distance = std::sqrt(std::max(0.0, squaredNorm + lowest));
  const double highest = lowest + 4 * way * (distance + way);
  const double slack = 1e-9 * (squaredNorm + std::abs(lowest) + std::abs(highest));
  for (std::size_t k = 0; k < siteCount(); ++k)
    if (g[k] <= highest + slack) near_[node].push_back(static_cast<Index>(k));
}

std::span<const Index> SiteValues::nearestList(const Tetra& nodes) const {
  const auto* best = &near_[static_cast<std::size_t>(nodes[0])];
  for (const Index n : nodes)
    if (near_[static_cast<std::size_t>(n)].size() < best->size()) best = &near_[static_cast<std::size_t>(n)];
  return *best;
}

void SiteValues::candidates(const Tetra& nodes, std::vector<Index>& out) const {
  const std::array<const double*, 4> g{at(nodes[0]), at(nodes[1]), at(nodes[2]), at(nodes[3])};
  std::array<Index, 4> winners{};
  std::size_t count = 0;
  for (const Index n : nodes)
    if (std::find(winners.begin(), winners.begin() + count, least(n)) == winners.begin() + count)
      winners[count++] = least(n);
  out.clear();
  for (const Index k : nearestList(nodes)) {
    bool undercut = false;
    for (std::size_t w = 0; w < count && !undercut; ++w)
      undercut = winners[w] != k && undercuts(g, winners[w], k);
    if (!undercut) out.push_back(k);
  }
}

}  // namespace sherd
