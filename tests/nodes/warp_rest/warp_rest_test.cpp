#include "warp_rest/warp_rest.h"

#include <gtest/gtest.h>

#include <numbers>

#include "base/parallel.h"
#include "predict_degree/predict_degree.h"
#include "support/broken_box.h"
#include "support/said.h"
#include "support/tet_families.h"

namespace sherd {
namespace {

using P = WarpRestParams;
using Mesh = std::shared_ptr<const TetMesh>;

RestShape warped(const Mesh& tets, const P& params, const RestShape* from = nullptr, const Exec& exec = {}) {
  auto rest = warpRest(tets, from, params, exec);
  EXPECT_TRUE(rest.ok()) << (rest.ok() ? "" : rest.error().text());
  return std::move(rest).value();
}

Mesh smallBox() { return families::shared(families::box(4, 4, 4, Vec3(1, 1, 1))); }

/// A box in a cage of 14³ cubes of six tetrahedra.
Mesh cagedBox() {
  return test::gridCage(std::make_shared<const TriMesh>(test::boxMesh(Vec3::Zero(), Vec3(1, 0.8, 0.6))), 14);
}

TEST(WarpRest, NothingAskedForIsNoChange) {
  const Mesh box = smallBox();
  EXPECT_EQ(warped(box, {}).positions, box->nodes);
  EXPECT_EQ(warped(box, {.axis = Vec3::Zero(), .waveLength = 0.3, .roughnessSize = 0.2}).positions,
            box->nodes);
  EXPECT_EQ(warped(box, {}).tets, box);
}

TEST(WarpRest, ElongationShortensTheAxisAndKeepsVolumes) {
  const Mesh box = smallBox();
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  for (const double e : {0.01, 0.25, 4.0, 100.0}) {
    const RestShape rest = warped(box, {.elongation = e, .axis = 7 * axis});
    for (std::size_t n = 1; n < box->nodes.size(); ++n) {
      const Vec3 before = box->nodes[n] - box->nodes[0], after = rest.positions[n] - rest.positions[0];
      const double along = before.dot(axis);
      EXPECT_NEAR(after.dot(axis), along * std::pow(e, -2.0 / 3), 1e-12 * e);
      EXPECT_LT((after - after.dot(axis) * axis - std::cbrt(e) * (before - along * axis)).norm(), 1e-12 * e);
    }
    TetMesh bent = *box;
    bent.nodes = rest.positions;
    for (std::size_t t = 0; t < bent.tets.size(); ++t)
      EXPECT_NEAR(tetVolume(bent, t), tetVolume(*box, t), 1e-9 * tetVolume(*box, t));
  }
}

TEST(WarpRest, WavesAreSines) {
  const Mesh box = smallBox();
  const RestShape rest = warped(
      box,
      {.waveAmplitude = 0.1, .waveLength = 0.8, .waveTravel = Vec3(0, 0, 5), .waveShift = Vec3(-3, 0, 0)});
  for (std::size_t n = 0; n < box->nodes.size(); ++n) {
    const Vec3& p = box->nodes[n];
    const Vec3 wave(-0.1 * std::sin(2 * std::numbers::pi * p.z() / 0.8), 0, 0);
    EXPECT_LT((rest.positions[n] - p - wave).norm(), 1e-14);
  }
  // 0 stands for a quarter of the diagonal.
  const double quarter = Vec3(1, 1, 1).norm() / 4;
  EXPECT_EQ(warped(box, {.waveAmplitude = 0.1}).positions,
            warped(box, {.waveAmplitude = 0.1, .waveLength = quarter}).positions);
}

TEST(WarpRest, RoughnessIsSmoothBoundedAndFollowsTheSeed) {
  const Mesh box = families::shared(families::box(16, 16, 16, Vec3(1, 1, 1)));
  const P params{.roughness = 0.05, .roughnessSize = 0.5};
  const RestShape rest = warped(box, params);
  Vec3 most = Vec3::Zero();
  double steepest = 0;
  for (std::size_t n = 0; n < box->nodes.size(); ++n) {
    const Vec3 shift = rest.positions[n] - box->nodes[n];
    most = most.cwiseMax(shift.cwiseAbs());
    if (n > 0) {
      const double step = (box->nodes[n] - box->nodes[n - 1]).norm();
      steepest = std::max(steepest, (shift - (rest.positions[n - 1] - box->nodes[n - 1])).norm() / step);
    }
  }
  EXPECT_LE(most.maxCoeff(), 0.05);
  EXPECT_GT(most.minCoeff(), 0.02);
  // The interpolant's slope is at most 15/8 of the difference, 2 · 0.05, per 0.5 m, on each axis.
  EXPECT_LE(steepest, 3 * 1.875 * 0.1 / 0.5);
  EXPECT_NE(warped(box, {.roughness = 0.05, .roughnessSize = 0.5, .seed = 2}).positions, rest.positions);
  setThreadLimit(1);
  EXPECT_EQ(warped(box, params).positions, rest.positions);
  setThreadLimit(0);
}

TEST(WarpRest, Chains) {
  const Mesh box = smallBox();
  const RestShape waves = warped(box, {.waveAmplitude = 0.1, .waveLength = 0.7});
  const RestShape both = warped(box, {.elongation = 3, .waveAmplitude = 0.1, .waveLength = 0.7});
  EXPECT_EQ(warped(box, {.elongation = 3}, &waves).positions, both.positions);
  EXPECT_EQ(warped(box, {}, &waves).positions, waves.positions);
}

TEST(WarpRest, WarnsOfWhatTheTetrahedraCanNotFollow) {
  const Mesh box = smallBox();  // edges of 0.25 m, and diagonals
  Said fine, coarse, none;
  warped(box, {.waveAmplitude = 0.1, .waveLength = 0.5, .roughness = 0.1, .roughnessSize = 0.2}, nullptr,
         fine.exec);
  EXPECT_TRUE(fine.warning("waves of 0.5 m are finer"));
  EXPECT_TRUE(fine.warning("roughness of 0.2 m is finer"));
  warped(box, {.waveAmplitude = 0.1, .waveLength = 2, .roughness = 0.1, .roughnessSize = 2}, nullptr,
         coarse.exec);
  warped(box, {.elongation = 9, .waveLength = 0.01}, nullptr, none.exec);
  EXPECT_TRUE(coarse.lines.empty() && none.lines.empty());
}

TEST(WarpRest, Refuses) {
  const Mesh box = smallBox();
  const auto portOf = [&](const P& params, const RestShape* from = nullptr) {
    const auto rest = warpRest(box, from, params, Exec{});
    return rest.ok() ? std::string("ok") : rest.error().port;
  };
  EXPECT_EQ(portOf({.elongation = 0}), "elongation");
  EXPECT_EQ(portOf({.elongation = NAN}), "elongation");
  EXPECT_EQ(portOf({.elongation = 2, .axis = Vec3::Zero()}), "axis");
  EXPECT_EQ(portOf({.waveAmplitude = -1}), "wave_amplitude");
  EXPECT_EQ(portOf({.waveLength = INFINITY}), "wave_length");
  EXPECT_EQ(portOf({.waveAmplitude = 1, .waveTravel = Vec3::Zero()}), "wave_travel");
  EXPECT_EQ(portOf({.waveAmplitude = 1, .waveShift = Vec3::Zero()}), "wave_shift");
  EXPECT_EQ(portOf({.roughness = NAN}), "roughness");
  EXPECT_EQ(portOf({.roughnessSize = -1}), "roughness_size");
  const Mesh other = families::shared(families::box(4, 4, 4, Vec3(1, 1, 2)));
  const RestShape ofOther{other, other->nodes}, ofACopy{std::make_shared<const TetMesh>(*box), box->nodes};
  EXPECT_EQ(portOf({}, &ofOther), "rest");
  EXPECT_EQ(portOf({}, &ofACopy), "ok");
  EXPECT_FALSE(warpRest(nullptr, nullptr, {}, Exec{}).ok());
}

TEST(WarpRest, PiecesAreLongAlongTheAxis) {
  const Mesh box = cagedBox();
  const Vec3 axis = Vec3(1, 1, 0);
  const double plain = test::meanElongation(test::broken(box, 60, {}), axis);
  EXPECT_NEAR(plain, 1, 0.2);
  const RestShape long4 = warped(box, {.elongation = 4, .axis = axis});
  const Fragments splinters = test::broken(box, 60, {.rest = &long4});
  RecordProperty("elongation_4", std::to_string(test::meanElongation(splinters, axis)));
  // Pieces at the border end there: they fall short of the four.
  EXPECT_GT(test::meanElongation(splinters, axis), 2.2 * plain);
  EXPECT_LT(test::meanElongation(splinters, axis), 4.5 * plain);
  const RestShape flat4 = warped(box, {.elongation = 0.25, .axis = axis});
  const Fragments plates = test::broken(box, 60, {.rest = &flat4});
  RecordProperty("elongation_1/4", std::to_string(test::meanElongation(plates, axis)));
  EXPECT_LT(test::meanElongation(plates, axis), plain / 2.2);
}

TEST(WarpRest, GammaKeepsItsMeaning) {
  const Mesh box = cagedBox();
  const WeightField weights = test::evenWeights(box);
  const auto degree = [&](double elongation, double gamma) {
    const RestShape rest = warped(box, {.elongation = elongation, .axis = Vec3(1, 1, 0)});
    const auto e = embed(box, {}, Exec{}, {.rest = &rest});
    EXPECT_TRUE(e.ok());
    const auto sites = predictDegree(weights, *e, {.gamma = gamma}, Exec{});
    EXPECT_TRUE(sites.ok());
    return static_cast<double>(sites->positions.cols());
  };
  const auto whole = predictDegree(weights, *embed(box, {}, Exec{}), {.degree = 1}, Exec{});
  ASSERT_TRUE(whole.ok());
  for (const double share : {5.0, 12.0}) {
    const double gamma = whole->energy / share, plain = degree(1, gamma);
    EXPECT_GT(plain, 8);
    for (const double elongation : {0.25, 4.0}) EXPECT_NEAR(degree(elongation, gamma), plain, 0.25 * plain);
  }
}

TEST(WarpRest, WavesMakeConcavePieces) {
  const Mesh box = cagedBox();
  const RestShape waves = warped(
      box,
      {.waveAmplitude = 0.1, .waveLength = 0.4, .waveTravel = Vec3(1, 0, 0), .waveShift = Vec3(0, 0, 1)});
  const double plain = test::meanConvexity(test::broken(box, 12, {}));
  const double wavy = test::meanConvexity(test::broken(box, 12, {.rest = &waves}));
  RecordProperty("plain", std::to_string(plain));
  RecordProperty("wavy", std::to_string(wavy));
  EXPECT_GT(plain, 0.9999) << "straight distances in a box: cells are convex";
  EXPECT_LT(wavy, 0.93);
}

TEST(WarpRest, RoughnessMakesSheetsUneven) {
  const Mesh box = cagedBox();
  double last = test::meanRoughness(test::broken(box, 12, {}));
  EXPECT_LT(last, 1e-6) << "sheets are flat";
  for (const double amplitude : {0.02, 0.04, 0.08}) {
    const RestShape rest = warped(box, {.roughness = amplitude, .roughnessSize = 0.3});
    const double rough = test::meanRoughness(test::broken(box, 12, {.rest = &rest}));
    RecordProperty("roughness_" + std::to_string(amplitude), std::to_string(rough));
    EXPECT_GT(rough, 1.5 * last + 0.001);
    last = rough;
  }
}

}  // namespace
}  // namespace sherd
