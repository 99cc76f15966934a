// The figure of a searched and a foretold fracture, run as a user runs it and measured on the files alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/exported_pieces.h"
#include "support/program.h"

namespace sherd {
namespace {

const std::string kGraph = "'" SHERD_SOURCE_DIR "/graphs/figures/figure7_learned.json'";
const std::string kMushroom = SHERD_SOURCE_DIR "/assets/mushroom.obj";

ProgramRun runFigure(const std::string& out, const std::string& more) {
  return runProgram("run " + kGraph + " --var out='" + out +
                    "' --set picture.width=120 --set picture.height=64 --set picture.samples=1" + more);
}

nlohmann::json soundPieces(const std::string& directory) {
  const ExportedReport report = measureExported(directory, kMushroom);
  EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u) << directory;
  EXPECT_LT(report.volumeError, 1e-9) << directory;
  return nlohmann::json::parse(contentOf(directory + "/pieces.json"));
}

TEST(FigureLearned, TheForetoldBreaksLikeTheSearched) {
  const ScratchDirectory scratch;
  const ProgramRun run = runFigure(scratch.file("out"), " --var orientations=16");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_NE(run.output.find("the model foretells "), std::string::npos) << run.output;
  const auto searched = soundPieces(scratch.file("out/search")),
             foretold = soundPieces(scratch.file("out/model"));
  const double sites = searched["N"].get<double>(), gamma = searched["gamma"].get<double>();
  EXPECT_GT(sites, 8);
  EXPECT_NEAR(foretold["N"].get<double>(), sites, 1 + 0.25 * sites);
  EXPECT_EQ(gamma, 1e-4);
  EXPECT_LT(searched["E_D"].get<double>(), gamma);
  // Of the foretold: what γ it was foretold for, and how near its energy comes to that.
  EXPECT_EQ(foretold["gamma"].get<double>(), gamma);
  EXPECT_FALSE(foretold["degree_given"].get<bool>());
  EXPECT_EQ(foretold["below_threshold"].get<bool>(), foretold["E_D"].get<double>() < gamma);
  EXPECT_NEAR(foretold["E_D"].get<double>() / gamma, 1, 0.35);
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/sheet.png")));
}

TEST(FigureLearned, AModelForAnotherGammaIsRefused) {
  const ScratchDirectory scratch;
  const ProgramRun run = runFigure(
      scratch.file("out"), " --to degree --var orientations=2 --set model.repeats=1 --set model.gamma=2e-4");
  EXPECT_EQ(run.exitCode, 1) << run.output;
  EXPECT_NE(run.output.find("γ (0.0002 J·m² there, 0.0001 J·m² here)"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace sherd
