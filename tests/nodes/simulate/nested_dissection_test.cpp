#include "simulate/nested_dissection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/rng.h"
#include "simulate/separator.h"
#include "simulate/statics.h"
#include "support/tet_families.h"

using namespace sherd;
using namespace sherd::families;

namespace {

/// A square grid of n × n nodes with their eight neighbours.
Adjacency grid(Index n) {
  Adjacency a;
  a.begin.push_back(0);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      for (Index x = std::max(i - 1, 0); x <= std::min(i + 1, n - 1); ++x)
        for (Index y = std::max(j - 1, 0); y <= std::min(j + 1, n - 1); ++y)
          if (x != i || y != j) a.node.push_back(x * n + y);
      a.begin.push_back(a.node.size());
    }
  return a;
}

struct Parts {
  std::vector<Index> between;
  std::array<std::size_t, 2> sizes{0, 0};
};

/// Sides for the nodes of which `low` holds, the low ones that touch others between.
Parts partsOf(SeparatorRefinement& refinement, const Adjacency& graph, const std::vector<char>& low) {
  Parts parts;
  for (std::size_t n = 0; n < low.size(); ++n) {
    const auto node = static_cast<Index>(n);
    const std::span<const Index> around = graph.of(node);
    const bool touches = std::any_of(around.begin(), around.end(), [&](Index m) { return low[at(m)] == 0; });
    Side& side = refinement.side(node) = low[n] == 0 ? Side::High : touches ? Side::Between : Side::Low;
    if (side == Side::Between)
      parts.between.push_back(node);
    else
      ++parts.sizes[static_cast<std::size_t>(side)];
  }
  return parts;
}

TEST(SeparatorRefinement, RaggedBecomesStraight) {
  constexpr Index n = 12;
  const Adjacency graph = grid(n);
  SeparatorRefinement refinement(graph);
  std::vector<char> low(n * n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) low[at(i * n + j)] = i + (j / 2) % 2 * 2 < 6 ? 1 : 0;
  Parts parts = partsOf(refinement, graph, low);
  EXPECT_GT(parts.between.size(), at(n));
  refinement.refine(parts.between, parts.sizes, 30);
  EXPECT_EQ(parts.between.size(), at(n));
}

TEST(SeparatorRefinement, KeepsPartsApartAndNeverGrows) {
  constexpr Index n = 15;
  const Adjacency graph = grid(n);
  Rng rng(2);
  for (int run = 0; run < 50; ++run) {
    SeparatorRefinement refinement(graph);
    std::vector<char> low(n * n);
    for (char& l : low) l = rng.uniform() < 0.5 ? 1 : 0;
    Parts parts = partsOf(refinement, graph, low);
    const std::size_t before = parts.between.size();
    const std::size_t least = std::min(parts.sizes[0], parts.sizes[1]);
    refinement.refine(parts.between, parts.sizes, least);
    EXPECT_LE(parts.between.size(), before);
    std::array<std::size_t, 3> count{};
    for (Index v = 0; v < n * n; ++v) {
      const Side side = refinement.side(v);
      ++count[static_cast<std::size_t>(side)];
      EXPECT_EQ(side == Side::Between, std::binary_search(parts.between.begin(), parts.between.end(), v));
      for (const Index m : graph.of(v)) EXPECT_FALSE(side == Side::Low && refinement.side(m) == Side::High);
    }
    EXPECT_EQ(count[0], parts.sizes[0]);
    EXPECT_EQ(count[1], parts.sizes[1]);
    EXPECT_GE(std::min(count[0], count[1]), least);
  }
}

BlockMatrix patternOf(const TetMesh& mesh) {
  const Elements elements(shared(mesh), ElementOrder::Linear);
  const std::vector<double> share(mesh.tets.size(), 1.0);
  return assembleStiffness(elements, ElementRules(elements, share, {}), mesh.nodes, share, 0.4,
                           VolumetricSplit(Lame(0.2)));
}

/// Blocks of the factor: a node's column is what its own and its children's columns reach.
std::size_t factorBlocks(const BlockMatrix& k, const std::vector<Index>& order) {
  std::vector<Index> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[at(order[i])] = static_cast<Index>(i);
  std::vector<std::vector<Index>> column(order.size());
  for (std::size_t c = 0; c < k.size(); ++c)
    for (std::size_t e = at(k.begin[c]); e < at(k.begin[c + 1]); ++e) {
      const auto [low, high] = std::minmax(place[c], place[at(k.row[e])]);
      column[at(low)].push_back(high);
    }
  std::size_t blocks = 0;
  for (std::vector<Index>& rows : column) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    blocks += rows.size();
    if (rows.size() > 1) {
      std::vector<Index>& parent = column[at(rows[1])];
      parent.insert(parent.end(), rows.begin() + 1, rows.end());
    }
  }
  return blocks;
}

TEST(NestedDissection, EveryNodeOnceAndTheSameAgain) {
  const TetMesh mesh = twoBoxes(5, 1, 0.1);
  const BlockMatrix k = patternOf(mesh);
  const std::vector<Index> order = nestedDissection(mesh.nodes, k);
  EXPECT_EQ(order, nestedDissection(mesh.nodes, k));
  std::vector<Index> sorted = order, all(mesh.nodes.size());
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
}

/// Four thin legs on a plate, which planes across the longest extent would cut together; and a solid block.
/// Bounds are some 3 % above what was measured.
TEST(NestedDissection, KeepsFactorsOfBlocksAndLegsSmall) {
  const auto blocksOf = [](const TetMesh& mesh) {
    const BlockMatrix k = patternOf(mesh);
    return factorBlocks(k, nestedDissection(mesh.nodes, k));
  };
  const auto table = [](int i, int j, int l) { return l >= 16 || ((i < 3 || i >= 9) && (j < 3 || j >= 9)); };
  EXPECT_LT(blocksOf(fromCubes(cubesOf(12, 12, 19, table), Vec3(1, 1, 1))), 63'500U);
  EXPECT_LT(blocksOf(box(12, 12, 12, Vec3(1, 1, 1))), 182'000U);
}

}  // namespace
