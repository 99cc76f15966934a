// Colours, noise, other grids, smoothing and thresholds.
#include "beta/paint_beta.h"
#include "nodes/beta/fields.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

using namespace test;
using Params = PaintBetaParams;

ScalarGrid paintedFrom(const Params& params, const PaintBetaInputs& inputs) {
  const auto result = paintBeta(inputs, params, {});
  EXPECT_TRUE(result.ok()) << errorOf(result);
  return result.ok() ? *result : ScalarGrid::constant(-999);
}

std::string errorFor(const Params& params, const PaintBetaInputs& inputs) {
  return test::errorOf(paintBeta(inputs, params, {}));
}

/// A box about the origin whose colour in the channels is x, y, z (of its unit cube) and 0.5.
TriMesh coloredBox() {
  TriMesh mesh = families::boxSurface(Vec3::Constant(-0.5), Vec3::Constant(0.5), 3, 3, 3);
  mesh.source = "box.ply";
  mesh.colorSets = {{"flat", std::vector<Vec4>(mesh.cornerCount(), Vec4::Zero())}, {"place", {}}};
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) {
      const Vec3 c = mesh.positions[at(v)] + Vec3::Constant(0.5);
      mesh.colorSets[1].rgba.emplace_back(c.x(), c.y(), c.z(), 0.5);
    }
  return mesh;
}

Params colorParams() {
  Params params;
  params.source = PaintSource::Colors;
  params.blend = Blend::Replace;
  params.colorSet = "place";
  params.background = -1;
  params.low = 1;
  params.high = 3;
  params.band = 0.11;  // ends midway between voxels
  params.voxel = 0.02;
  return params;
}

TEST(PaintColors, SpreadFromTheClosestPointThroughTheBand) {
  const TriMesh mesh = coloredBox();
  Params params = colorParams();
  for (const auto& [channel, axis] :
       {std::pair(ColorChannel::Red, 0), {ColorChannel::Green, 1}, {ColorChannel::Blue, 2}}) {
    params.channel = channel;
    const ScalarGrid grid = paintedFrom(params, {nullptr, nullptr, &mesh});
    std::size_t inBand = 0;
    for (auto v = voxelsOf(grid).cbeginValueOn(); v; ++v) {
      const openvdb::Vec3d w = voxelsOf(grid).indexToWorld(v.getCoord());
      const Vec3 p(w.x(), w.y(), w.z()), q = p.cwiseMax(-0.5).cwiseMin(0.5);
      const double outside = (p - q).norm(), inside = 0.5 - p.cwiseAbs().maxCoeff();
      EXPECT_LE(outside, 0.11 + 1e-9);
      EXPECT_LE(inside, 0.11 + 1e-9);
      // The closest point differs from q only across other axes, unless that is a tie.
      if (std::abs(p[axis]) < 0.35) {
        EXPECT_NEAR(static_cast<double>(*v), 1 + 2 * (q[axis] + 0.5), 1e-5);
      }
      ++inBand;
    }
    const double b = 0.11,
                 outer = 1 + 6 * b + 3 * b * b * std::numbers::pi + 4.0 / 3 * b * b * b * std::numbers::pi;
    const double volume = outer - std::pow(1 - 2 * b, 3);
    EXPECT_NEAR(static_cast<double>(inBand) * 8e-6, volume, 0.02 * volume) << "the band's volume";
    EXPECT_EQ(sampleAt(grid, Vec3::Zero()), -1);
  }
}

TEST(PaintColors, TheFirstSetTheAlphaAndWhatLiesBeyondOne) {
  TriMesh mesh = coloredBox();
  Params params = colorParams();
  params.channel = ColorChannel::Alpha;
  EXPECT_NEAR(sampleAt(paintedFrom(params, {nullptr, nullptr, &mesh}), Vec3(0.5, 0, 0)), 2, 1e-6);
  params.colorSet.clear();
  EXPECT_EQ(sampleAt(paintedFrom(params, {nullptr, nullptr, &mesh}), Vec3(0.5, 0, 0)), 1);
  for (Vec4& c : mesh.colorSets[0].rgba) c.setConstant(7);
  EXPECT_EQ(sampleAt(paintedFrom(params, {nullptr, nullptr, &mesh}), Vec3(0.5, 0, 0)), 3);
}

TEST(PaintColors, FlatTrianglesAreNoTrouble) {
  TriMesh mesh = coloredBox();
  mesh.triangles.push_back({0, 0, 0});
  mesh.triangles.push_back({0, 1, 0});
  for (auto& set : mesh.colorSets) set.rgba.resize(mesh.cornerCount(), Vec4::Constant(0.5));
  paintedFrom(colorParams(), {nullptr, nullptr, &mesh});
}

TEST(PaintColors, WhatIsMissingIsNamed) {
  TriMesh mesh = coloredBox();
  Params params = colorParams();
  EXPECT_TRUE(says(errorFor(params, {}), "mesh: colours come from a mesh, and none is wired"));
  params.colorSet = "Cd";
  EXPECT_TRUE(says(errorFor(params, {nullptr, nullptr, &mesh}),
                   "color_set: the mesh has no colours named 'Cd'; it has 'flat', 'place'"));
  mesh.colorSets.clear();
  EXPECT_TRUE(
      says(errorFor(params, {nullptr, nullptr, &mesh}), "mesh: the mesh 'box.ply' has no vertex colours"));
}

TEST(PaintNoise, LiesBetweenLowAndHighInTheSolidAndIsTheSameOnAnyLattice) {
  const TriMesh mesh = families::sphereSurface(Vec3::Zero(), 0.5, 32, 16);
  Params params;
  params.source = PaintSource::Noise;
  params.blend = Blend::Replace;
  params.low = 2;
  params.high = 4;
  params.noiseSize = 0.2;
  params.voxel = 0.02;
  const ScalarGrid coarse = paintedFrom(params, {nullptr, nullptr, &mesh});
  params.voxel = 0.01;
  const ScalarGrid fine = paintedFrom(params, {nullptr, nullptr, &mesh});
  double low = 9, high = 0;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) {
      const Vec3 p = 0.02 * Vec3(i, j, 3);
      if (p.norm() > 0.48) continue;
      const double value = sampleAt(fine, p);
      EXPECT_NEAR(value, sampleAt(coarse, p), 1e-5) << "at voxels of both";
      low = std::min(low, value), high = std::max(high, value);
    }
  EXPECT_GE(low, 2);
  EXPECT_LE(high, 4);
  EXPECT_GT(high - low, 0.8);
  EXPECT_EQ(sampleAt(fine, Vec3::Constant(0.6)), 1) << "the background outside";
  params.seed = 2;
  EXPECT_NE(digestOf(paintedFrom(params, {nullptr, nullptr, &mesh})), digestOf(fine));
}

TEST(PaintNoise, WithoutAMeshLiesWhereTheGridIsPainted) {
  const auto start = gridOf(1);
  scatter(*start, 12, 1);
  const ScalarGrid grid = scalarGridOf(start, "beta", {});
  Params params;
  params.source = PaintSource::Noise;
  EXPECT_TRUE(voxelsOf(paintedFrom(params, {&grid, nullptr, nullptr})).tree().hasSameTopology(start->tree()));
  EXPECT_TRUE(says(errorFor(params, {}), "mesh: there is nothing that noise could lie in"));
  const TriMesh empty;
  EXPECT_TRUE(says(errorFor(params, {nullptr, nullptr, &empty}), "mesh: there is nothing"));
}

class Combined : public testing::TestWithParam<Blend> {};

TEST_P(Combined, OnOneLatticeVoxelByVoxel) {
  const auto a = gridOf(2), b = gridOf(3);
  scatter(*a, 14, 1);
  scatter(*b, 18, 2);
  a->tree().fill(openvdb::CoordBBox(openvdb::Coord(32), openvdb::Coord(47)), 5.0f);
  a->tree().prune();
  const ScalarGrid grid = scalarGridOf(a->deepCopy(), "a", {}), other = scalarGridOf(b->deepCopy(), "b", {});
  Params params;
  params.blend = GetParam();
  const ScalarGrid result = paintedFrom(params, {&grid, &other, nullptr});
  EXPECT_EQ(result.name(), "a");
  for (int i = -2; i < 50; ++i)
    for (int j = -2; j < 50; ++j)
      for (int k = -2; k < 50; ++k) {
        const openvdb::Coord c(i, j, k);
        const double x = static_cast<double>(a->tree().getValue(c)),
                     y = static_cast<double>(b->tree().getValue(c));
        const bool keeps = GetParam() == Blend::Replace && !b->tree().isValueOn(c);
        EXPECT_EQ(voxelsOf(result).tree().getValue(c),
                  static_cast<float>(keeps ? x : blended(GetParam(), x, y)));
      }
}

INSTANTIATE_TEST_SUITE_P(Blends, Combined,
                         testing::Values(Blend::Replace, Blend::Add, Blend::Multiply, Blend::Max,
                                         Blend::Min));

TEST(Combine, OnAnotherLatticeLinearFieldsAreExact) {
  const auto start = gridOf(0), linear = gridOf(0, 0.05);
  start->tree().fill(openvdb::CoordBBox(openvdb::Coord(3), openvdb::Coord(12)), 1.0f);
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j)
      for (int k = 0; k <= 40; ++k)
        linear->tree().setValue({i, j, k}, static_cast<float>(0.05 * (i + 2 * j + 3 * k)));
  const FileFrame frame{0.5, FileFrame::Up::Z};
  const ScalarGrid grid = scalarGridOf(start, "a", {}), other = scalarGridOf(linear, "b", frame);
  Params params;
  params.blend = Blend::Replace;
  const ScalarGrid result = paintedFrom(params, {&grid, &other, nullptr});
  std::size_t looked = 0;
  for (auto v = voxelsOf(result).cbeginValueOn(); v; ++v) {
    const openvdb::Vec3d w = voxelsOf(result).indexToWorld(v.getCoord());
    const Vec3 p = frame.toFile(Vec3(w.x(), w.y(), w.z()));
    if ((p.array() < 0.05).any() || (p.array() > 1.95).any()) continue;
    EXPECT_NEAR(static_cast<double>(*v), p.x() + 2 * p.y() + 3 * p.z(), 1e-5);
    ++looked;
  }
  EXPECT_GT(looked, 300u);
}

TEST(Combine, WithoutAGridItHasTheLatticeOfTheOther) {
  const auto b = gridOf(3);
  scatter(*b, 10, 2);
  b->setTransform(affineTransform(5));
  const ScalarGrid other = scalarGridOf(b->deepCopy(), "b", {0.01, FileFrame::Up::Z});
  Params params;
  params.background = 2;
  const ScalarGrid result = paintedFrom(params, {nullptr, &other, nullptr});
  EXPECT_EQ(voxelsOf(result).transform(), b->transform());
  EXPECT_EQ(voxelsOf(result).background(), 6);
  EXPECT_TRUE(voxelsOf(result).tree().hasSameTopology(b->tree()));
}

TEST(Smooth, AConstantStaysAndADabSpreadsByItsVariance) {
  Params params;
  params.background = 0;
  params.voxel = 0.02;
  params.strokes = {{{{0, 0, 0}}, 0.021, 0, 1, Blend::Replace}};  // seven voxels
  params.smooth = 0.05;
  const ScalarGrid grid = paintedFrom(params, {});
  double sum = 0, second = 0;
  for (auto v = voxelsOf(grid).cbeginValueOn(); v; ++v) {
    const double x = 0.02 * v.getCoord().x();
    sum += static_cast<double>(*v);
    second += static_cast<double>(*v) * x * x;
  }
  EXPECT_NEAR(sum, 7, 1e-4);
  EXPECT_NEAR(second / sum, 0.05 * 0.05 * 0.97 + 2.0 / 7 * 4e-4, 0.03 * 0.05 * 0.05);

  params.smooth = 0.01;
  params.background = 4;
  params.strokes = {{{{0, 0, 0}}, 0.5, 0, 1, Blend::Replace}};
  const ScalarGrid ball = paintedFrom(params, {});
  EXPECT_EQ(sampleAt(ball, Vec3::Constant(0.01)), 1) << "to the last bit";
  EXPECT_NEAR(sampleAt(ball, Vec3(0.49, 0, 0)), 2.5, 0.2);
  EXPECT_EQ(sampleAt(ball, Vec3::Constant(1)), 4);
  params.smooth = 10;
  EXPECT_TRUE(says(errorFor(params, {}), "smooth: smoothing over 10 m is 500 voxels wide"));
}

TEST(Threshold, SplitsValuesAndTheBackground) {
  Params params;
  params.background = 1;
  params.strokes = {{{{0, 0, 0}}, 0.2, 1, 5, Blend::Replace}};
  params.threshold = 3;
  params.low = 0.25;
  params.high = 8;
  const ScalarGrid grid = paintedFrom(params, {});
  EXPECT_EQ(sampleAt(grid, Vec3::Zero()), 8);
  EXPECT_EQ(sampleAt(grid, Vec3(0.18, 0, 0)), 0.25);
  EXPECT_EQ(sampleAt(grid, Vec3(5, 0, 0)), 0.25);
  for (auto v = voxelsOf(grid).cbeginValueOn(); v; ++v) EXPECT_TRUE(*v == 8 || *v == 0.25f);
}

}  // namespace
}  // namespace sherd
