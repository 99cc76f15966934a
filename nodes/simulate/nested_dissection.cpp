#include "simulate/nested_dissection.h"

#include <algorithm>
#include <array>
#include <limits>

#include "simulate/separator.h"

namespace sherd {
namespace {

constexpr std::size_t kSmallest = 24;  // nodes: their rows form one dense block, which BLAS likes
constexpr double kLeastPart = 0.3;     // share of a set that its smaller part may have
constexpr double kUnevenness = 2;      // what uneven parts cost, in shares of the separator

class Dissection {
 public:
  Dissection(std::span<const Vec3> positions, const BlockMatrix& graph)
      : positions_(positions), graph_(adjacency(graph)), rank_(graph.size(), kNone), refinement_(graph_) {}

  void order(std::vector<Index> nodes, std::vector<Index>& result) {
    if (nodes.size() <= kSmallest) {
      result.insert(result.end(), nodes.begin(), nodes.end());
      return;
    }
    Cut best;
    std::vector<Index> bestOrder;
    for (int way = 0; way < 4; ++way) {
      std::vector<Index> sorted = way < 3 ? alongAxis(nodes, way) : alongGraph(nodes);
      const Cut cut = bestCut(sorted);
      if (cut.cost < best.cost) {
        best = cut;
        bestOrder = std::move(sorted);
      }
    }
    Parts parts = split(bestOrder, best.position);
    order(std::move(parts.low), result);
    order(std::move(parts.high), result);
    result.insert(result.end(), parts.separator.begin(), parts.separator.end());
  }

 private:
  static constexpr Index kNone = -1;
  struct Cut {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t position = 0;  ///< nodes below it
  };
  struct Parts {
    std::vector<Index> low, high, separator;
  };

  static Adjacency adjacency(const BlockMatrix& graph) {
    Adjacency a;
    a.begin.assign(graph.size() + 1, 0);
    for (std::size_t column = 0; column < graph.size(); ++column)
      for (std::size_t e = at(graph.begin[column]) + 1; e < at(graph.begin[column + 1]); ++e) {
        ++a.begin[column + 1];
        ++a.begin[at(graph.row[e]) + 1];
      }
    for (std::size_t n = 0; n < graph.size(); ++n) a.begin[n + 1] += a.begin[n];
    a.node.resize(a.begin.back());
    std::vector<std::size_t> next(a.begin.begin(), a.begin.end() - 1);
    for (std::size_t column = 0; column < graph.size(); ++column)
      for (std::size_t e = at(graph.begin[column]) + 1; e < at(graph.begin[column + 1]); ++e) {
        a.node[next[column]++] = graph.row[e];
        a.node[next[at(graph.row[e])]++] = static_cast<Index>(column);
      }
    return a;
  }

  std::vector<Index> alongAxis(std::vector<Index> nodes, int axis) const {
    std::sort(nodes.begin(), nodes.end(), [&](Index a, Index b) {
      const double xa = positions_[at(a)][axis], xb = positions_[at(b)][axis];
      return xa != xb ? xa < xb : a < b;
    });
    return nodes;
  }

  /// In the order in which the nodes are reached from `first` along edges; unconnected ones follow on.
  std::vector<Index> reached(const std::vector<Index>& nodes, Index first) {
    for (const Index n : nodes) rank_[at(n)] = 0;
    std::vector<Index> found;
    const auto reach = [&](Index n) {
      if (rank_[at(n)] != 0) return;
      rank_[at(n)] = 1;
      found.push_back(n);
    };
    reach(first);
    std::size_t rest = 0;
    for (std::size_t i = 0; found.size() < nodes.size(); ++i) {
      while (i == found.size()) reach(nodes[rest++]);
      for (const Index n : graph_.of(found[i])) reach(n);
    }
    for (const Index n : nodes) rank_[at(n)] = kNone;
    return found;
  }
  /// From one end of the set to the other.
  std::vector<Index> alongGraph(const std::vector<Index>& nodes) {
    return reached(nodes, reached(nodes, reached(nodes, nodes.front()).back()).back());
  }

  /// Where to cut a sorted set so that few nodes touch the other side and the parts are about equal.
  Cut bestCut(const std::vector<Index>& sorted) {
    const std::size_t count = sorted.size();
    setRanks(sorted);
    // How many low nodes touch the high side, and the reverse, as changes from one position to the next: a
    // node is low beyond its own rank, and touches the high side up to its neighbours' last.
    std::vector<Index> low(count + 2, 0), high(count + 2, 0);
    for (const Index n : sorted) {
      const Index own = rank_[at(n)];
      Index first = own, last = own;
      for (const Index m : graph_.of(n)) {
        if (rank_[at(m)] == kNone) continue;
        first = std::min(first, rank_[at(m)]);
        last = std::max(last, rank_[at(m)]);
      }
      ++low[at(own) + 1];
      --low[at(last) + 1];
      ++high[at(first) + 1];
      --high[at(own) + 1];
    }
    clearRanks(sorted);
    Cut best;
    Index lowBorder = 0, highBorder = 0;
    for (std::size_t p = 0; p <= count; ++p) {
      lowBorder += low[p];
      highBorder += high[p];
      const double share = static_cast<double>(p) / static_cast<double>(count), uneven = 2 * share - 1;
      if (share < kLeastPart || share > 1 - kLeastPart) continue;
      const double cost = (std::min(lowBorder, highBorder) + 1) * (1 + kUnevenness * uneven * uneven);
      if (cost < best.cost) best = {cost, p};
    }
    return best;
  }

  /// Cuts a sorted set and makes the border of one side a small separator.
  Parts split(const std::vector<Index>& sorted, std::size_t position) {
    for (std::size_t i = 0; i < sorted.size(); ++i)
      refinement_.side(sorted[i]) = i < position ? Side::Low : Side::High;
    const std::vector<Index> low = border(sorted, Side::Low), high = border(sorted, Side::High);
    Parts parts;
    parts.separator = low.size() < high.size() ? low : high;
    for (const Index n : parts.separator) refinement_.side(n) = Side::Between;
    const std::size_t taken = parts.separator.size(), rest = sorted.size() - position;
    std::array<std::size_t, 2> sizes{position, rest};
    sizes[low.size() < high.size() ? 0 : 1] -= taken;
    refinement_.refine(parts.separator, sizes,
                       static_cast<std::size_t>(kLeastPart * static_cast<double>(sorted.size())));
    for (const Index n : sorted) {
      if (refinement_.side(n) == Side::Low) parts.low.push_back(n);
      if (refinement_.side(n) == Side::High) parts.high.push_back(n);
      refinement_.side(n) = Side::Elsewhere;
    }
    return parts;
  }
  /// Nodes of one side that touch the other.
  std::vector<Index> border(const std::vector<Index>& nodes, Side side) {
    const Side other = side == Side::Low ? Side::High : Side::Low;
    std::vector<Index> found;
    for (const Index n : nodes) {
      const std::span<const Index> around = graph_.of(n);
      if (refinement_.side(n) == side &&
          std::any_of(around.begin(), around.end(), [&](Index m) { return refinement_.side(m) == other; }))
        found.push_back(n);
    }
    return found;
  }

  void setRanks(const std::vector<Index>& sorted) {
    for (std::size_t i = 0; i < sorted.size(); ++i) rank_[at(sorted[i])] = static_cast<Index>(i);
  }
  void clearRanks(const std::vector<Index>& sorted) {
    for (const Index n : sorted) rank_[at(n)] = kNone;
  }

  std::span<const Vec3> positions_;
  Adjacency graph_;
  std::vector<Index> rank_;  ///< per node, its place in the set that is cut; kNone outside
  SeparatorRefinement refinement_;
};

}  // namespace

std::vector<Index> nestedDissection(std::span<const Vec3> positions, const BlockMatrix& graph) {
  std::vector<Index> all(graph.size()), result;
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = static_cast<Index>(n);
  result.reserve(all.size());
  Dissection(positions, graph).order(std::move(all), result);
  return result;
}

}  // namespace sherd
