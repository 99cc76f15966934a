#include "geometry/tet_edges.h"

#include <gtest/gtest.h>

#include "support/tet_families.h"

namespace sherd {
namespace {

TEST(TetEdges, OfACubeAreNineteen) {
  const TetMesh cube = families::box(1, 1, 1, Vec3(1, 1, 1));
  const std::vector<Edge> edges = tetEdges(cube.tets);
  EXPECT_EQ(edges.size(), 19u);  // 12 sides, 6 face diagonals, one through the cube
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_LT(edges[i][0], edges[i][1]);
    if (i > 0) {
      EXPECT_LT(edges[i - 1], edges[i]);
    }
  }
  const NodeGraph graph(8, edges);
  EXPECT_EQ(graph.neighbours(0).size(), 7u);
  std::size_t links = 0;
  for (Index n = 0; n < 8; ++n) {
    const auto near = graph.neighbours(n);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    links += near.size();
  }
  EXPECT_EQ(links, 38u);
}

TEST(TetEdges, NoTetsNoEdges) { EXPECT_TRUE(tetEdges({}).empty()); }

}  // namespace
}  // namespace sherd
