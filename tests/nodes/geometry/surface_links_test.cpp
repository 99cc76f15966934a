#include "geometry/surface_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "geometry/solid.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

/// What every surface's patches have to be.
void expectPatches(const TetMesh& tets) {
  const TrianglePatches& patches = tets.patches;
  std::vector<Index> all = patches.triangles;
  std::sort(all.begin(), all.end());
  ASSERT_EQ(all.size(), tets.surface->triangles.size());
  for (std::size_t t = 0; t < all.size(); ++t) ASSERT_EQ(all[t], static_cast<Index>(t));
  for (std::size_t p = 0; p < patches.count(); ++p) {
    const auto own = patches.trianglesOf(p);
    ASSERT_FALSE(own.empty());
    EXPECT_LE(own.size(), 32u);
    EXPECT_TRUE(std::is_sorted(own.begin(), own.end()));
    std::set<Index> reached{own[0]}, around;
    std::vector<Index> open{own[0]};
    while (!open.empty()) {
      const Index t = open.back();
      open.pop_back();
      for (const Index next : tets.surfaceNeighbours[at(t)])
        if (at(patches.patchOf[at(next)]) == p && reached.insert(next).second) open.push_back(next);
    }
    EXPECT_EQ(reached.size(), own.size()) << "patch " << p << " is in several parts";
    for (const Index t : own) {
      EXPECT_EQ(at(patches.patchOf[at(t)]), p);
      for (const Index next : tets.surfaceNeighbours[at(t)])
        if (at(patches.patchOf[at(next)]) != p) around.insert(patches.patchOf[at(next)]);
    }
    const auto neighbours = patches.neighboursOf(p);
    EXPECT_EQ(std::vector<Index>(neighbours.begin(), neighbours.end()),
              std::vector<Index>(around.begin(), around.end()));
  }
}

SolidSums total(const TrianglePatches& patches) {
  SolidSums sums;
  for (const SolidSums& s : patches.sums) sums += s;
  return sums;
}

TEST(SurfaceLinks, PatchesCoverTheSurfaceAndAddUpToTheBody) {
  for (const TriMesh& surface :
       {families::sphereSurface(Vec3(1, 2, 3), 2, 48, 24), families::torusSurface(3, 1, 40, 20),
        families::boxSurface(Vec3(-1, -1, -1), Vec3(1, 2, 3), 4, 4, 4)}) {
    const auto tets = families::cagedInBlock(surface, 3);
    TetMesh linked = *tets;
    linkSurface(linked, Exec{});
    expectPatches(linked);
    EXPECT_TRUE(
        std::all_of(linked.patches.regular.begin(), linked.patches.regular.end(), [](auto r) { return r; }));
    EXPECT_LT(linked.patches.count(), surface.triangles.size() / 15) << "patches are small";
    const SolidIntegrals sum = integralsOf(total(linked.patches), linked.patches.origin);
    const SolidIntegrals whole = integrateSolid(surface.positions, surface.triangles);
    EXPECT_NEAR(sum.volume, whole.volume, 1e-13 * whole.volume);
    EXPECT_LT((sum.centroid - whole.centroid).norm(), 1e-13);
    EXPECT_LT((sum.secondMoment - whole.secondMoment).norm(), 1e-13 * whole.secondMoment.norm());
  }
}

/// Two boxes that touch in an edge, which four triangles share then.
TriMesh boxesSharingAnEdge() {
  TriMesh both = families::boxSurface(Vec3::Zero(), Vec3(1, 1, 1), 1, 1, 1);
  const TriMesh other = families::boxSurface(Vec3(1, 1, 0), Vec3(2, 2, 1), 1, 1, 1);
  std::vector<Index> number;
  for (const Vec3& p : other.positions) {
    const auto found = std::find(both.positions.begin(), both.positions.end(), p);
    number.push_back(static_cast<Index>(found - both.positions.begin()));
    if (found == both.positions.end()) both.positions.push_back(p);
  }
  for (const Triangle& t : other.triangles)
    both.triangles.push_back({number[at(t[0])], number[at(t[1])], number[at(t[2])]});
  return both;
}

TEST(SurfaceLinks, TrianglesAtAnEdgeOfFourStandAlone) {
  const auto tets = families::cagedInBlock(boxesSharingAnEdge(), 3);
  TetMesh linked = *tets;
  linkSurface(linked, Exec{});
  expectPatches(linked);
  std::size_t irregular = 0;
  for (std::size_t p = 0; p < linked.patches.count(); ++p)
    if (!linked.patches.regular[p]) {
      ++irregular;
      EXPECT_EQ(linked.patches.trianglesOf(p).size(), 1u);
    }
  EXPECT_EQ(irregular, 4u);
}

TEST(SurfaceLinks, VerticesAreInTheirTetrahedra) {
  const auto tets = families::cagedInBlock(families::sphereSurface(Vec3::Zero(), 1, 24, 12), 4);
  TetMesh linked = *tets;
  linkSurface(linked, Exec{});
  for (std::size_t v = 0; v < linked.vertexTet.size(); ++v) {
    ASSERT_GE(linked.vertexTet[v], 0);
    const Tetra& tet = linked.tets[at(linked.vertexTet[v])];
    for (const auto& face : kTetraFace) {
      const Vec3& a = linked.nodes[at(tet[static_cast<std::size_t>(face[0])])];
      const Vec3 u = linked.nodes[at(tet[static_cast<std::size_t>(face[1])])] - a,
                 w = linked.nodes[at(tet[static_cast<std::size_t>(face[2])])] - a;
      EXPECT_LE(u.cross(w).dot(linked.surface->positions[v] - a), 1e-14);
    }
  }
}

}  // namespace
}  // namespace sherd
