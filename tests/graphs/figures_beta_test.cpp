// Fragility from a VDB file, run as a user runs it and measured on the files alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/exported_pieces.h"
#include "support/program.h"

namespace sherd {
namespace {

const std::string kAssets = SHERD_SOURCE_DIR "/assets/";

ProgramRun runFigure(const std::string& out, const std::string& more) {
  return runProgram("run '" SHERD_SOURCE_DIR "/graphs/figures/beta_vdb.json' --var out='" + out +
                    "' --set picture.width=120 --set picture.height=64 --set picture.samples=1" + more);
}

/// Share of the pieces whose centre lies in the half that is painted, by how much of each lies there for
/// those about the border.
double shareInTheHalf(const std::string& directory) {
  const auto json = nlohmann::json::parse(contentOf(directory + "/pieces.json"));
  double share = 0;
  for (const auto& piece : json["pieces"]) {
    const double radius = std::cbrt(piece["volume"].get<double>());
    share += std::clamp(0.5 + piece["centre_of_mass"][0].get<double>() / radius, 0.0, 1.0);
  }
  return share / static_cast<double>(json["pieces"].size());
}

TEST(FiguresBeta, AHalfThatIsFourTimesAsFragileHasTwiceAsManyPieces) {
  const ScratchDirectory scratch;
  const ProgramRun run = runFigure(scratch.file("out"), "");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  for (const char* grid : {"even", "beta"}) {
    const ExportedReport report = measureExported(scratch.file("out/") + grid, kAssets + "wall.obj");
    EXPECT_EQ(report.pieces, 40u) << grid;
    EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u) << grid;
    EXPECT_LT(report.volumeError, 1e-9) << grid;
  }
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/sheet.png")));
  // In the best arrangement of many sites in d dimensions their number by volume goes with w^(d / (d + 2)):
  // twice as many in a thin wall (d = 2), 2.3 times as many in a thick one.
  const double even = shareInTheHalf(scratch.file("out/even")),
               painted = shareInTheHalf(scratch.file("out/beta"));
  RecordProperty("even", std::to_string(even));
  RecordProperty("painted", std::to_string(painted));
  EXPECT_NEAR(even, 0.5, 0.03);
  EXPECT_NEAR(painted, 0.68, 0.04);
}

TEST(FiguresBeta, TheFileIsWhatTheGraphMakesOfIt) {
  const ScratchDirectory scratch;
  const ProgramRun run = runFigure(scratch.file("out"), " --target asset");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_TRUE(contentOf(scratch.file("out/wall_beta.vdb")) == contentOf(kAssets + "wall_beta.vdb"));
}

TEST(FiguresBeta, TheWrongUnitAndAFileThatIsMissingAreSaid) {
  const ScratchDirectory scratch;
  const ProgramRun small = runFigure(
      scratch.file("out"), " --to weights --set tets.tets=600 --var grid=beta --set field.unit=0.001");
  EXPECT_EQ(small.exitCode, 0) << small.output;
  EXPECT_NE(small.output.find("the painted β misses the body, which has 1 everywhere: the paint lies from ("),
            std::string::npos)
      << small.output;
  EXPECT_NE(small.output.find("or in another unit: it is 0.00"), std::string::npos) << small.output;
  const ProgramRun right =
      runFigure(scratch.file("out"), " --to weights --set tets.tets=600 --var grid=beta");
  EXPECT_EQ(right.output.find("misses"), std::string::npos) << right.output;
  const ProgramRun none =
      runFigure(scratch.file("out"), " --to weights --set tets.tets=600 --var beta=gone.vdb");
  EXPECT_EQ(none.exitCode, 2) << none.output;
  EXPECT_NE(none.output.find("gone.vdb"), std::string::npos) << none.output;
  const ProgramRun grid =
      runFigure(scratch.file("out"), " --to weights --set tets.tets=600 --var grid=alpha");
  EXPECT_EQ(grid.exitCode, 1) << grid.output;
  EXPECT_NE(grid.output.find("it holds 'beta' (float), 'even' (float)"), std::string::npos) << grid.output;
}

}  // namespace
}  // namespace sherd
