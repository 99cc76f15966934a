#include "simulate/tet_bisection.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <queue>
#include <unordered_map>

namespace sherd {
namespace {

using Key = std::uint64_t;

Edge sorted(Index a, Index b) { return a < b ? Edge{a, b} : Edge{b, a}; }
Key keyOf(const Edge& e) { return static_cast<Key>(e[0]) << 32 | static_cast<Key>(e[1]); }

class Bisection {
 public:
  Bisection(std::span<const Vec3> nodes, std::span<const Tetra> tets, const WantedEdge& wanted)
      : wanted_(wanted) {
    out_.nodes.assign(nodes.begin(), nodes.end());
    out_.tets.assign(tets.begin(), tets.end());
    out_.parent.resize(tets.size());
    std::iota(out_.parent.begin(), out_.parent.end(), 0);
    for (std::size_t t = 0; t < tets.size(); ++t) addToEdges(static_cast<Index>(t));
    for (const Edge& e : tetEdges(tets)) offer(e);
  }

  DividedTets run() {
    while (!queue_.empty()) {
      const Edge e = queue_.top().edge;
      queue_.pop();
      while (around_.contains(keyOf(e))) halve(longestFrom(e));
    }
    sortByParent();
    return std::move(out_);
  }

 private:
  struct Long {
    double length;
    Edge edge;
    bool operator<(const Long& o) const { return length != o.length ? length < o.length : edge > o.edge; }
  };

  Long measured(const Edge& e) const {
    return {(out_.nodes[at(e[0])] - out_.nodes[at(e[1])]).squaredNorm(), e};
  }
  template <class F>
  void eachEdge(Index t, F&& f) const {
    const Tetra tet = out_.tets[at(t)];
    for (const auto& corner : kTetraEdge) f(sorted(tet[at(corner[0])], tet[at(corner[1])]));
  }
  void addToEdges(Index t) {
    eachEdge(t, [&](const Edge& e) { around_[keyOf(e)].push_back(t); });
  }

  /// Queues an edge that is longer than wanted.
  void offer(const Edge& e) {
    const Long edge = measured(e);
    const Vec3 middle = 0.5 * (out_.nodes[at(e[0])] + out_.nodes[at(e[1])]);
    for (const Index t : around_.at(keyOf(e))) {
      const double wanted = wanted_(middle, out_.parent[at(t)]);
      if (edge.length > wanted * wanted) return queue_.push(edge);
    }
  }

  /// From an edge to a longer one of its tetrahedra, until none of them has one.
  Edge longestFrom(const Edge& from) const {
    Long longest = measured(from);
    for (bool found = true; found;) {
      found = false;
      for (const Index t : around_.at(keyOf(longest.edge)))
        eachEdge(t, [&](const Edge& e) {
          const Long other = measured(e);
          if (!(longest < other)) return;
          longest = other;
          found = true;
        });
    }
    return longest.edge;
  }

  void halve(const Edge& e) {
    const auto middle = static_cast<Index>(out_.nodes.size());
    out_.nodes.emplace_back(0.5 * (out_.nodes[at(e[0])] + out_.nodes[at(e[1])]));
    out_.halved.push_back(e);
    const std::vector<Index> cut = around_.at(keyOf(e));
    std::vector<Edge> made;
    for (const Index t : cut) {
      eachEdge(t, [&](const Edge& own) {
        std::erase(around_.at(keyOf(own)), t);
        made.push_back(own);
      });
      const auto other = static_cast<Index>(out_.tets.size());
      Tetra half = out_.tets[at(t)];
      std::replace(out_.tets[at(t)].begin(), out_.tets[at(t)].end(), e[1], middle);
      std::replace(half.begin(), half.end(), e[0], middle);
      out_.tets.push_back(half);
      out_.parent.push_back(out_.parent[at(t)]);
      for (const Index piece : {t, other}) {
        addToEdges(piece);
        eachEdge(piece, [&](const Edge& own) { made.push_back(own); });
      }
    }
    around_.erase(keyOf(e));
    std::sort(made.begin(), made.end());
    made.erase(std::unique(made.begin(), made.end()), made.end());
    for (const Edge& own : made)
      if (own[1] == middle || own[0] == middle) offer(own);
  }

  void sortByParent() {
    std::vector<std::size_t> order(out_.tets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return out_.parent[a] < out_.parent[b]; });
    std::vector<Tetra> tets;
    std::vector<Index> parent;
    for (const std::size_t t : order) {
      tets.push_back(out_.tets[t]);
      parent.push_back(out_.parent[t]);
    }
    out_.tets = std::move(tets);
    out_.parent = std::move(parent);
  }

  const WantedEdge& wanted_;
  DividedTets out_;
  std::unordered_map<Key, std::vector<Index>> around_;  ///< per edge, its tetrahedra
  std::priority_queue<Long> queue_;
};

}  // namespace

DividedTets divideTets(std::span<const Vec3> nodes, std::span<const Tetra> tets, const WantedEdge& wanted) {
  return Bisection(nodes, tets, wanted).run();
}

}  // namespace sherd
