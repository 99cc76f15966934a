// Textures, by the texture coordinates of a mesh.
#include "beta/paint_beta.h"
#include "nodes/beta/fields.h"
#include "support/fragment_families.h"

namespace sherd {
namespace {

using namespace test;
using Params = PaintBetaParams;

/// Two pixels by two: red is 0 and 1 above, 0.2 and 0.4 below; green is 1, blue 0.
Picture fourPixels() { return {2, 2, {0, 255, 0, 255, 255, 0, 51, 255, 0, 102, 255, 0}}; }

/// A box of 1 m about the origin; each side shows the whole picture. Below, it is another material.
TriMesh texturedBox() {
  TriMesh mesh = boxMesh(Vec3::Constant(-0.5), Vec3::Constant(0.5));
  mesh.source = "box.obj";
  return mesh;
}

Params textureParams() {
  Params params;
  params.source = PaintSource::Texture;
  params.blend = Blend::Replace;
  params.background = -1;
  params.low = 1;
  params.high = 3;
  params.band = 0.06;
  params.voxel = 0.02;
  return params;
}

ScalarGrid painted(const Params& params, const TriMesh& mesh, const Picture& picture) {
  const auto result = paintBeta({nullptr, nullptr, &mesh, &picture}, params, {});
  EXPECT_TRUE(result.ok()) << errorOf(result);
  return result.ok() ? *result : ScalarGrid::constant(-999);
}

std::string errorFor(const Params& params, const TriMesh* mesh, const Picture* picture) {
  return errorOf(paintBeta({nullptr, nullptr, mesh, picture}, params, {}));
}

/// The place on the box where the first side's triangles have these texture coordinates.
Vec3 placeOf(const TriMesh& mesh, const Vec2& uv) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Mat3 corners;
    for (std::size_t c = 0; c < 3; ++c)
      corners.col(static_cast<Eigen::Index>(c)) << mesh.uvSets[0].uv[3 * t + c], 1;
    const Vec3 weights = corners.inverse() * Vec3(uv.x(), uv.y(), 1);
    if (weights.minCoeff() < 0) continue;
    Vec3 place = Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c)
      place += weights[static_cast<Eigen::Index>(c)] * mesh.positions[at(mesh.triangles[t][c])];
    return place;
  }
  ADD_FAILURE() << "no triangle is there";
  return Vec3::Zero();
}

TEST(PaintTexture, StandsUprightAndIsLinearBetweenPixels) {
  const TriMesh mesh = texturedBox();
  const ScalarGrid grid = painted(textureParams(), mesh, fourPixels());
  const auto valueAt = [&](double u, double v) { return sampleAt(grid, placeOf(mesh, {u, v})); };
  // At the middles of pixels; v = 0.75 is the upper row. Voxels blur a little.
  EXPECT_NEAR(valueAt(0.25, 0.75), 1 + 2 * 0.0, 0.09);
  EXPECT_NEAR(valueAt(0.75, 0.75), 1 + 2 * 1.0, 0.09);
  EXPECT_NEAR(valueAt(0.25, 0.25), 1 + 2 * 0.2, 0.09);
  EXPECT_NEAR(valueAt(0.75, 0.25), 1 + 2 * 0.4, 0.09);
  EXPECT_NEAR(valueAt(0.5, 0.75), 2, 0.02);
  EXPECT_NEAR(valueAt(0.375, 0.75), 1.5, 0.02);
  EXPECT_NEAR(valueAt(0.5, 0.5), 1 + 2 * 0.4, 0.02);
  EXPECT_EQ(sampleAt(grid, Vec3::Zero()), -1) << "beyond the band";
}

TEST(PaintTexture, RepeatsBeyondItsSides) {
  TriMesh mesh = texturedBox();
  const ScalarGrid once = painted(textureParams(), mesh, fourPixels());
  for (Vec2& uv : mesh.uvSets[0].uv) uv += Vec2(3, -2);
  const ScalarGrid shifted = painted(textureParams(), mesh, fourPixels());
  for (const double u : {0.1, 0.4, 0.7})
    EXPECT_NEAR(sampleAt(once, placeOf(texturedBox(), {u, 0.3})),
                sampleAt(shifted, placeOf(mesh, {u + 3, -1.7})), 1e-6);
}

TEST(PaintTexture, TakesTheChannelTheSetAndTheMaterialAskedFor) {
  TriMesh mesh = texturedBox();
  mesh.uvSets.push_back({"flat", std::vector<Vec2>(mesh.cornerCount(), Vec2(0.25, 0.25))});
  Params params = textureParams();
  params.channel = ColorChannel::Green;
  EXPECT_NEAR(sampleAt(painted(params, mesh, fourPixels()), Vec3(0.5, 0.1, 0.2)), 3, 1e-6);
  params.channel = ColorChannel::Red;
  params.uvSet = "flat";
  EXPECT_NEAR(sampleAt(painted(params, mesh, fourPixels()), Vec3(0.5, 0.1, 0.2)), 1.4, 1e-6);
  params.material = "base";
  const ScalarGrid below = painted(params, mesh, fourPixels());
  EXPECT_NEAR(sampleAt(below, Vec3(0, -0.5, 0)), 1.4, 1e-6);
  EXPECT_EQ(sampleAt(below, Vec3(0.5, 0.1, 0.2)), -1) << "another material";
}

TEST(PaintTexture, WhatIsMissingIsNamed) {
  TriMesh mesh = texturedBox();
  const Picture picture = fourPixels(), nothing;
  Params params = textureParams();
  EXPECT_TRUE(says(errorFor(params, nullptr, &picture), "mesh: a texture lies on a mesh, and none is wired"));
  EXPECT_TRUE(says(errorFor(params, &mesh, nullptr), "texture: there is no texture; wire LoadPicture"));
  EXPECT_TRUE(says(errorFor(params, &mesh, &nothing), "texture: the texture has no pixels"));
  params.uvSet = "UVMap";
  EXPECT_TRUE(says(errorFor(params, &mesh, &picture),
                   "uv_set: the mesh has no texture coordinates named 'UVMap'; it has 'map1'"));
  params.uvSet.clear();
  params.material = "stone";
  EXPECT_TRUE(says(errorFor(params, &mesh, &picture),
                   "material: the mesh has no material named 'stone'; it has 'paint', 'base'"));
  params.material.clear();
  params.channel = ColorChannel::Alpha;
  EXPECT_TRUE(says(errorFor(params, &mesh, &picture), "channel: a texture's transparency is not kept"));
  params.channel = ColorChannel::Red;
  mesh.uvSets.clear();
  EXPECT_TRUE(says(errorFor(params, &mesh, &picture), "mesh: the mesh 'box.obj' has no texture coordinates"));
}

}  // namespace
}  // namespace sherd
