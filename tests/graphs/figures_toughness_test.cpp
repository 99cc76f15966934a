// The figures of toughness and granularity, run as a user runs them and measured on the files alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/exported_pieces.h"
#include "support/program.h"

namespace sherd {
namespace {

const std::string kFigures = SHERD_SOURCE_DIR "/graphs/figures/";
const std::string kAssets = SHERD_SOURCE_DIR "/assets/";
const std::string kQuickPicture = " --set picture.width=120 --set picture.height=64 --set picture.samples=1";

ProgramRun runFigure(const std::string& name, const std::string& out, const std::string& more) {
  return runProgram("run '" + kFigures + name + "' --var out='" + out + "'" + kQuickPicture + more);
}

nlohmann::json piecesOf(const std::string& directory) {
  return nlohmann::json::parse(contentOf(directory + "/pieces.json"));
}

/// Broken soundly, into so many cells.
std::size_t soundCells(const std::string& directory, const std::string& model) {
  const ExportedReport report = measureExported(directory, kAssets + model);
  EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u) << directory;
  EXPECT_LT(report.volumeError, 1e-9) << directory;
  const auto sites = piecesOf(directory)["N"].get<std::size_t>();
  EXPECT_GE(report.pieces + report.pieces / 5, sites) << directory;
  return sites;
}

TEST(FiguresOfToughness, AnExampleOfAMetreBreaksIntoAsManyAsAsked) {
  const ScratchDirectory scratch;
  // A coarse mushroom in place of the vase, for speed.
  const ProgramRun run =
      runFigure("toughness_by_example.json", scratch.file("out"),
                " --var mesh='" + kAssets + "mushroom.obj' --set tets.tets=1300 --var pieces=12");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_NE(run.output.find("a hit like this one breaks it into 12 pieces with γ = "), std::string::npos)
      << run.output;
  const auto cellsAt = [&](const std::string& height) {
    return soundCells(scratch.file("out/height_") + height, "mushroom.obj");
  };
  EXPECT_EQ(cellsAt("1"), 12u);
  EXPECT_LT(cellsAt("0.5"), 12u);
  EXPECT_GT(cellsAt("2"), 12u);
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/sheet.png")));
}

TEST(SlowFiguresOfToughness, TheVaseBreaksLikeItsExample) {
  const ScratchDirectory scratch;
  const ProgramRun run = runFigure("toughness_by_example.json", scratch.file("out"), "");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_EQ(soundCells(scratch.file("out/height_1"), "vase.obj"), 20u);
  EXPECT_LT(soundCells(scratch.file("out/height_0.5"), "vase.obj"), 20u);
  EXPECT_GT(soundCells(scratch.file("out/height_2"), "vase.obj"), 20u);
}

TEST(FiguresOfToughness, APieceCountThatCannotBeHadIsRefusedByName) {
  const ScratchDirectory scratch;
  const std::string common = " --var mesh='" + kAssets + "mushroom.obj' --set tets.tets=600 --to degree";
  const ProgramRun many =
      runFigure("toughness_by_example.json", scratch.file("out"), common + " --var pieces=100000");
  EXPECT_EQ(many.exitCode, 1) << many.output;
  EXPECT_NE(many.output.find("toughness.pieces: it can't break into 100000 pieces"), std::string::npos)
      << many.output;
  const ProgramRun none =
      runFigure("toughness_by_example.json", scratch.file("out"), common + " --set example.threshold=1e9");
  EXPECT_EQ(none.exitCode, 1) << none.output;
  EXPECT_NE(none.output.find("the example has no energy"), std::string::npos) << none.output;
}

TEST(FiguresOfToughness, TheFirstOfManyIsTheTough) {
  const ScratchDirectory scratch;
  const ProgramRun run =
      runFigure("figure2_toughness.json", scratch.file("out"),
                " --var mesh='" + kAssets + "mushroom.obj' --set tets.tets=1300 --var height=3");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  std::size_t last = 0;
  for (const char* gamma : {"gamma_0.02", "gamma_0.005", "gamma_0.0015"}) {
    const std::size_t cells = soundCells(scratch.file("out/") + gamma, "mushroom.obj");
    EXPECT_GE(cells, last) << gamma;
    last = cells;
  }
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/sheet.png")));
}

TEST(SlowFiguresOfToughness, AToughVaseBreaksIntoFewAndAFragileOneIntoMany) {
  const ScratchDirectory scratch;
  const ProgramRun run = runFigure("figure2_toughness.json", scratch.file("out"), "");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  std::size_t last = 1;
  for (const char* gamma : {"gamma_0.02", "gamma_0.005", "gamma_0.0015"}) {
    const std::size_t cells = soundCells(scratch.file("out/") + gamma, "vase.obj");
    EXPECT_GT(cells, last) << gamma;
    last = cells;
  }
  EXPECT_GT(last, 40u);
}

/// The mean volume of the pieces nearer than `reach` (m) to where the ball hits, over that of all pieces.
double sizeAtTheHit(const std::string& directory, double reach) {
  double near = 0, all = 0;
  int nearCount = 0, count = 0;
  const nlohmann::json json = piecesOf(directory);
  for (const auto& piece : json["pieces"]) {
    const auto centre = piece["centre_of_mass"].get<std::array<double, 3>>();
    const double volume = piece["volume"].get<double>();
    all += volume, ++count;
    if (std::hypot(centre[0] - (0.35 * 1.02 - 0.51), centre[1] - 0.6 * 0.84) > reach) continue;
    near += volume, ++nearCount;
  }
  EXPECT_GT(nearCount, 2) << directory;
  return near / nearCount / (all / count);
}

TEST(FiguresOfToughness, AlphaDecidesWhetherPiecesAreSmallAtTheHit) {
  const ScratchDirectory scratch;
  const ProgramRun run = runFigure("figure4_granularity.json", scratch.file("out"), "");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  for (const char* alpha : {"alpha_0", "alpha_0.5", "alpha_1"})
    EXPECT_EQ(soundCells(scratch.file("out/") + alpha, "wall.obj"), 40u);
  const double even = sizeAtTheHit(scratch.file("out/alpha_0"), 0.25),
               half = sizeAtTheHit(scratch.file("out/alpha_0.5"), 0.25),
               small = sizeAtTheHit(scratch.file("out/alpha_1"), 0.25);
  EXPECT_NEAR(even, 1, 0.25);
  EXPECT_LT(half, even);
  EXPECT_LT(small, half);
  EXPECT_LT(small, 0.6);
}

}  // namespace
}  // namespace sherd
