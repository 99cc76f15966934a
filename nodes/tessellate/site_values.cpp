#include "tessellate/site_values.h"

#include <algorithm>
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

/// Marks what a site of rank w, with values g_w at the four nodes, undercuts: there it is less, or equal and
/// of lower rank.
template <class Undercuts>
void mark(const std::array<const double*, 4>& g, std::size_t w, std::size_t begin, std::size_t end,
          Undercuts undercuts, unsigned char* marked) {
  const double a = g[0][w], b = g[1][w], c = g[2][w], d = g[3][w];
  for (std::size_t k = begin; k < end; ++k)
    marked[k] |= static_cast<unsigned char>(undercuts(a, g[0][k]) & undercuts(b, g[1][k]) &
                                            undercuts(c, g[2][k]) & undercuts(d, g[3][k]));
}

}  // namespace

SiteValues::SiteValues(const Partition& partition, const Exec& exec) : siteOf_(sitesByRank(partition.sites)) {
  const Eigen::MatrixXd& nodes = partition.embedding->coordinates;
  const Eigen::VectorXd mean = nodes.rowwise().mean();
  Eigen::MatrixXd sites(nodes.rows(), static_cast<Eigen::Index>(siteOf_.size()));
  for (std::size_t r = 0; r < siteOf_.size(); ++r)
    sites.col(static_cast<Eigen::Index>(r)) = partition.sites.col(siteOf_[r]) - mean;
  const Eigen::VectorXd squared = sites.colwise().squaredNorm().transpose();
  values_.resize(sites.cols(), nodes.cols());
  least_.resize(static_cast<std::size_t>(nodes.cols()));
  parallelFor(exec, least_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
    const Eigen::MatrixXd block = nodes.middleCols(first, count).colwise() - mean;
    values_.middleCols(first, count).noalias() = -2 * (sites.transpose() * block);
    values_.middleCols(first, count).colwise() += squared;
    for (Eigen::Index n = first; n < first + count; ++n) {
      const double* g = values_.col(n).data();
      least_[static_cast<std::size_t>(n)] = static_cast<Index>(std::min_element(g, g + siteOf_.size()) - g);
    }
  });
}

void SiteValues::candidates(const Tetra& nodes, std::vector<Index>& out,
                            std::vector<unsigned char>& scratch) const {
  const std::size_t n = siteCount();
  const std::array<const double*, 4> g{at(nodes[0]), at(nodes[1]), at(nodes[2]), at(nodes[3])};
  scratch.assign(n, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const Index w = least(nodes[i]);
    const auto isRepeated = [&](std::size_t j) { return least(nodes[j]) == w; };
    if ((i > 0 && isRepeated(0)) || (i > 1 && isRepeated(1)) || (i > 2 && isRepeated(2))) continue;
    const std::size_t own = static_cast<std::size_t>(w);
    mark(
        g, own, 0, own, [](double x, double y) { return x < y; }, scratch.data());
    mark(
        g, own, own + 1, n, [](double x, double y) { return x <= y; }, scratch.data());
  }
  out.clear();
  for (std::size_t k = 0; k < n; ++k)
    if (scratch[k] == 0) out.push_back(static_cast<Index>(k));
}

}  // namespace sherd
