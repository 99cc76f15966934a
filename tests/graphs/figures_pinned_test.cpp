// Sites pinned by hand, run as a user runs them and measured on the files alone.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/exported_pieces.h"
#include "support/program.h"

namespace sherd {
namespace {

ProgramRun runPinned(const std::string& out, const std::string& more) {
  return runProgram("run '" SHERD_SOURCE_DIR "/graphs/figures/pinned.json' --var out='" + out +
                    "' --set picture.width=120 --set picture.height=64 --set picture.samples=1" + more);
}

std::vector<std::array<ObjTriangles::Point, 3>> cracksOf(const std::string& directory) {
  std::vector<std::array<ObjTriangles::Point, 3>> cracks;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    if (entry.path().string().ends_with("_crack.obj"))
      for (const auto& triangle : readObjTriangles(entry.path()).triangles) cracks.push_back(triangle);
  return cracks;
}

/// m², of crack faces in the plane y = `at`, both sides.
double crackIn(const std::string& directory, double at) {
  double area = 0;
  for (const auto& [a, b, c] : cracksOf(directory)) {
    if (std::max({std::abs(a[1] - at), std::abs(b[1] - at), std::abs(c[1] - at)}) > 1e-9) continue;
    area += std::abs((b[0] - a[0]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[0] - a[0])) / 2;
  }
  return area;
}

/// All cracks are where both pins of the tests are equally far.
void expectBisector(const std::string& directory) {
  const auto cracks = cracksOf(directory);
  EXPECT_GT(cracks.size(), 20u);
  for (const auto& triangle : cracks)
    for (const auto& p : triangle) {
      const double first = std::hypot(p[0] + 0.2, p[1] - 0.3, p[2] - 0.01),
                   second = std::hypot(p[0] - 0.31, p[1] - 0.5, p[2] + 0.02);
      ASSERT_NEAR(first, second, 1e-12);
    }
}

TEST(FiguresPinned, TwoPinsAreCutApartByTheirBisector) {
  const ScratchDirectory scratch;
  const ProgramRun run = runPinned(
      scratch.file("out"), " --var degree=2 --set 'pins.points=[[-0.2, 0.3, 0.01], [0.31, 0.5, -0.02]]'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  expectBisector(scratch.file("out"));
}

TEST(FiguresPinned, TheRecipeTakesPins) {
  const ScratchDirectory scratch;
  std::ofstream(scratch.file("pins.json")) << R"({ "format": 1,
    "subgraphs": { "Shatter": ")" SHERD_SOURCE_DIR R"(/graphs/recipes/impact_to_pieces.json" },
    "nodes": {
      "mesh":  { "type": "LoadMesh@1", "params": { "file": "${ASSETS}/wall.obj" } },
      "tets":  { "type": "Tetrahedralize@1", "in": { "mesh": "mesh" }, "params": { "tets": 1400 } },
      "pins":  { "type": "PinSites@1", "in": { "embedding": "break.embedding" },
                 "params": { "points": [[-0.2, 0.3, 0.01], [0.31, 0.5, -0.02]] } },
      "break": { "type": "Shatter", "in": { "body": "tets", "pinned": "pins" },
                 "params": { "degree": 2, "orientation": [25, 0, 15] } },
      "crack": { "type": "ExportCrackSurface@1", "in": { "pieces": "break.pieces" }, "params": { "directory": "out" } }
    } })";
  const ProgramRun run = runProgram("run '" + scratch.file("pins.json") + "'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  expectBisector(scratch.file("out"));
}

TEST(FiguresPinned, TheBlocksStayWhereTheyArePinned) {
  const ScratchDirectory scratch;
  const ProgramRun run = runPinned(scratch.file("out"), "");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  const ExportedReport report = measureExported(scratch.file("out"), SHERD_SOURCE_DIR "/assets/wall.obj");
  EXPECT_GE(report.pieces, 24u);
  EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u);
  EXPECT_LT(report.volumeError, 1e-9);
  const ProgramRun other = runPinned(scratch.file("other"), " --var seed=9");
  ASSERT_EQ(other.exitCode, 0) << other.output;
  // The faces between the blocks, both sides: at least 0.1 m wide and 0.12 m deep each.
  for (const char* directory : {"out", "other"})
    for (const double at : {0.21, 0.42, 0.63}) EXPECT_GT(crackIn(scratch.file(directory), at), 0.024) << at;
  EXPECT_EQ(crackIn(scratch.file("out"), 0.1), 0);
}

TEST(FiguresPinned, APinOutsideWarnsAndTooManyAreRefused) {
  const ScratchDirectory scratch;
  const ProgramRun outside = runPinned(scratch.file("out"), " --to cells --set 'pins.points=[[0, 0.4, 3]]'");
  EXPECT_EQ(outside.exitCode, 0) << outside.output;
  EXPECT_NE(outside.output.find("pin 1 at (0, 0.4, 3) m lies outside the body"), std::string::npos)
      << outside.output;
  const ProgramRun many = runPinned(scratch.file("out"), " --to cells --var degree=3");
  EXPECT_EQ(many.exitCode, 1) << many.output;
  EXPECT_NE(many.output.find("degree.degree: 4 sites are pinned, but only 3 are wanted"), std::string::npos)
      << many.output;
  const ProgramRun wrong = runPinned(scratch.file("out"), " --set 'pins.points=[[0, 0.4]]'");
  EXPECT_EQ(wrong.exitCode, 2) << wrong.output;
  EXPECT_NE(wrong.output.find("point 1 isn't three numbers"), std::string::npos) << wrong.output;
}

}  // namespace
}  // namespace sherd
