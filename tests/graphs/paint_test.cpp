// A painted body, run as a user runs it and measured on the files alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/exported_pieces.h"
#include "support/program.h"

namespace sherd {
namespace {

const std::string kGraph = SHERD_SOURCE_DIR "/graphs/paint.json";
const std::string kQuick = " --set picture.width=120 --set picture.height=64 --set picture.samples=1";

/// Pieces whose centre of mass lies in the stem.
std::size_t piecesOfTheStem(const std::string& directory) {
  const auto json = nlohmann::json::parse(contentOf(directory + "/pieces.json"));
  std::size_t count = 0;
  for (const auto& piece : json["pieces"]) count += piece["centre_of_mass"][1].get<double>() < 0.06;
  return count;
}

TEST(Paint, TheStemBreaksWhereItIsPainted) {
  const ScratchDirectory scratch;
  const std::string run = "run '" + kGraph + "'" + kQuick + " --var out='";
  const ProgramRun painted = runProgram(run + scratch.file("painted") + "'");
  ASSERT_EQ(painted.exitCode, 0) << painted.output;
  const ExportedReport report =
      measureExported(scratch.file("painted"), SHERD_SOURCE_DIR "/assets/mushroom.obj");
  EXPECT_GE(report.pieces, 8u);
  EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u);
  EXPECT_LT(report.volumeError, 1e-9);
  EXPECT_TRUE(contentOf(scratch.file("painted/beta.vdb")).starts_with(" BDV"));

  const ProgramRun plain = runProgram(run + scratch.file("plain") + "' --var fragile=1");
  ASSERT_EQ(plain.exitCode, 0) << plain.output;
  EXPECT_GT(piecesOfTheStem(scratch.file("painted")), piecesOfTheStem(scratch.file("plain")));
}

TEST(Paint, TheFileTakesThePlaceOfThePaint) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun first = runProgram("run '" + kGraph + "'" + kQuick + " --var out='" + out + "'");
  ASSERT_EQ(first.exitCode, 0) << first.output;
  std::string graph = contentOf(kGraph);
  const auto begin = graph.find("\"paint\":"), end = graph.find("\"field\":");
  graph.replace(begin, graph.find("\"weights\":") - begin,
                "\"paint\": { \"type\": \"ReadVDB@1\", \"params\": { \"file\": \"out/beta.vdb\" } },\n");
  ASSERT_NE(end, std::string::npos);
  graph.replace(graph.find("[\"field\", "), 10, "[");
  std::ofstream(scratch.file("read.json")) << graph;
  const ProgramRun second = runProgram("run '" + scratch.file("read.json") + "'" + kQuick + " --var out='" +
                                       scratch.file("again") + "'");
  ASSERT_EQ(second.exitCode, 0) << second.output;
  for (const char* file : {"/pieces.json", "/piece_0001_crack.obj"})
    EXPECT_TRUE(contentOf(out + file) == contentOf(scratch.file("again") + file)) << file;
}

struct BadStrokes {
  const char* strokes;
  const char* says;
};

TEST(Paint, WrongStrokesAreFoundByCheckWithTheirPlace) {
  const ScratchDirectory scratch;
  const BadStrokes cases[] = {
      {R"([{ "points": [0, 0, 0], "radus": 1, "value": 2 }])",
       "paint.strokes: stroke 1 has no field \"radus\"; did you"},
      {R"([{ "points": [0, 0, 0], "radius": "${fragile}", "value": "${fragle}" }])",
       "there is no variable \"fragle\""},
      {R"({})", "it would have to be a list"},
      {R"("none")", "it would have to be a list"},
  };
  for (const auto& [strokes, says] : cases) {
    std::string graph = contentOf(kGraph);
    const auto begin = graph.find("\"strokes\": [") + 11, end = graph.find("}]", begin) + 2;
    std::ofstream(scratch.file("bad.json")) << graph.replace(begin, end - begin, strokes);
    const ProgramRun run = runProgram("check '" + scratch.file("bad.json") + "'");
    EXPECT_EQ(run.exitCode, 2) << run.output;
    EXPECT_NE(run.output.find(says), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("bad.json:2"), std::string::npos) << run.output;
  }
}

TEST(Paint, StrokesCanBeTyped) {
  const ScratchDirectory scratch;
  const ProgramRun run =
      runProgram("run '" + kGraph + "' --to field --var out='" + scratch.file("out") +
                 "' --set 'paint.strokes=[{\"points\": [0, 0.1, 0], \"radius\": 0.02, \"value\": 4}]'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/beta.vdb")));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("out/pieces.json")));
}

TEST(Paint, NothingIsWrittenElsewhereWithoutPermission) {
  const ScratchDirectory scratch;
  const ProgramRun run = runProgram("check '" + kGraph + "' --set field.file=/elsewhere/beta.vdb");
  const ProgramRun inFile = [&] {
    std::string graph = contentOf(kGraph);
    const std::string name = "${out}/beta.vdb";
    graph.replace(graph.find(name), name.size(), "/elsewhere/beta.vdb");
    std::ofstream(scratch.file("elsewhere.json")) << graph;
    return runProgram("check '" + scratch.file("elsewhere.json") + "'");
  }();
  EXPECT_EQ(run.exitCode, 0) << "the command line names it: " << run.output;
  EXPECT_EQ(inFile.exitCode, 2);
  EXPECT_NE(inFile.output.find("--allow-write"), std::string::npos) << inFile.output;
}

}  // namespace
}  // namespace sherd
