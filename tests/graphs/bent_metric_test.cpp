// The figures in which an artist bends the metric, run as a user runs them and measured on the files alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "geometry/convex_hull.h"
#include "support/exported_pieces.h"
#include "support/program.h"

namespace sherd {
namespace {

const std::string kFigures = SHERD_SOURCE_DIR "/graphs/figures/";
const std::string kAssets = SHERD_SOURCE_DIR "/assets/";
const std::string kQuick = " --set picture.width=120 --set picture.height=64 --set picture.samples=1";

void expectSound(const std::string& directory, const std::string& source) {
  const ExportedReport report = measureExported(directory, source);
  EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u) << directory;
  EXPECT_LT(report.volumeError, 1e-9) << directory;
}

/// Mean over pieces of their extent along an axis over that across.
double meanElongation(const std::string& directory, const Vec3& axis) {
  const auto json = nlohmann::json::parse(contentOf(directory + "/pieces.json"));
  double sum = 0;
  for (const auto& piece : json["pieces"]) {
    Mat3 inertia;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        inertia(r, c) = piece["inertia"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    const Mat3 second = 0.5 * inertia.trace() * Mat3::Identity() - inertia;
    const double along = axis.normalized().dot(second * axis.normalized());
    sum += std::sqrt(along / (0.5 * (second.trace() - along)));
  }
  return sum / static_cast<double>(json["pieces"].size());
}

/// Volume over that of the convex hulls, all pieces together.
double convexity(const std::string& directory) {
  const auto json = nlohmann::json::parse(contentOf(directory + "/pieces.json"));
  double volumes = 0, hulls = 0;
  for (const auto& piece : json["pieces"]) {
    std::vector<Vec3> points;
    for (const char* part : {"surface", "crack"})
      for (const auto& triangle :
           readObjTriangles(directory + "/" + piece[part].get<std::string>()).triangles)
        for (const auto& p : triangle) points.emplace_back(p[0], p[1], p[2]);
    const auto hull = convexHull(points);
    EXPECT_TRUE(hull.ok());
    hulls += hull->volume;
    volumes += piece["volume"].get<double>();
  }
  return volumes / hulls;
}

TEST(BentMetric, Figure5HasAPreferredDirection) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun run = runProgram("run '" + kFigures + "figure5_anisotropy.json' --target all --var out='" +
                                    out + "' --set tets.tets=1500" + kQuick);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  for (const char* name : {"/elongation_1", "/elongation_5"}) expectSound(out + name, kAssets + "sphere.obj");
  EXPECT_TRUE(std::filesystem::exists(out + "/sheet.png"));
  const Vec3 axis(0.5, 1, 0);
  const double plain = meanElongation(out + "/elongation_1", axis);
  const double elongated = meanElongation(out + "/elongation_5", axis);
  RecordProperty("plain", std::to_string(plain));
  RecordProperty("elongated", std::to_string(elongated));
  EXPECT_NEAR(plain, 1, 0.25);
  EXPECT_GT(elongated, 2.5 * plain);
}

/// Area of the cracks that come within a distance of a point, each counted by its two pieces.
double crackNear(const std::string& directory, const Vec3& place, double distance) {
  double area = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (!entry.path().string().ends_with("_crack.obj")) continue;
    for (const auto& t : readObjTriangles(entry.path()).triangles) {
      const Vec3 a = Vec3::Map(t[0].data()), b = Vec3::Map(t[1].data()), c = Vec3::Map(t[2].data());
      const double nearest = std::min(
          {(a - place).norm(), (b - place).norm(), (c - place).norm(), ((a + b + c) / 3 - place).norm()});
      if (nearest < distance) area += 0.5 * (b - a).cross(c - a).norm();
    }
  }
  return area;
}

TEST(BentMetric, AProtectedRegionStaysWhole) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun run =
      runProgram("run '" + kFigures + "protect.json' --target all --var out='" + out + "'" + kQuick);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  for (const char* name : {"/protect_0", "/protect_1"}) expectSound(out + name, kAssets + "mushroom.obj");
  const Vec3 dab(0.02, 0.1, 0.03);
  EXPECT_GT(crackNear(out + "/protect_0", dab, 0.02), 1e-4);
  EXPECT_EQ(crackNear(out + "/protect_1", dab, 0.02), 0);
}

/// Share of the cracks' area that lies in the ring that attract.json paints, by centroids.
double shareInTheRing(const std::string& directory) {
  double inside = 0, all = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (!entry.path().string().ends_with("_crack.obj")) continue;
    for (const auto& t : readObjTriangles(entry.path()).triangles) {
      const Vec3 a = Vec3::Map(t[0].data()), b = Vec3::Map(t[1].data()), c = Vec3::Map(t[2].data());
      const Vec3 centre = (a + b + c) / 3;
      const double area = 0.5 * (b - a).cross(c - a).norm();
      const double off = std::hypot(centre.x(), centre.y() - 0.42) - 0.28;
      all += area;
      if (std::abs(off) < 0.07) inside += area;
    }
  }
  return inside / all;
}

/// How flat the sheets are: over pairs of pieces, the length of the vector sum of the areas between them over
/// the sum of areas. 1 where all sheets are flat.
double flatness(const std::string& directory) {
  using Corners = std::array<ObjTriangles::Point, 3>;
  std::map<Corners, std::pair<int, Vec3>> first;  // by sorted corners: its piece and its area
  std::map<std::pair<int, int>, std::pair<Vec3, double>> between;
  const auto json = nlohmann::json::parse(contentOf(directory + "/pieces.json"));
  int number = 0;
  for (const auto& piece : json["pieces"]) {
    ++number;
    for (const auto& t : readObjTriangles(directory + "/" + piece["crack"].get<std::string>()).triangles) {
      const Vec3 a = Vec3::Map(t[0].data()), b = Vec3::Map(t[1].data()), c = Vec3::Map(t[2].data());
      const Vec3 area = 0.5 * (b - a).cross(c - a);
      Corners key = t;
      std::sort(key.begin(), key.end());
      const auto [twin, isFirst] = first.emplace(key, std::pair(number, area));
      if (isFirst) continue;
      auto& [sum, total] = between.try_emplace({twin->second.first, number}, Vec3::Zero(), 0.0).first->second;
      sum += area, total += area.norm();
    }
  }
  double vectors = 0, areas = 0;
  for (const auto& [pair, sheet] : between) vectors += sheet.first.norm(), areas += sheet.second;
  return vectors / areas;
}

TEST(SlowBentMetric, RoughnessMakesFlatSheetsUneven) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun run =
      runProgram("run '" + kFigures + "roughness.json' --target all --var out='" + out + "'" + kQuick);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  for (const char* name : {"/roughness_0", "/roughness_0.05"}) expectSound(out + name, kAssets + "wall.obj");
  EXPECT_TRUE(std::filesystem::exists(out + "/sheet.png"));
  const double smooth = flatness(out + "/roughness_0"), rough = flatness(out + "/roughness_0.05");
  RecordProperty("smooth", std::to_string(smooth));
  RecordProperty("rough", std::to_string(rough));
  EXPECT_GT(smooth, 1 - 1e-9) << "a convex body's cells have flat faces";
  EXPECT_LT(rough, 0.992);  // its parts are 9° out of its plane, root mean square
}

TEST(SlowBentMetric, CracksAreDrawnToAPaintedRing) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun run =
      runProgram("run '" + kFigures + "attract.json' --target all --var out='" + out + "'" + kQuick);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  for (const char* name : {"/stretch_1", "/stretch_5"}) expectSound(out + name, kAssets + "wall.obj");
  const double plain = shareInTheRing(out + "/stretch_1"), drawn = shareInTheRing(out + "/stretch_5");
  RecordProperty("plain", std::to_string(plain));
  RecordProperty("drawn", std::to_string(drawn));
  EXPECT_GT(drawn, 1.4 * plain);
}

TEST(SlowBentMetric, Figure6HasConcavePieces) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun run =
      runProgram("run '" + kFigures + "figure6_waves.json' --target all --var out='" + out + "'" + kQuick);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  for (const char* name : {"/waves_0", "/waves_0.04"}) expectSound(out + name, kAssets + "table.obj");
  const double plain = convexity(out + "/waves_0"), wavy = convexity(out + "/waves_0.04");
  RecordProperty("plain", std::to_string(plain));
  RecordProperty("wavy", std::to_string(wavy));
  EXPECT_LT(wavy, plain - 0.05);
}

}  // namespace
}  // namespace sherd
