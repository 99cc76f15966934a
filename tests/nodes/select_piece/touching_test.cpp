#include "select_piece/touching.h"

#include <gtest/gtest.h>

#include <map>

#include "geometry/solid.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

/// Vertices of one position become one, as in the pool of a fracture.
TriMesh welded(const TriMesh& mesh) {
  TriMesh out;
  std::map<std::array<double, 3>, Index> number;
  for (const Triangle& t : mesh.triangles) {
    Triangle& own = out.triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.positions[at(t[c])];
      const auto [found, isNew] =
          number.try_emplace({p.x(), p.y(), p.z()}, static_cast<Index>(out.positions.size()));
      if (isNew) out.positions.push_back(p);
      own[c] = found->second;
    }
  }
  return out;
}

TriMesh box(const Vec3& low, const Vec3& high, int n = 1) { return families::boxSurface(low, high, n, n, n); }

/// Two triangles at every edge, one fan at every vertex, nothing moved.
void expectManifold(const TriMesh& given, const ManifoldSurface& made) {
  ASSERT_EQ(made.triangles.size(), given.triangles.size());
  std::map<std::pair<Index, Index>, Index> next;  // directed edge to the third corner
  for (std::size_t t = 0; t < made.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(made.positions[at(made.triangles[t][c])], given.positions[at(given.triangles[t][c])]);
      const Index a = made.triangles[t][c], b = made.triangles[t][(c + 1) % 3];
      EXPECT_TRUE(next.try_emplace({a, b}, made.triangles[t][(c + 2) % 3]).second) << "edge used twice";
    }
  std::map<Index, std::size_t> degree;
  for (const auto& [edge, tip] : next) {
    EXPECT_TRUE(next.contains({edge.second, edge.first})) << "open edge";
    ++degree[edge.first];
  }
  for (const auto& [v, count] : degree) {
    auto edge = next.lower_bound({v, -1});
    const Index first = edge->first.second;
    Index around = first;
    std::size_t walked = 0;
    do {
      around = next.at({v, around});
      ++walked;
    } while (around != first && walked <= count);
    EXPECT_EQ(walked, count) << "several fans at vertex " << v;
  }
}

ManifoldSurface separated(const TriMesh& mesh) {
  const auto made = separateTouching(mesh.positions, mesh.triangles);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().text());
  if (!made.ok()) return {};
  expectManifold(mesh, *made);
  return *made;
}

TEST(Touching, AManifoldStaysAsItIs) {
  const TriMesh torus = families::torusSurface(1, 0.3, 12, 8);
  const ManifoldSurface made = separated(torus);
  EXPECT_EQ(made.triangles, torus.triangles);
  EXPECT_EQ(made.positions, torus.positions);
  EXPECT_EQ(made.touchingEdges, 0u);
  EXPECT_EQ(made.doubledVertices, 0u);
}

TEST(Touching, TwoBoxesThatMeetInAPoint) {
  const TriMesh mesh =
      welded(families::joined(box(Vec3(0, 0, 0), Vec3(1, 1, 1)), box(Vec3(1, 1, 1), Vec3(2, 2, 2))));
  ASSERT_EQ(mesh.positions.size(), 15u);
  const ManifoldSurface made = separated(mesh);
  EXPECT_EQ(made.doubledVertices, 1u);
  EXPECT_EQ(made.touchingEdges, 0u);
}

TEST(Touching, TwoBoxesThatMeetAlongAnEdge) {
  const TriMesh mesh =
      welded(families::joined(box(Vec3(0, 0, 0), Vec3(1, 1, 1)), box(Vec3(1, 1, 0), Vec3(2, 2, 1))));
  ASSERT_EQ(mesh.positions.size(), 14u);
  const ManifoldSurface made = separated(mesh);
  EXPECT_EQ(made.touchingEdges, 1u);
  EXPECT_EQ(made.doubledVertices, 2u);
}

TEST(Touching, AlongAChainOfEdgesTheSolidHangsTogether) {
  const TriMesh mesh =
      welded(families::joined(box(Vec3(0, 0, 0), Vec3(1, 1, 1), 3), box(Vec3(1, 1, 0), Vec3(2, 2, 1), 3)));
  const ManifoldSurface made = separated(mesh);
  EXPECT_EQ(made.touchingEdges, 3u);
  EXPECT_EQ(made.doubledVertices, 2u);  // the two in the middle of the chain; its ends are one fan each
}

TEST(Touching, FourBoxesAroundAnEdgeAndAVertex) {
  TriMesh mesh = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  for (int i = 1; i < 8; ++i) {
    if (__builtin_popcount(static_cast<unsigned>(i)) % 2 != 0) continue;
    const Vec3 low(i & 1, i >> 1 & 1, i >> 2 & 1);
    mesh = families::joined(mesh, box(low, low + Vec3::Ones()));
  }
  separated(welded(mesh));  // every pair of them shares an edge, all share the middle
}

TEST(Touching, APinchOfTwoFinsOfNoThickness) {
  TriMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.5, -1, 0)};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 1, 4}, {1, 0, 4}};
  separated(mesh);
}

TEST(Touching, AnOpenSurfaceIsRefusedWithThePlace) {
  TriMesh mesh = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles.pop_back();
  const auto made = separateTouching(mesh.positions, mesh.triangles);
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().what.find("not closed at ("), std::string::npos) << made.error().text();
}

}  // namespace
}  // namespace sherd
