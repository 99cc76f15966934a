#include "repair/repair.h"

#include "base/hash.h"
#include "base/parallel.h"
#include "damage.h"

namespace sherd {
namespace {

using families::boxSurface;
using families::joined;
using families::reversed;
using families::sphereSurface;
using families::torusSurface;
using test::cube;
using test::missing;
using test::repaired;
using test::volumeOf;
using test::welded;

TEST(Repair, NothingCannotBeRepaired) {
  const auto nothing = repair({}, {}, {});
  ASSERT_FALSE(nothing.ok());
  EXPECT_NE(nothing.error().text().find("the mesh holds no triangles"), std::string::npos);
  TriMesh bad = cube();
  bad.positions[2].x() = std::nan("");
  EXPECT_NE(repair(bad, {}, {}).error().text().find("1 vertex that is not finite"), std::string::npos);
  for (const RepairParams params :
       {RepairParams{.crack = -1}, RepairParams{.leaf = 0}, RepairParams{.resolution = 2}})
    EXPECT_FALSE(repair(cube(), params, {}).ok());
}

TEST(Repair, SoundSurfacesPassBitForBit) {
  for (TriMesh mesh : {cube(), torusSurface(2, 0.5, 24, 12), joined(cube(), cube(Vec3(2, 0, 0))),
                       joined(cube(), reversed(cube(Vec3::Constant(0.25), 0.5)))}) {
    test::dress(mesh);
    Said said;
    const auto result = repair(mesh, {}, said.exec);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result->report.stage, RepairStage::None);
    EXPECT_TRUE(said.lines.empty());
    Hasher before, after;
    hashValue(before, mesh);
    hashValue(after, result->mesh);
    EXPECT_EQ(before.digest(), after.digest());
  }
}

TEST(Repair, StrictRefusesEachDefectByName) {
  const RepairParams strict{.mode = RepairParams::Mode::Strict};
  const auto refused = [&](const TriMesh& mesh) {
    const auto result = repair(mesh, strict, {});
    return result.ok() ? std::string() : result.error().text();
  };
  TriMesh open = cube();
  open.triangles.pop_back();
  EXPECT_NE(refused(open).find("3 open edges (the first near ("), std::string::npos);
  EXPECT_NE(refused(reversed(cube())).find("1 part turned inside out near ("), std::string::npos);
  EXPECT_NE(refused(joined(cube(), cube(Vec3(0.5, 0.25, 0.125)))).find("intersecting triangles"),
            std::string::npos);
  EXPECT_TRUE(repair(cube(), strict, {}).ok());
}

TEST(Repair, DoubleFacesGo) {
  TriMesh mesh = cube(Vec3::Zero(), 1, 3);
  const TriMesh whole = mesh;
  for (const std::size_t t : {3u, 7u, 7u}) mesh.triangles.push_back(whole.triangles[t]);
  std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
  const Repaired result = repaired(mesh);
  EXPECT_EQ(result.report.stage, RepairStage::Mended);
  EXPECT_FALSE(result.report.visible);
  EXPECT_EQ(test::triangleSet(result.mesh), test::triangleSet(whole));
  EXPECT_EQ(result.report.found.duplicateTriangles.count, 3u);
}

TEST(Repair, AWallBetweenTwoPartsGoes) {  // two cubes, welded along a face that both have
  const Repaired result = repaired(welded(joined(cube(), cube(Vec3(1, 0, 0)))));
  EXPECT_DOUBLE_EQ(volumeOf(result.mesh), 2);
  EXPECT_EQ(result.mesh.triangles.size(), 20u);
}

TEST(Repair, FlatFacesGoAndNothingMoves) {
  TriMesh mesh = cube();
  // A corner on an edge, with a triangle of no area between it and the edge.
  const Triangle cut = mesh.triangles[0];
  const auto middle = static_cast<Index>(mesh.positions.size());
  mesh.positions.push_back(0.5 * (mesh.positions[at(cut[0])] + mesh.positions[at(cut[1])]));
  mesh.triangles[0] = {cut[0], middle, cut[2]};
  mesh.triangles.push_back({middle, cut[1], cut[2]});
  mesh.triangles.push_back({cut[0], cut[1], middle});
  test::dress(mesh);
  const Repaired result = repaired(mesh);
  EXPECT_EQ(result.report.stage, RepairStage::Mended);
  EXPECT_FALSE(result.report.visible);
  EXPECT_EQ(result.report.found.zeroArea.count, 1u);
  EXPECT_DOUBLE_EQ(volumeOf(result.mesh), 1);
  EXPECT_EQ(result.mesh.positions.size(), 9u);
  EXPECT_EQ(result.mesh.triangles.size(), 14u);
  test::expectDressed(result.mesh);
}

TEST(Repair, CracksAreStitched) {
  TriMesh mesh = cube(Vec3::Zero(), 1, 4);
  TriMesh torn;  // every triangle with vertices of its own, off by less than can be seen
  Rng rng(5);
  for (const Triangle& t : mesh.triangles) {
    const auto v = static_cast<Index>(torn.positions.size());
    for (const Index corner : t)
      torn.positions.push_back(mesh.positions[at(corner)] +
                               1e-7 * Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5));
    torn.triangles.push_back({v, v + 1, v + 2});
  }
  const Repaired result = repaired(torn);
  EXPECT_EQ(result.report.stage, RepairStage::Mended);
  EXPECT_FALSE(result.report.visible);
  EXPECT_EQ(result.mesh.positions.size(), mesh.positions.size());
  EXPECT_NEAR(volumeOf(result.mesh), 1, 1e-6);
}

TEST(Repair, EdgesAgainstVerticesAreStitched) {  // a fine cube whose top is one coarse square
  TriMesh fine = cube(Vec3::Zero(), 1, 4);
  std::erase_if(fine.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index v) { return fine.positions[at(v)].y() == 1; });
  });
  TriMesh top;
  top.positions = {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
  top.triangles = {{0, 2, 1}, {0, 3, 2}};
  const Repaired result = repaired(welded(joined(fine, top)));
  EXPECT_EQ(result.report.stage, RepairStage::Mended);
  EXPECT_FALSE(result.report.visible);
  EXPECT_DOUBLE_EQ(volumeOf(result.mesh), 1);
  EXPECT_EQ(missing(fine, result.mesh), 0u);
}

TEST(Repair, HolesAreFilledAndLargeOnesWarnedOf) {
  TriMesh mesh = sphereSurface(Vec3::Zero(), 1, 48, 32);
  const double volume = volumeOf(mesh);
  mesh.triangles.erase(mesh.triangles.begin() + 700, mesh.triangles.begin() + 701);
  Said said;
  auto result = repair(mesh, {}, said.exec);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(said.info("filled 1 small hole near ("));
  EXPECT_FALSE(result->report.visible);
  EXPECT_NEAR(volumeOf(result->mesh), volume, 1e-12);
  EXPECT_EQ(missing(mesh, result->mesh), 0u);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index v) { return mesh.positions[at(v)].y() > 0.49; });
  });
  result = repair(welded(mesh), {}, said.exec);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(said.warning("filled 1 large hole"));
  EXPECT_TRUE(result->report.visible);
  EXPECT_EQ(missing(mesh, result->mesh), 0u);
  EXPECT_LT(volumeOf(result->mesh), volume);
}

TEST(Repair, InsideOutAndIncoherentPartsAreTurned) {
  EXPECT_DOUBLE_EQ(volumeOf(repaired(reversed(cube())).mesh), 1);
  TriMesh mesh = sphereSurface(Vec3::Zero(), 1, 24, 12);
  const TriMesh whole = mesh;
  Rng rng(3);
  for (Triangle& t : mesh.triangles)
    if (rng.uniform() < 0.3) std::swap(t[0], t[1]);
  test::dress(mesh);
  const Repaired result = repaired(mesh);
  EXPECT_EQ(result.report.stage, RepairStage::Mended);
  EXPECT_EQ(test::triangleSet(result.mesh), test::triangleSet(whole));
  test::expectDressed(result.mesh);  // normals of turned faces point outward
}

TEST(Repair, InnerShellsBoundNothingOrVoids) {
  const TriMesh mesh = joined(joined(cube(), cube(Vec3::Constant(0.25), 0.5)), cube(Vec3(3, 0, 0)));
  EXPECT_DOUBLE_EQ(volumeOf(repaired(mesh).mesh), 2);
  EXPECT_DOUBLE_EQ(volumeOf(repaired(mesh, {.innerShells = RepairParams::InnerShells::Void}).mesh),
                   2 - 0.125);
  // A wall of a void that faces it stays, also where all is inside out, and so does a core in the void.
  const TriMesh hollow =
      joined(joined(cube(), reversed(cube(Vec3::Constant(0.25), 0.5))), cube(Vec3::Constant(0.4), 0.2));
  EXPECT_DOUBLE_EQ(volumeOf(repaired(reversed(hollow)).mesh), 1 - 0.125 + 0.008);
}

TEST(Repair, CrossingPartsBecomeTheirUnion) {
  TriMesh mesh = joined(cube(), cube(Vec3(0.5, 0.25, 0.125)));
  test::dress(mesh);
  Said said;
  const Repaired result = repaired(mesh);
  EXPECT_EQ(result.report.stage, RepairStage::Hull);
  EXPECT_FALSE(result.report.visible);
  EXPECT_DOUBLE_EQ(volumeOf(result.mesh), 2 - 0.5 * 0.75 * 0.875);
  test::expectDressed(result.mesh);
}

TEST(Repair, PartsInOnePlaneBecomeTheirUnion) {  // overlapping in planes, in lines, and all the same
  EXPECT_DOUBLE_EQ(volumeOf(repaired(welded(joined(cube(), cube(Vec3(0.5, 0, 0))))).mesh), 1.5);
  EXPECT_DOUBLE_EQ(volumeOf(repaired(welded(joined(cube(), cube(Vec3(1, 0.5, 0.25))))).mesh), 2);
  EXPECT_DOUBLE_EQ(volumeOf(repaired(welded(joined(cube(), cube(Vec3(0.25, 0.25, 1), 0.5)))).mesh), 1.125);
  EXPECT_DOUBLE_EQ(volumeOf(repaired(welded(joined(cube(), cube()))).mesh), 1);
}

TEST(Repair, UntouchedTrianglesOfAUnionStay) {
  const TriMesh one = sphereSurface(Vec3::Zero(), 1, 24, 16),
                two = sphereSurface(Vec3(1.2, 0.3, 0.1), 0.7, 20, 14);
  const TriMesh mesh = joined(one, two);
  const Repaired result = repaired(mesh);
  EXPECT_EQ(result.report.stage, RepairStage::Hull);
  const double sum = volumeOf(one) + volumeOf(two);
  EXPECT_LT(volumeOf(result.mesh), sum);
  EXPECT_GT(volumeOf(result.mesh), volumeOf(one));
  const auto stayed = mesh.triangles.size() - missing(mesh, result.mesh);
  EXPECT_GT(stayed, mesh.triangles.size() / 2);
  // Inclusion and exclusion, with the intersection as the union of the complements.
  TriMesh inverted = joined(joined(reversed(one), reversed(two)), cube(Vec3::Constant(-4), 8));
  const Repaired rest = repaired(inverted);
  EXPECT_NEAR(volumeOf(rest.mesh), 512 - volumeOf(result.mesh), 1e-9);
}

TEST(Repair, SolidsThatTouchAreDrawnApart) {
  for (const Vec3& corner : {Vec3(1, 1, 0), Vec3(1, 1, 1)}) {
    const Repaired result = repaired(welded(joined(cube(), cube(corner))));
    EXPECT_FALSE(result.report.visible);
    EXPECT_NEAR(volumeOf(result.mesh), 2, 1e-5);
    EXPECT_EQ(result.mesh.triangles.size(), 24u);
    EXPECT_EQ(result.mesh.positions.size(), corner.z() == 0 ? 16u : 16u);
  }
  // A void that touches the outside in a corner.
  TriMesh tip = cube(Vec3::Zero(), 1, 2);
  TriMesh inner = reversed(sphereSurface(Vec3(0.5, 0.5, 0.5), 0.5, 4, 4));
  const Repaired result = repaired(welded(joined(tip, inner)));
  EXPECT_NEAR(volumeOf(result.mesh), 1 + volumeOf(inner), 1e-4);
}

TEST(Repair, LeavesGetAThickness) {
  TriMesh leaf;
  leaf.positions = {{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}};
  leaf.triangles = {{0, 1, 2}, {0, 2, 3}};
  Said said;
  auto result = repair(leaf, {}, said.exec);
  ASSERT_TRUE(result.ok()) << result.error().text();
  EXPECT_TRUE(said.warning("made 1 part without a solid behind it"));
  EXPECT_TRUE(result->report.visible);
  EXPECT_NEAR(volumeOf(result->mesh), 2 * 0.01 * std::sqrt(5.0), 1e-12);
  // A leaf within a solid is not seen; one that sticks out is.
  const auto standing = [](const Vec3& low) {
    TriMesh mesh;
    mesh.positions = {low, low + Vec3(0.4, 0, 0), low + Vec3(0, 0.4, 0)};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  };
  EXPECT_DOUBLE_EQ(volumeOf(repaired(joined(cube(), standing(Vec3(0.2, 0.2, 0.5)))).mesh), 1);
  EXPECT_GT(volumeOf(repaired(joined(cube(), standing(Vec3(0.2, 0.8, 0.5)))).mesh), 1.0001);
}

TEST(Repair, TheLevelSetSaysWhatItCost) {
  TriMesh mesh = sphereSurface(Vec3(5, 1, 2), 1, 32, 24);
  test::dress(mesh);
  Said said;
  const auto result = repair(mesh, {.mode = RepairParams::Mode::Rebuild, .resolution = 40}, said.exec);
  ASSERT_TRUE(result.ok()) << result.error().text();
  EXPECT_TRUE(inspectSurface(result->mesh).sound());
  EXPECT_EQ(result->report.stage, RepairStage::LevelSet);
  EXPECT_TRUE(said.warning("made the surface anew from a level set"));
  EXPECT_NEAR(volumeOf(result->mesh), volumeOf(mesh), 0.02 * volumeOf(mesh));
  EXPECT_GT(result->report.hausdorff, 0);
  EXPECT_LT(result->report.relativeHausdorff, 1.0 / 40);
  for (std::size_t k = 0; k < result->mesh.cornerCount(); ++k) {
    const Vec3& p = result->mesh.positions[at(result->mesh.triangles[k / 3][k % 3])];
    EXPECT_LT((result->mesh.colorSets[0].rgba[k].head<3>() - p).norm(), 1.01 * result->report.hausdorff);
  }
}

TEST(Repair, CancelledIsCancelled) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  for (const TriMesh& mesh : {cube(), joined(cube(), cube(Vec3(0.5, 0.25, 0.125)))})
    EXPECT_EQ(repair(mesh, {}, exec).error().kind, Error::Kind::Cancelled);
}

/// A sphere or a ring with random damage of every kind that stays a surface.
TriMesh damaged(std::uint64_t seed) {
  Rng rng(seed);
  TriMesh mesh = seed % 2 == 0 ? sphereSurface(Vec3::Zero(), 1, 20, 12) : torusSurface(1, 0.4, 24, 12);
  const std::size_t n = mesh.triangles.size();
  std::vector<Triangle> extra;
  std::vector<bool> gone(n, false);
  for (std::size_t t = 0; t < n; ++t) {
    const double dice = rng.uniform();
    if (dice < 0.05) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    if (dice > 0.97) gone[t] = true;
    if (dice > 0.5 && dice < 0.53) extra.push_back(mesh.triangles[t]);
    if (dice > 0.6 && dice < 0.62) {  // a crack: a corner of its own, a little off
      mesh.positions.push_back(mesh.positions[at(mesh.triangles[t][0])] + Vec3::Constant(1e-7));
      mesh.triangles[t][0] = static_cast<Index>(mesh.positions.size()) - 1;
    }
    if (dice > 0.7 && dice < 0.705)  // a spike through whatever is there
      mesh.positions[at(mesh.triangles[t][0])] *= -0.9;
  }
  for (std::size_t t = n; t-- > 0;)
    if (gone[t]) mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  mesh.triangles.insert(mesh.triangles.end(), extra.begin(), extra.end());
  return mesh;
}

TEST(Repair, SeededDamage) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    TriMesh mesh = damaged(seed);
    test::dress(mesh);
    const Repaired result = repaired(mesh);
    EXPECT_NE(result.report.stage, RepairStage::LevelSet);
    ASSERT_EQ(result.mesh.materialOf.size(), result.mesh.triangles.size());
    EXPECT_EQ(result.mesh.uvSets[0].uv.size(), result.mesh.cornerCount());
  }
}

TEST(Repair, SameBitsForAnyThreadCount) {
  const TriMesh mesh = damaged(4);
  const auto digest = [&](const RepairParams& params) {
    Hasher hasher;
    hashValue(hasher, repair(mesh, params, {})->mesh);
    return hasher.digest();
  };
  const int limit = threadLimit();
  for (const RepairParams params :
       {RepairParams{}, RepairParams{.mode = RepairParams::Mode::Rebuild, .resolution = 24}}) {
    setThreadLimit(1);
    const Digest one = digest(params);
    setThreadLimit(2);
    EXPECT_EQ(one, digest(params));
  }
  setThreadLimit(limit);
}

TEST(Repair, ScaleAndPlaceDoNotMatter) {
  for (const double scale : {1e-6, 1e6})
    for (const double away : {0.0, 1e3}) {
      TriMesh mesh = joined(cube(), cube(Vec3(0.5, 0.25, 0.125)));
      for (Vec3& p : mesh.positions) p = scale * (p + Vec3::Constant(away));
      const Repaired result = repaired(mesh);
      EXPECT_EQ(result.report.stage, RepairStage::Hull);
      EXPECT_NEAR(volumeOf(result.mesh), std::pow(scale, 3) * (2 - 0.5 * 0.75 * 0.875),
                  1e-8 * std::pow(scale, 3));
    }
}

}  // namespace
}  // namespace sherd
