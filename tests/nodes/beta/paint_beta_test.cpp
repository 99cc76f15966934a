#include "beta/paint_beta.h"

#include "geometry/point_triangle.h"
#include "nodes/beta/fields.h"
#include "support/said.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

using namespace test;
using Params = PaintBetaParams;

Stroke dab(const Vec3& p, double radius, double value, Blend blend = Blend::Replace, double falloff = 0.5) {
  return {{p}, radius, falloff, value, blend};
}

Result<ScalarGrid> paint(const Params& params, const PaintBetaInputs& inputs = {}) {
  return paintBeta(inputs, params, {});
}

ScalarGrid painted(const Params& params, const PaintBetaInputs& inputs = {}) {
  const auto result = paint(params, inputs);
  EXPECT_TRUE(result.ok()) << errorOf(result);
  return result.ok() ? *result : ScalarGrid::constant(-999);
}

/// The value at the voxel nearest to a point, without interpolation.
double voxelAt(const ScalarGrid& grid, const Vec3& p) {
  if (grid.isConstant()) return sampleAt(grid, p);
  const Vec3 q = grid.impl().frame.toFile(p);
  const openvdb::Vec3d index = voxelsOf(grid).worldToIndex(openvdb::Vec3d(q.x(), q.y(), q.z()));
  return static_cast<double>(voxelsOf(grid).tree().getValue(openvdb::Coord::round(index)));
}

const Vec3 kZero = Vec3::Zero();
constexpr Blend kBlends[] = {Blend::Replace, Blend::Add, Blend::Multiply, Blend::Max, Blend::Min};

// ---- What costs nothing

TEST(PaintBeta, NothingPaintedIsAConstantWithoutVoxels) {
  Params params;
  params.background = 3;
  const ScalarGrid grid = painted(params);
  EXPECT_TRUE(grid.isConstant());
  EXPECT_EQ(sampleAt(grid, Vec3(1, 2, 3)), 3);
  EXPECT_EQ(grid.name(), "beta");
  EXPECT_LT(byteSize(grid), 1000u);
}

TEST(PaintBeta, ConstantsStayConstantsWhateverIsDone) {
  const ScalarGrid two = ScalarGrid::constant(2), five = ScalarGrid::constant(5);
  const double wanted[] = {5, 7, 10, 5, 2};
  for (std::size_t i = 0; i < 5; ++i) {
    Params params;
    params.blend = kBlends[i];
    params.smooth = 0.1;
    const ScalarGrid grid = painted(params, {&two, &five, nullptr});
    EXPECT_TRUE(grid.isConstant());
    EXPECT_EQ(sampleAt(grid, kZero), wanted[i]);
  }
  Params params;
  params.threshold = 2;
  params.high = 9;
  EXPECT_EQ(sampleAt(painted(params, {&two, nullptr, nullptr}), kZero), 9);
}

TEST(PaintBeta, AGridThatNothingIsDoneToIsPassedOn) {
  Params params;
  params.strokes = {dab(kZero, 0.1, 4)};
  const ScalarGrid grid = painted(params);
  EXPECT_EQ(&painted({}, {&grid, nullptr, nullptr}).impl(), &grid.impl());
  Params renamed;
  renamed.name = "mask";
  const ScalarGrid other = painted(renamed, {&grid, nullptr, nullptr});
  EXPECT_EQ(other.name(), "mask");
  expectSame(voxelsOf(other), voxelsOf(grid));
}

// ---- Strokes

TEST(PaintBeta, ADabFadesAsItsStrengthSays) {
  Params params;
  params.background = 1;
  params.voxel = 0.01;
  params.strokes = {dab(Vec3(0.3, -0.2, 0.1), 0.2, 5, Blend::Replace, 0.5)};
  const ScalarGrid grid = painted(params);
  std::size_t inside = 0;
  for (int i = -60; i < 60; ++i)
    for (int j = -60; j < 60; ++j)
      for (int k = -60; k < 60; ++k) {
        const double d = (0.01 * Vec3(i, j, k) - Vec3(0.3, -0.2, 0.1)).norm();
        const double t = std::clamp((d - 0.1) / 0.1, 0.0, 1.0), s = 1 - t * t * (3 - 2 * t);
        EXPECT_NEAR(static_cast<double>(voxelsOf(grid).tree().getValue({i, j, k})), 1 + 4 * s, 1e-6);
        inside += d < 0.2 - 1e-9;
      }
  EXPECT_NEAR(static_cast<double>(voxelsOf(grid).activeVoxelCount()), static_cast<double>(inside), 10);
  EXPECT_EQ(sampleAt(grid, Vec3(9, 9, 9)), 1);
}

TEST(PaintBeta, FalloffOfNoneIsSharpAndOfOneReachesTheMiddle) {
  Params params;
  params.voxel = 0.01;
  for (const double falloff : {0.0, 1.0}) {
    params.strokes = {dab(kZero, 0.1, 3, Blend::Replace, falloff)};
    const ScalarGrid grid = painted(params);
    EXPECT_EQ(voxelAt(grid, kZero), 3);
    EXPECT_NEAR(voxelAt(grid, Vec3(0.05, 0, 0)), falloff == 0 ? 3 : 2, 1e-6);
    EXPECT_EQ(voxelAt(grid, Vec3(0.11, 0, 0)), 1);
  }
}

TEST(PaintBeta, EveryBlend) {
  const double wanted[] = {3, 5, 6, 3, 2};
  for (std::size_t i = 0; i < 5; ++i) {
    Params params;
    params.background = 2;
    params.strokes = {dab(kZero, 0.1, 3, kBlends[i])};
    EXPECT_EQ(voxelAt(painted(params), kZero), wanted[i]);
  }
}

TEST(PaintBeta, AStrokeThatCrossesItselfCountsOnceAndTwoCountTwice) {
  Params params;
  const Stroke cross{{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, 0.1, 0.5, 2, Blend::Multiply};
  params.strokes = {cross};
  EXPECT_EQ(voxelAt(painted(params), kZero), 2);
  params.strokes = {cross, cross};
  EXPECT_EQ(voxelAt(painted(params), kZero), 4);
  params.strokes = {cross, dab(kZero, 0.1, 7)};
  EXPECT_EQ(voxelAt(painted(params), kZero), 7) << "in their order";
}

TEST(PaintBeta, ManyStrokesAgreeWithTheirDefinitionOnAnyLattice) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Rng rng(seed);
    const auto start = gridOf(1.5f);
    scatter(*start, 10, seed);
    start->setTransform(affineTransform(seed));
    const FileFrame frame{seed % 2 ? 1.0 : 0.5, seed % 3 ? FileFrame::Up::Y : FileFrame::Up::Z};
    const ScalarGrid canvas = scalarGridOf(start->deepCopy(), "beta", frame);
    const auto point = [&] { return Vec3(rng.uniform(), rng.uniform(), rng.uniform()); };
    Params params;
    for (std::size_t i = 0; i < 5; ++i) {
      Stroke stroke{{}, 0.1 + 0.4 * rng.uniform(), rng.uniform(), 4 * rng.uniform(), kBlends[i]};
      for (std::uint64_t n = rng.below(4) + 1; n > 0; --n) stroke.points.push_back(point());
      params.strokes.push_back(stroke);
    }
    const ScalarGrid grid = painted(params, {&canvas, nullptr, nullptr});
    for (int n = 0; n < 3000; ++n) {
      const openvdb::Coord c(static_cast<int>(rng.below(40)) - 15, static_cast<int>(rng.below(40)) - 15,
                             static_cast<int>(rng.below(40)) - 15);
      const openvdb::Vec3d world = start->indexToWorld(c);
      const Vec3 p = frame.toMetres(Vec3(world.x(), world.y(), world.z()));
      double value = static_cast<double>(start->tree().getValue(c));
      for (const Stroke& stroke : params.strokes) {
        double d = (p - stroke.points[0]).norm();
        for (std::size_t i = 1; i < stroke.points.size(); ++i)
          d = std::min(d, (p - closestOnSegment(p, stroke.points[i - 1], stroke.points[i])).norm());
        // A voxel holds a float.
        const double there = static_cast<double>(static_cast<float>(value));
        value = there + stroke.strengthAt(d) * (blended(stroke.blend, there, stroke.value) - there);
      }
      EXPECT_NEAR(static_cast<double>(voxelsOf(grid).tree().getValue(c)), value,
                  2e-6 * (1 + std::abs(value)));
    }
  }
}

TEST(PaintBeta, AThinStrokeIsAWarning) {
  Params params;
  params.voxel = 0.1;
  params.strokes = {dab(Vec3(0.05, 0.05, 0.05), 0.02, 5)};
  Said said;
  const auto result = paintBeta({}, params, said.exec);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(said.warning("stroke 1 has a radius of 0.02 m, less than a voxel of 0.1 m"));
  EXPECT_TRUE(result->isConstant());
}

TEST(PaintBeta, VoxelsAreAQuarterOfTheSmallestRadius) {
  Params params;
  params.strokes = {dab(kZero, 0.4, 5), dab(kZero, 0.2, 5)};
  EXPECT_EQ(voxelsOf(painted(params)).voxelSize().x(), 0.05);
  TriMesh mesh = families::sphereSurface(kZero, 1, 8, 8);
  mesh.frame = {0.1, FileFrame::Up::Z};
  const ScalarGrid grid = painted(params, {nullptr, nullptr, &mesh});
  EXPECT_DOUBLE_EQ(voxelsOf(grid).voxelSize().x(), 0.5) << "in the mesh's unit";
  EXPECT_EQ(grid.impl().frame.up, FileFrame::Up::Z);
  EXPECT_NEAR(sampleAt(grid, Vec3(0, 0.05, 0)), 5, 1e-6) << "strokes are in metres, y up, all the same";
}

TEST(PaintBeta, BodiesOfAnySizeAreTheSame) {
  const auto field = [](double scale) {
    TriMesh mesh = families::sphereSurface(kZero, scale, 12, 6);
    mesh.colorSets.push_back({"color", std::vector<Vec4>(mesh.cornerCount(), Vec4::Constant(0.7))});
    Params params;
    params.source = PaintSource::Colors;
    params.strokes = {dab(Vec3(0.3, 0, 0) * scale, 0.25 * scale, 6)};
    params.smooth = 0.05 * scale;
    return painted(params, {nullptr, nullptr, &mesh});
  };
  const ScalarGrid usual = field(1);
  for (const double scale : {0x1p-40, 0x1p-12, 0x1p+20, 0x1p+60}) {
    const ScalarGrid other = field(scale);
    EXPECT_TRUE(voxelsOf(other).tree().hasSameTopology(voxelsOf(usual).tree())) << scale;
    for (auto v = voxelsOf(usual).cbeginValueOn(); v; ++v)
      ASSERT_NEAR(voxelsOf(other).tree().getValue(v.getCoord()), *v, 1e-5) << scale;
  }
}

TEST(PaintBeta, PaintingIntoATileLeavesTheRestOfItWhole) {
  const auto start = gridOf(0, 0.01);
  start->tree().fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(127)), 2.0f);
  start->tree().prune();
  const std::size_t before = start->memUsage();
  const ScalarGrid canvas = scalarGridOf(start->deepCopy(), "beta", {});
  Params params;
  params.strokes = {dab(Vec3(0.5, 0.5, 0.5), 0.05, 3)};
  const ScalarGrid grid = painted(params, {&canvas, nullptr, nullptr});
  EXPECT_EQ(voxelAt(grid, Vec3(0.5, 0.5, 0.5)), 3);
  EXPECT_EQ(voxelAt(grid, Vec3(0.1, 0.1, 0.1)), 2);
  EXPECT_EQ(voxelsOf(grid).activeVoxelCount(), 128u * 128 * 128);
  EXPECT_LT(voxelsOf(grid).memUsage(), before + 8 * 3000 + 300000) << "of 8 blocks, and a branch above them";
}

// ---- Memory

TEST(PaintBeta, AShellInAThousandCubedCostsItsVoxels) {
  TriMesh mesh = families::sphereSurface(kZero, 0.495, 96, 48);
  mesh.colorSets.push_back({"color", std::vector<Vec4>(mesh.cornerCount(), Vec4::Ones())});
  Params params;
  params.source = PaintSource::Colors;
  params.voxel = 0.001;
  params.band = 0.0015;
  params.blend = Blend::Replace;
  const ScalarGrid grid = painted(params, {nullptr, nullptr, &mesh});
  const auto active = static_cast<double>(voxelsOf(grid).activeVoxelCount());
  const auto bytes = static_cast<double>(voxelsOf(grid).memUsage());
  const openvdb::Coord size = voxelsOf(grid).evalActiveVoxelDim();
  std::printf("a shell in %d x %d x %d: %.3g active voxels, %.3g bytes, %.1f a voxel\n", size.x(), size.y(),
              size.z(), active, bytes, bytes / active);
  EXPECT_GT(size.x(), 980);
  EXPECT_NEAR(active, 4 * std::numbers::pi * 495 * 495 * 3, 0.03 * 4 * std::numbers::pi * 495 * 495 * 3);
  EXPECT_LT(bytes, 32 * active);
  EXPECT_LT(bytes, 0.1 * 4e9) << "a tenth of a dense grid";
}

TEST(PaintBeta, TooManyVoxelsAreRefusedBeforeTheyAreMade) {
  Params params;
  params.strokes = {dab(kZero, 1, 5)};
  for (const double voxel : {1e-4, 1e-7, 1e-12}) {
    params.voxel = voxel;
    EXPECT_TRUE(says(errorOf(paint(params)), "voxel: painting this with voxels of"));
  }
  params.voxel = 0;
  params.strokes = {{{{0, 0, 0}, {1e9, 0, 0}}, 0.1, 0.5, 2, Blend::Replace}};
  EXPECT_TRUE(says(errorOf(paint(params)), "strokes: stroke 1 is more than"));
}

// ---- Wrong input

TEST(PaintBeta, WrongStrokesAndNumbersAreNamed) {
  const double nan = std::nan("");
  const auto text = [](const Stroke& stroke) {
    Params params;
    params.strokes = {dab(kZero, 1, 1), stroke};
    return errorOf(paint(params));
  };
  EXPECT_TRUE(says(text({{}, 1, 0.5, 1, Blend::Add}), "strokes: stroke 2 has no points"));
  EXPECT_TRUE(says(text(dab(Vec3(nan, 0, 0), 1, 1)), "stroke 2 has a point that is no number"));
  EXPECT_TRUE(says(text(dab(kZero, 0, 1)), "stroke 2 has no radius above zero"));
  EXPECT_TRUE(says(text(dab(kZero, 1, 1, Blend::Add, 1.5)), "stroke 2 has a falloff out of range"));
  EXPECT_TRUE(says(text(dab(kZero, 1, nan)), "stroke 2 has a value that is no number"));
  Params params;
  params.smooth = -1;
  EXPECT_TRUE(says(errorOf(paint(params)), "smooth: `smooth` is no length"));
  params = {};
  params.background = 1e39;
  EXPECT_TRUE(says(errorOf(paint(params)), "background: `background` is no number"));
}

TEST(PaintBeta, ValuesBeyondFloatsAreRefused) {
  Params params;
  params.background = 1e30;
  params.strokes = {dab(kZero, 1, 1e30, Blend::Multiply)};
  EXPECT_TRUE(says(errorOf(paint(params)), "strokes: what is painted grows beyond"));
}

TEST(PaintBeta, AFrustumIsResampledAsOtherOnly) {
  const auto grid = gridOf(1);
  grid->tree().fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(11)), 4.0f);
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(11)), 0.5, 2.0, 0.1));
  const openvdb::Vec3d middle = grid->indexToWorld(openvdb::Vec3d(5.5));
  const ScalarGrid frustum = scalarGridOf(grid, "beta", {});
  Params params;
  params.strokes = {dab(kZero, 0.1, 2)};
  EXPECT_TRUE(says(errorOf(paint(params, {&frustum, nullptr, nullptr})),
                   "grid: this grid follows a camera's frustum"));
  params.strokes.clear();
  EXPECT_TRUE(says(errorOf(paint(params, {nullptr, &frustum, nullptr})), "other: this grid follows"));
  params.voxel = 0.02;
  const ScalarGrid resampled = painted(params, {nullptr, &frustum, nullptr});
  EXPECT_NEAR(sampleAt(resampled, Vec3(middle.x(), middle.y(), middle.z())), 4, 1e-5);
}

// ---- Any number of threads

TEST(PaintBeta, SameBitsForAnyNumberOfThreads) {
  TriMesh mesh = families::sphereSurface(kZero, 0.4, 24, 12);
  mesh.colorSets.push_back({"color", {}});
  const Rng rng(3);
  for (std::size_t i = 0; i < mesh.cornerCount(); ++i)
    mesh.colorSets[0].rgba.push_back(Vec4::Constant(rng.uniformAt(i)));
  Params params;
  params.strokes = {dab(Vec3(0.1, 0.2, 0.3), 0.2, 3, Blend::Multiply),
                    dab(Vec3(0.2, 0.2, 0.3), 0.1, 3, Blend::Add)};
  params.smooth = 0.03;
  for (const PaintSource source : {PaintSource::Colors, PaintSource::Noise}) {
    params.source = source;
    std::optional<Digest> first;
    for (const int limit : {1, 2, 4}) {
      const Threads threads(limit);
      const Digest digest = digestOf(painted(params, {nullptr, nullptr, &mesh}));
      if (!first) first = digest;
      EXPECT_EQ(digest, *first);
    }
  }
}

}  // namespace
}  // namespace sherd
