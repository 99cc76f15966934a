#include "learn_degree/split_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "learn_degree/sums.h"

namespace sherd {
namespace {

constexpr int kPowerSteps = 24;  // the direction needn't be exact, only the same every time

/// The direction in which these points are spread the most, by power iteration from the farthest of them.
Eigen::VectorXd longestDirection(const Eigen::MatrixXd& centred) {
  Eigen::Index farthest = 0;
  centred.colwise().squaredNorm().maxCoeff(&farthest);
  Eigen::VectorXd direction = centred.col(farthest);
  const Eigen::MatrixXd spread = centred * centred.transpose();
  for (int k = 0; k < kPowerSteps && direction.squaredNorm() > 0; ++k)
    direction = spread * direction.normalized();
  return direction;
}

void halve(const Eigen::MatrixXd& coordinates, std::span<Index> part, const Exec& exec) {
  if (part.size() < 2 || exec.cancelled()) return;
  Eigen::MatrixXd centred = coordinates(Eigen::all, std::vector<Index>(part.begin(), part.end()));
  centred.colwise() -= Eigen::VectorXd(centred.rowwise().mean());
  const Eigen::VectorXd place = centred.transpose() * longestDirection(centred);
  std::vector<std::size_t> by(part.size());
  std::iota(by.begin(), by.end(), std::size_t{0});
  std::stable_sort(by.begin(), by.end(), [&](std::size_t a, std::size_t b) {
    return place[static_cast<Eigen::Index>(a)] < place[static_cast<Eigen::Index>(b)];
  });
  const std::vector<Index> before(part.begin(), part.end());
  for (std::size_t k = 0; k < by.size(); ++k) part[k] = before[by[k]];
  halve(coordinates, part.first(part.size() / 2), exec);
  halve(coordinates, part.subspan(part.size() / 2), exec);
}

/// A range of the order.
struct Cell {
  double energy;
  std::size_t begin, end;
  bool operator<(const Cell& other) const {
    return energy != other.energy ? energy < other.energy : begin > other.begin;
  }
};

/// Σ w x, Σ w and Σ w ‖x‖² of ranges.
class RangeSums {
 public:
  RangeSums(const std::vector<Index>& order, const Embedding& embedding, const Eigen::VectorXd& centre,
            const std::vector<double>& weight)
      : d_(static_cast<std::size_t>(embedding.coordinates.rows())), sums_((order.size() + 1) * (d_ + 2)) {
    runningSums({embedding.coordinates.data(), d_, order.size()}, centre.data(), weight.data(), order,
                sums_.data());
  }
  double weight() const { return sums_[sums_.size() - 2]; }
  double square() const { return sums_[sums_.size() - 1]; }

  Cell cell(std::size_t begin, std::size_t end) const {
    if (end - begin < 2) return {0, begin, end};
    const double *from = &sums_[begin * (d_ + 2)], *to = &sums_[end * (d_ + 2)];
    const double weight = to[d_] - from[d_];
    if (!(weight > 0)) return {0, begin, end};
    double first2 = 0;
    for (std::size_t i = 0; i < d_; ++i) first2 += (to[i] - from[i]) * (to[i] - from[i]);
    return {std::max(0.0, to[d_ + 1] - from[d_ + 1] - first2 / weight), begin, end};
  }

 private:
  std::size_t d_;
  std::vector<double> sums_;
};

/// Where the line from log `before` at N − 1 to log `after` at N falls to the threshold.
double logCrossing(double n, double before, double after, double threshold) {
  if (n < 2) return 1.5 * std::log(after / threshold);
  const double share = after < before ? std::log(before / threshold) / std::log(before / after) : 1;
  return std::log(n - 1) + std::clamp(share, 0.0, 1.0) * std::log(n / (n - 1));
}

}  // namespace

std::vector<Index> splitOrder(const Embedding& embedding, const Exec& exec) {
  std::vector<Index> order(static_cast<std::size_t>(embedding.coordinates.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  halve(embedding.coordinates, order, exec);
  return order;
}

TreeEnergy treeEnergy(const std::vector<Index>& order, const Embedding& embedding,
                      const Eigen::VectorXd& centre, const std::vector<double>& weight,
                      std::span<const double> thresholds) {
  const RangeSums sums(order, embedding, centre, weight);
  std::vector<Cell> cells{sums.cell(0, order.size())};
  TreeEnergy out{sums.square(), cells[0].energy, sums.weight(), {}};
  const double least = out.whole * 0x1p-52;  // below: rounding
  double before = 0, energy = cells[0].energy;
  for (const double threshold : thresholds) {
    while (!(energy < threshold) && cells.front().energy > least) {
      std::pop_heap(cells.begin(), cells.end());
      const Cell split = cells.back();
      const std::size_t middle = split.begin + (split.end - split.begin) / 2;
      const Cell low = sums.cell(split.begin, middle), high = sums.cell(middle, split.end);
      cells.back() = low;
      std::push_heap(cells.begin(), cells.end());
      cells.push_back(high);
      std::push_heap(cells.begin(), cells.end());
      before = energy;
      energy = std::max(0.0, energy + (low.energy + high.energy - split.energy));
    }
    out.logPieces.push_back(
        logCrossing(static_cast<double>(cells.size()), before, std::max(energy, least), threshold));
  }
  return out;
}

}  // namespace sherd
