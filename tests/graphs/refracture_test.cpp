// Three levels of breaking, run as a user runs them and measured on the files alone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/exported_pieces.h"
#include "support/program.h"

namespace sherd {
namespace {

using Json = nlohmann::json;

Json jsonOf(const std::string& path) { return Json::parse(contentOf(path)); }

/// The two files of a piece as one surface, for the pieces that it broke into to be compared with.
std::string wholePiece(const std::string& directory, const std::string& piece) {
  const std::string path = directory + "/whole_" + piece + ".obj";
  std::ofstream out(path);
  out.precision(17);
  long corners = 0;
  for (const char* part : {"_surface.obj", "_crack.obj"})
    for (const auto& t : readObjTriangles(directory + "/" + piece + part).triangles) {
      for (const auto& p : t) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      out << "f " << corners + 1 << ' ' << corners + 2 << ' ' << corners + 3 << '\n';
      corners += 3;
    }
  return path;
}

void expectWhole(const std::string& directory, const std::string& source) {
  const ExportedReport report = measureExported(directory, source);
  EXPECT_GE(report.pieces, 5u);
  EXPECT_EQ(report.openEdges, 0u);
  EXPECT_EQ(report.lonelyCracks, 0u);
  EXPECT_EQ(report.misnamed, 0u);
  EXPECT_LT(report.volumeError, 1e-9);
}

TEST(Refracture, ThreeLevelsKeepEveryPromiseInTheirFiles) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun run =
      runProgram("run '" SHERD_SOURCE_DIR "/graphs/refracture.json' --var out='" + out +
                 "' --set picture.width=120 --set picture.height=64 --set picture.samples=1");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  const std::string one = out + "/1", two = out + "/2", three = out + "/3";
  const Json first = jsonOf(one + "/pieces.json"), second = jsonOf(two + "/pieces.json"),
             third = jsonOf(three + "/pieces.json");
  EXPECT_TRUE(first["pieces"][0]["parent"].is_null());
  EXPECT_EQ(second["pieces"][0]["parent"], "piece_0001");
  EXPECT_EQ(third["pieces"][0]["parent"], "piece_0001_0002");
  EXPECT_EQ(third["pieces"][2]["name"], "piece_0001_0002_0003");

  EXPECT_EQ(run.output.find("of its own"), std::string::npos) << run.output;
  EXPECT_NE(contentOf(two + "/piece_0001_0002_surface.obj").find("usemtl inside\ng piece_0001_0002\n"),
            std::string::npos);
  expectWhole(one, SHERD_SOURCE_DIR "/assets/mushroom.obj");
  expectWhole(two, wholePiece(one, "piece_0001"));
  expectWhole(three, wholePiece(two, "piece_0001_0002"));
}

TEST(Refracture, HullsOfTheLastLevelAreDescribed) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  const ProgramRun run =
      runProgram("run '" SHERD_SOURCE_DIR "/graphs/refracture.json' --to hulls --var out='" + out + "'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_NE(run.output.find("more volume than the pieces"), std::string::npos) << run.output;
  const Json proxies = jsonOf(out + "/3/proxies.json");
  ASSERT_GE(proxies["pieces"].size(), 5u);
  for (const Json& piece : proxies["pieces"]) {
    const std::string obj = contentOf(out + "/3/" + piece["file"].get<std::string>());
    EXPECT_EQ(piece["file"], piece["name"].get<std::string>() + "_hulls.obj");
    for (const Json& hull : piece["hulls"])
      EXPECT_NE(obj.find("o " + hull["name"].get<std::string>() + "\n"), std::string::npos);
    EXPECT_LT(piece["volume_error"], 1);
  }
}

}  // namespace
}  // namespace sherd
