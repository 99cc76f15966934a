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

/// A figure's graph, run small; what it exports is sound.
class BentMetric : public testing::Test {
 protected:
  /// `exports`: its directories, which hold pieces of one model.
  void run(const std::string& figure, const std::string& model, const std::vector<std::string>& exports,
           const std::string& options = "") {
    const ProgramRun run = runProgram("run '" + kFigures + figure + "' --target all --var out='" +
                                      directory("") + "'" + kQuick + options);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    for (const std::string& name : exports) {
      const ExportedReport report = measureExported(directory(name), kAssets + model);
      EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u) << name;
      EXPECT_LT(report.volumeError, 1e-9) << name;
    }
  }
  std::string directory(const std::string& name) const { return scratch_.file("out/" + name); }
  static void record(const char* what, double value) { RecordProperty(what, std::to_string(value)); }

 private:
  ScratchDirectory scratch_;
};
class SlowBentMetric : public BentMetric {};

nlohmann::json piecesIn(const std::string& directory) {
  return nlohmann::json::parse(contentOf(directory + "/pieces.json"))["pieces"];
}

struct Corners {
  explicit Corners(const std::array<ObjTriangles::Point, 3>& t)
      : a(Vec3::Map(t[0].data())), b(Vec3::Map(t[1].data())), c(Vec3::Map(t[2].data())) {}
  Vec3 area() const { return 0.5 * (b - a).cross(c - a); }
  Vec3 centroid() const { return (a + b + c) / 3; }
  Vec3 a, b, c;
};

/// All crack faces of the pieces in a directory: each sheet twice, once for each of its pieces.
std::vector<Corners> cracksIn(const std::string& directory) {
  std::vector<Corners> all;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (!entry.path().string().ends_with("_crack.obj")) continue;
    for (const auto& t : readObjTriangles(entry.path()).triangles) all.emplace_back(t);
  }
  return all;
}

/// Mean over pieces of their extent along an axis over that across.
double meanElongation(const std::string& directory, const Vec3& axis) {
  const nlohmann::json pieces = piecesIn(directory);
  double sum = 0;
  for (const auto& piece : pieces) {
    Mat3 inertia;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        inertia(r, c) = piece["inertia"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    const Mat3 second = 0.5 * inertia.trace() * Mat3::Identity() - inertia;
    const double along = axis.normalized().dot(second * axis.normalized());
    sum += std::sqrt(along / (0.5 * (second.trace() - along)));
  }
  return sum / static_cast<double>(pieces.size());
}

/// Volume over that of the convex hulls, all pieces together.
double convexity(const std::string& directory) {
  double volumes = 0, hulls = 0;
  for (const auto& piece : piecesIn(directory)) {
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

TEST_F(BentMetric, Figure5HasAPreferredDirection) {
  ASSERT_NO_FATAL_FAILURE(run("figure5_anisotropy.json", "sphere.obj", {"elongation_1", "elongation_5"},
                              " --set tets.tets=1500"));
  EXPECT_TRUE(std::filesystem::exists(directory("sheet.png")));
  const Vec3 axis(0.5, 1, 0);
  const double plain = meanElongation(directory("elongation_1"), axis),
               elongated = meanElongation(directory("elongation_5"), axis);
  record("plain", plain), record("elongated", elongated);
  EXPECT_NEAR(plain, 1, 0.25);
  EXPECT_GT(elongated, 2.5 * plain);
}

/// Area of the cracks that come within a distance of a point, each counted by its two pieces.
double crackNear(const std::string& directory, const Vec3& place, double distance) {
  double area = 0;
  for (const Corners& t : cracksIn(directory)) {
    const double nearest = std::min(
        {(t.a - place).norm(), (t.b - place).norm(), (t.c - place).norm(), (t.centroid() - place).norm()});
    if (nearest < distance) area += t.area().norm();
  }
  return area;
}

TEST_F(BentMetric, AProtectedRegionStaysWhole) {
  ASSERT_NO_FATAL_FAILURE(run("protect.json", "mushroom.obj", {"protect_0", "protect_1"}));
  const Vec3 dab(0.02, 0.1, 0.03);
  EXPECT_GT(crackNear(directory("protect_0"), dab, 0.02), 1e-4);
  EXPECT_EQ(crackNear(directory("protect_1"), dab, 0.02), 0);
}

/// Share of the cracks' area that lies in the ring that attract.json paints, by centroids.
double shareInTheRing(const std::string& directory) {
  double inside = 0, all = 0;
  for (const Corners& t : cracksIn(directory)) {
    const Vec3 centre = t.centroid();
    const double area = t.area().norm(), off = std::hypot(centre.x(), centre.y() - 0.42) - 0.28;
    all += area;
    if (std::abs(off) < 0.07) inside += area;
  }
  return inside / all;
}

/// How flat the sheets are: over pairs of pieces, the length of the vector sum of the areas between them over
/// the sum of areas. 1 where all sheets are flat.
double flatness(const std::string& directory) {
  std::map<std::array<ObjTriangles::Point, 3>, std::pair<int, Vec3>> first;  // by corners: its piece and area
  std::map<std::pair<int, int>, std::pair<Vec3, double>> between;
  int number = 0;
  for (const auto& piece : piecesIn(directory)) {
    ++number;
    for (auto t : readObjTriangles(directory + "/" + piece["crack"].get<std::string>()).triangles) {
      const Vec3 area = Corners(t).area();
      std::sort(t.begin(), t.end());
      const auto [twin, isFirst] = first.emplace(t, std::pair(number, area));
      if (isFirst) continue;
      auto& [sum, total] = between.try_emplace({twin->second.first, number}, Vec3::Zero(), 0.0).first->second;
      sum += area, total += area.norm();
    }
  }
  double vectors = 0, areas = 0;
  for (const auto& [pair, sheet] : between) vectors += sheet.first.norm(), areas += sheet.second;
  return vectors / areas;
}

TEST_F(SlowBentMetric, RoughnessMakesFlatSheetsUneven) {
  ASSERT_NO_FATAL_FAILURE(run("roughness.json", "wall.obj", {"roughness_0", "roughness_0.05"}));
  EXPECT_TRUE(std::filesystem::exists(directory("sheet.png")));
  const double smooth = flatness(directory("roughness_0")), rough = flatness(directory("roughness_0.05"));
  record("smooth", smooth), record("rough", rough);
  EXPECT_GT(smooth, 1 - 1e-9) << "a convex body's cells have flat faces";
  EXPECT_LT(rough, 0.992);  // its parts are 9° out of its plane, root mean square
}

TEST_F(SlowBentMetric, CracksAreDrawnToAPaintedRing) {
  ASSERT_NO_FATAL_FAILURE(run("attract.json", "wall.obj", {"stretch_1", "stretch_5"}));
  const double plain = shareInTheRing(directory("stretch_1")), drawn = shareInTheRing(directory("stretch_5"));
  record("plain", plain), record("drawn", drawn);
  EXPECT_GT(drawn, 1.4 * plain);
}

TEST_F(SlowBentMetric, Figure6HasConcavePieces) {
  ASSERT_NO_FATAL_FAILURE(run("figure6_waves.json", "table.obj", {"waves_0", "waves_0.04"}));
  const double plain = convexity(directory("waves_0")), wavy = convexity(directory("waves_0.04"));
  record("plain", plain), record("wavy", wavy);
  EXPECT_LT(wavy, plain - 0.05);
}

}  // namespace
}  // namespace sherd
