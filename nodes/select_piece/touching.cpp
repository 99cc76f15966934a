#include "select_piece/touching.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/disjoint_sets.h"
#include "geometry/edge_table.h"
#include "geometry/exact_points.h"

namespace sherd {
namespace {

/// One triangle at an edge a → b: its third corner, and whether it runs along the edge from a to b.
struct Leaf {
  Index triangle;
  Index tip;
  bool forward;
};

enum class Across { Empty, Solid };

class Separator {
 public:
  Separator(std::vector<Vec3> positions, std::vector<Triangle> triangles)
      : out_{std::move(positions), std::move(triangles)},
        points_(out_.positions),
        edges_(buildEdgeTable(out_.triangles, out_.positions.size())),
        across_(edges_.ends.size(), Across::Empty) {}

  Result<ManifoldSurface> run() {
    SHERD_CHECK(checkBalance());
    // Wedges of empty space first: then the solid hangs together, as whatever encloses it will.
    for (int round = 0; round < 2; ++round) {
      joinFans();
      const std::vector<Index> left = unresolvedEdges();
      if (left.empty()) {
        doubleVertices();
        return std::move(out_);
      }
      for (const Index e : left) across_[at(e)] = Across::Solid;
    }
    return failure("parts of the surface touch at " + place(unresolvedEdges().front()) +
                       " in a way that doubled vertices do not resolve",
                   "move the surface there apart by a hair", "pieces");
  }

 private:
  std::string place(Index edge) const {
    const auto& [a, b] = edges_.ends[at(edge)];
    const Vec3 p = 0.5 * (out_.positions[at(a)] + out_.positions[at(b)]);
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x(), p.y(), p.z());
  }

  std::vector<Leaf> leavesOf(Index edge) const {
    std::vector<Leaf> leaves;
    const auto& [a, b] = edges_.ends[at(edge)];
    for (const Index t : edges_.trianglesOf(edge))
      for (std::size_t c = 0; c < 3; ++c) {
        const Triangle& v = out_.triangles[at(t)];
        const Index from = v[c], to = v[(c + 1) % 3];
        if ((from == a && to == b) || (from == b && to == a))
          leaves.push_back({t, v[(c + 2) % 3], from == a});
      }
    return leaves;
  }

  Result<void> checkBalance() {
    for (std::size_t e = 0; e < edges_.ends.size(); ++e) {
      const std::size_t users = edges_.trianglesOf(static_cast<Index>(e)).size();
      if (users > 2) ++out_.touchingEdges;
      const std::vector<Leaf> leaves = leavesOf(static_cast<Index>(e));
      const auto forward =
          std::count_if(leaves.begin(), leaves.end(), [](const Leaf& l) { return l.forward; });
      if (2 * static_cast<std::size_t>(forward) != leaves.size())
        return failure("the surface is not closed at " + place(static_cast<Index>(e)),
                       "give a closed piece, as Tessellate makes them", "pieces");
    }
    return {};
  }

  /// Leaves counter-clockwise around the edge, seen against its direction.
  void sortAround(Index edge, std::vector<Leaf>& leaves) const {
    const auto [a, b] = edges_.ends[at(edge)];
    const Index first = leaves.front().tip;
    const auto half = [&](const Leaf& l) {
      return l.tip == first ? 0 : points_.orientation(a, b, first, l.tip) > 0 ? 1 : 2;
    };
    std::stable_sort(leaves.begin(), leaves.end(), [&](const Leaf& s, const Leaf& t) {
      const int hs = half(s), ht = half(t);
      if (hs != ht) return hs < ht;
      return s.tip != t.tip && points_.orientation(a, b, s.tip, t.tip) > 0;
    });
  }

  /// Counter-clockwise of a forward leaf lies empty space. Pairs opening with closing leaves as parentheses.
  std::vector<std::pair<Index, Index>> pairsAt(Index edge) const {
    std::vector<Leaf> leaves = leavesOf(edge);
    if (leaves.size() == 2) return {{leaves[0].triangle, leaves[1].triangle}};
    sortAround(edge, leaves);
    const bool opening = across_[at(edge)] == Across::Empty;
    int depth = 0, lowest = 0;
    std::size_t start = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      depth += leaves[i].forward == opening ? 1 : -1;
      if (depth < lowest) lowest = depth, start = i + 1;
    }
    std::rotate(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(start % leaves.size()),
                leaves.end());
    std::vector<std::pair<Index, Index>> pairs;
    std::vector<Index> open;
    for (const Leaf& l : leaves)
      if (l.forward == opening) {
        open.push_back(l.triangle);
      } else {
        pairs.emplace_back(open.back(), l.triangle);
        open.pop_back();
      }
    return pairs;
  }

  std::size_t corner(Index t, Index v) const {
    const Triangle& c = out_.triangles[at(t)];
    return 3 * at(t) + static_cast<std::size_t>(std::find(c.begin(), c.end(), v) - c.begin());
  }

  /// Corners of one vertex belong together that triangles join which are neighbours across an edge.
  void joinFans() {
    DisjointSets fans(std::max(3 * out_.triangles.size(), std::size_t{1}));
    for (std::size_t e = 0; e < edges_.ends.size(); ++e)
      for (const auto& [s, t] : pairsAt(static_cast<Index>(e)))
        for (const Index v : edges_.ends[e]) fans.join(corner(s, v), corner(t, v));
    fanOf_.clear();
    for (std::size_t c = 0; c < 3 * out_.triangles.size(); ++c) fanOf_.push_back(fans.find(c));
  }

  /// Edges whose pairs end in the same fans at both ends.
  std::vector<Index> unresolvedEdges() const {
    std::vector<Index> left;
    for (std::size_t e = 0; e < edges_.ends.size(); ++e) {
      const auto pairs = pairsAt(static_cast<Index>(e));
      const auto& [a, b] = edges_.ends[e];
      bool same = false;
      for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t j = i + 1; j < pairs.size(); ++j)
          same = same || (fanOf_[corner(pairs[i].first, a)] == fanOf_[corner(pairs[j].first, a)] &&
                          fanOf_[corner(pairs[i].first, b)] == fanOf_[corner(pairs[j].first, b)]);
      if (same) left.push_back(static_cast<Index>(e));
    }
    return left;
  }

  void doubleVertices() {
    std::vector<Index> vertexOf(fanOf_.size(), -1);
    std::vector<bool> taken(out_.positions.size(), false);
    for (std::size_t c = 0; c < fanOf_.size(); ++c) {
      Index& v = out_.triangles[c / 3][c % 3];
      Index& own = vertexOf[fanOf_[c]];
      if (own < 0) {
        own = v;
        if (taken[at(v)]) {
          own = static_cast<Index>(out_.positions.size());
          out_.positions.push_back(Vec3(out_.positions[at(v)]));
          ++out_.doubledVertices;
        } else {
          taken[at(v)] = true;
        }
      }
      v = own;
    }
  }

  ManifoldSurface out_;
  ExactPoints points_;  ///< of out_.positions before any is doubled
  EdgeTable edges_;
  std::vector<Across> across_;      ///< per edge
  std::vector<std::size_t> fanOf_;  ///< per corner
};

}  // namespace

Result<ManifoldSurface> separateTouching(std::vector<Vec3> positions, std::vector<Triangle> triangles) {
  return Separator(std::move(positions), std::move(triangles)).run();
}

}  // namespace sherd
