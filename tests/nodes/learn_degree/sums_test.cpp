#include "learn_degree/sums.h"

#include <gtest/gtest.h>

#include <numeric>

#include "learn_degree/split_tree.h"
#include "support/lloyd_reference.h"

namespace sherd {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Columns columnsOf(const MatrixXd& m) {
  return {m.data(), static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols())};
}

TEST(Sums, AreThoseWrittenPlainly) {
  for (const int rows : {1, 3, 4, 8, 13})
    for (const int columns : {1, 7, 8, 21}) {
      const MatrixXd m = MatrixXd::Random(rows, columns);
      const VectorXd a = VectorXd::Random(columns), z = VectorXd::Random(rows);
      VectorXd y = z;
      addProduct(columnsOf(m), a.data(), y.data());
      EXPECT_LT((y - (z + m * a)).norm(), 1e-13);
      VectorXd distance2(columns);
      squaredDistances(columnsOf(m), z.data(), distance2.data());
      EXPECT_LT((distance2 - (m.colwise() - z).colwise().squaredNorm().transpose()).norm(), 1e-13);
      EXPECT_EQ((m.col(0) - m.col(0)).norm(), 0);
    }
  for (const int n : {1, 2, 7, 8, 9, 30}) {
    const MatrixXd u = MatrixXd::Random(n, n);
    const MatrixXd upper = u.triangularView<Eigen::Upper>();
    const VectorXd a = VectorXd::Random(n);
    EXPECT_NEAR(squaredNormOfProduct(columnsOf(u), a.data()), (upper.transpose() * a).squaredNorm(), 1e-12);
  }
  std::vector<double> v, w;
  double half = 0, threeQuarters = 0;
  for (int n = 0; n < 11; ++n) {
    v.push_back(0.1 + n), w.push_back(n % 3 == 0 ? 0 : 1.0 / n);
    half += std::pow(v.back() * w.back(), 0.5);
    threeQuarters += std::pow(v.back(), 0.25) * std::pow(w.back(), 0.75);
  }
  EXPECT_NEAR(rootSums(v, w).half, half, 1e-12);
  EXPECT_NEAR(rootSums(v, w).threeQuarters, threeQuarters, 1e-12);
}

/// E of a range, written plainly.
double energyOf(const Embedding& e, const std::vector<Index>& order, std::size_t begin, std::size_t end,
                const std::vector<double>& weight) {
  VectorXd first = VectorXd::Zero(e.coordinates.rows());
  double total = 0, sum = 0;
  for (std::size_t k = begin; k < end; ++k)
    total += weight[at(order[k])], first += weight[at(order[k])] * e.coordinates.col(order[k]);
  for (std::size_t k = begin; k < end && total > 0; ++k)
    sum += weight[at(order[k])] * (e.coordinates.col(order[k]) - first / total).squaredNorm();
  return sum;
}

TEST(SplitTree, EveryNodeOnceAndHalvesApart) {
  const auto c = reference::cloud(157, 4, 3);
  std::vector<Index> order = splitOrder(*c.embedding, Exec{});
  // The first split is across the cloud's longest direction, which is its first.
  double low = 0, high = 0;
  for (std::size_t k = 0; k < 78; ++k) low += c.embedding->coordinates(0, order[k]) / 78;
  for (std::size_t k = 78; k < 157; ++k) high += c.embedding->coordinates(0, order[k]) / 79;
  EXPECT_GT(std::abs(high - low), 0.4);
  std::sort(order.begin(), order.end());
  for (std::size_t k = 0; k < 157; ++k) EXPECT_EQ(order[k], static_cast<Index>(k));
}

TEST(SplitTree, PiecesAreCountedAsWrittenPlainly) {
  const auto c = reference::cloud(157, 4, 3);
  const std::vector<Index> order = splitOrder(*c.embedding, Exec{});
  const VectorXd centre = VectorXd::Constant(4, 0.1);
  const std::vector<double>& w = c.weights.weight;
  using Range = std::pair<std::size_t, std::size_t>;
  std::vector<Range> cells{{0, 157}};
  const auto energyIn = [&](const Range& r) { return energyOf(*c.embedding, order, r.first, r.second, w); };
  std::vector<double> path;
  for (int n = 1; n < 100; ++n) {
    double sum = 0;
    for (const Range& r : cells) sum += energyIn(r);
    path.push_back(sum);
    const auto most = std::max_element(cells.begin(), cells.end(), [&](const Range& a, const Range& b) {
      return energyIn(a) < energyIn(b);
    });
    const Range split = *most;
    const std::size_t middle = split.first + (split.second - split.first) / 2;
    *most = {split.first, middle};
    cells.push_back({middle, split.second});
  }
  for (const int n : {2, 3, 17, 60}) {
    const std::array thresholds{1.0000001 * path[at(n - 2)], std::sqrt(path[at(n - 1)] * path[at(n - 2)])};
    const TreeEnergy tree = treeEnergy(order, *c.embedding, centre, w, thresholds);
    EXPECT_NEAR(tree.logPieces[0], std::log(n - 1.0), 2e-5);
    EXPECT_NEAR(tree.logPieces[1], 0.5 * (std::log(n - 1.0) + std::log(n)), 1e-9);
    EXPECT_NEAR(tree.centred, path[0], 1e-12);
  }
  const TreeEnergy whole = treeEnergy(order, *c.embedding, centre, w, std::array{8 * path[0]});
  EXPECT_NEAR(whole.logPieces[0], -1.5 * std::log(8.0), 1e-9);
  EXPECT_NEAR(whole.weight, std::accumulate(w.begin(), w.end(), 0.0), 1e-12);
  double about = 0;
  for (int n = 0; n < 157; ++n) about += w[at(n)] * (c.embedding->coordinates.col(n) - centre).squaredNorm();
  EXPECT_NEAR(whole.whole, about, 1e-12);
}

TEST(SplitTree, EndsWhereNothingIsLeftToSplit) {
  const auto c = reference::cloud(20, 3, 4);
  const std::vector<Index> order = splitOrder(*c.embedding, Exec{});
  std::vector<double> w(20, 0.0);
  w[7] = 1, w[11] = 2;
  for (const double threshold : {1e-3, 1e-30, 1e-300}) {
    const TreeEnergy tree = treeEnergy(order, *c.embedding, VectorXd::Zero(3), w, std::array{threshold});
    EXPECT_LE(tree.logPieces[0], std::log(20.0));
    EXPECT_TRUE(std::isfinite(tree.logPieces[0]));
  }
  // All nodes at one place.
  Embedding point = *c.embedding;
  point.coordinates.setConstant(0.3);
  const TreeEnergy none =
      treeEnergy(splitOrder(point, Exec{}), point, VectorXd::Zero(3), w, std::array{1e-9});
  EXPECT_TRUE(std::isfinite(none.logPieces[0]));
}

}  // namespace
}  // namespace sherd
