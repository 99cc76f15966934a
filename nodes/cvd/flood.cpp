#include "cvd/flood.h"

#include <deque>
#include <limits>

#include "base/parallel.h"
#include "cvd/distance.h"

namespace sherd {
namespace {

class Flood {
 public:
  Flood(const FloodPoints& points, const NodeGraph& graph)
      : points_(points),
        graph_(graph),
        label_(points.nodeCount, -1),
        distance_(points.nodeCount, std::numeric_limits<double>::infinity()) {}

  std::vector<Index> run(const Exec& exec) {
    std::vector<Index> nearest(points_.siteCount, 0);
    parallelFor(exec, nearest.size(), 1 + (std::size_t{1} << 20) / (points_.nodeCount * points_.dimensions),
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t j = begin; j < end; ++j) nearest[j] = nearestNode(j);
                });
    for (std::size_t j = 0; j < nearest.size(); ++j) offer(nearest[j], static_cast<Index>(j));
    constexpr std::size_t often = 4096;
    for (std::size_t steps = 0; !queue_.empty() && (steps % often != 0 || !exec.cancelled()); ++steps) {
      const Index n = queue_.front();
      queue_.pop_front();
      for (const Index neighbour : graph_.neighbours(n)) offer(neighbour, label_[at(n)]);
    }
    return std::move(label_);
  }

 private:
  double distance(std::size_t n, std::size_t j) const {
    const std::size_t d = points_.dimensions;
    return squaredDistance(points_.nodes + n * d, points_.sites + j * d, d);
  }

  Index nearestNode(std::size_t j) const {
    std::size_t nearest = 0;
    double best = distance(0, j);
    for (std::size_t n = 1; n < points_.nodeCount; ++n)
      if (const double d = distance(n, j); d < best) best = d, nearest = n;
    return static_cast<Index>(nearest);
  }

  void offer(Index n, Index site) {
    if (label_[at(n)] == site) return;
    const double d = distance(at(n), at(site));
    if (d > distance_[at(n)] || (d == distance_[at(n)] && site > label_[at(n)])) return;
    distance_[at(n)] = d;
    label_[at(n)] = site;
    queue_.push_back(n);
  }

  const FloodPoints& points_;
  const NodeGraph& graph_;
  std::vector<Index> label_;
  std::vector<double> distance_;
  std::deque<Index> queue_;
};

}  // namespace

std::vector<Index> floodLabels(const FloodPoints& points, const NodeGraph& graph, const Exec& exec) {
  return Flood(points, graph).run(exec);
}

}  // namespace sherd
