// The graphs that ship with sherd, run as a user runs them.
#include <gtest/gtest.h>

#include "support/exported_pieces.h"
#include "support/glb_file.h"
#include "support/program.h"

namespace sherd {
namespace {

const std::string kGraphs = SHERD_SOURCE_DIR "/graphs/";
const std::string kAssets = SHERD_SOURCE_DIR "/assets/";
const std::string kMeshes = SHERD_SOURCE_DIR "/../shared/meshes/";
const std::string kQuickPicture = " --set picture.width=120 --set picture.height=64 --set picture.samples=1";

void expectBroken(const std::string& directory, const std::string& source, std::size_t least,
                  std::size_t most) {
  const ExportedReport report = measureExported(directory, source);
  EXPECT_GE(report.pieces, least);
  EXPECT_LE(report.pieces, most);
  EXPECT_EQ(report.openEdges, 0u);
  EXPECT_EQ(report.lonelyCracks, 0u);
  EXPECT_LT(report.volumeError, 1e-9);
}

TEST(Graphs, AllPassCheck) {
  int graphs = 0;
  for (const std::string& folder : {kGraphs, kGraphs + "figures"})
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".json") continue;
      const ProgramRun run = runProgram("check '" + entry.path().string() + "'");
      EXPECT_EQ(run.exitCode, 0) << run.output;
      ++graphs;
    }
  EXPECT_GE(graphs, 4);
}

TEST(Graphs, RecipesAreSoundSubgraphs) {
  const ProgramRun run = runProgram("check '" + kGraphs + "recipes/impact_to_pieces.json'");
  EXPECT_EQ(run.exitCode, 0) << run.output;
  EXPECT_NE(run.output.find("a subgraph of 6 nodes, no errors"), std::string::npos) << run.output;
}

TEST(Graphs, MushroomDropBreaks) {
  const ScratchDirectory scratch;
  const ProgramRun run = runProgram("run '" + kGraphs + "mushroom_drop.json' --var out='" +
                                    scratch.file("a") + "'" + kQuickPicture);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  expectBroken(scratch.file("a"), kAssets + "mushroom.obj", 10, 60);
  EXPECT_GT(std::filesystem::file_size(scratch.file("a/preview.png")), 500u);
}

TEST(Graphs, SameBytesWithOneAndTwoThreadsAndInTwoRuns) {
  const ScratchDirectory scratch;
  std::map<std::string, std::string> first;
  for (const char* options : {" --threads 1", " --threads 2", " --threads 2"}) {
    const std::string out = scratch.file("same");
    std::filesystem::remove_all(out);
    const ProgramRun run = runProgram("run '" + kGraphs + "mushroom_drop.json' --var out='" + out + "'" +
                                      kQuickPicture + options);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const auto files = filesBelow(out);
    EXPECT_GT(files.size(), 20u);
    if (first.empty()) first = files;
    for (const auto& [name, content] : files) EXPECT_TRUE(content == first[name]) << name << options;
    EXPECT_EQ(files.size(), first.size());
  }
}

struct GlbSums {
  double volume = 0, told = 0;       ///< m³, of the triangles and as the pieces' properties say
  double area = 0, textureArea = 0;  ///< of the crack faces, m² and UV units²

  void add(const test::GlbFile& file, const nlohmann::json& primitive) {
    const bool isInside =
        file.json["materials"][primitive["material"].get<std::size_t>()]["name"] == "inside";
    const auto positions = file.attribute(primitive, "POSITION"),
               uvs = file.attribute(primitive, "TEXCOORD_0");
    const auto corners = file.indices(primitive);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      Eigen::Matrix3d x, uv = Eigen::Matrix3d::Ones();
      for (Eigen::Index c = 0; c < 3; ++c) {
        const std::size_t v = corners[i + static_cast<std::size_t>(c)];
        x.col(c) = Eigen::Vector3d::Map(positions[v].data());
        uv.col(c).head<2>() = Eigen::Vector2d::Map(uvs[v].data());
      }
      volume += x.determinant() / 6;
      if (!isInside) continue;
      area += (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).norm() / 2;
      textureArea += std::abs(uv.determinant()) / 2;
    }
  }
};

TEST(Graphs, PiecesGlbIsSoundAndHasOneTexelDensity) {
  const ScratchDirectory scratch;
  const ProgramRun run =
      runProgram("run '" + kGraphs + "pieces_glb.json' --var out='" + scratch.file("out") + "'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  const test::GlbFile file(scratch.file("out/pieces.glb"));
  for (const std::string& fault : file.faults) ADD_FAILURE() << fault;
  ASSERT_GE(file.json["nodes"].size(), 10u);
  GlbSums sums;
  for (const auto& node : file.json["nodes"]) {
    sums.told += node["extras"]["volume"].get<double>();
    for (const auto& primitive : file.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
      sums.add(file, primitive);
  }
  EXPECT_NEAR(sums.volume, sums.told, 1e-6 * sums.told);
  // Four units a metre, as the graph says.
  EXPECT_LE(sums.textureArea, 16 * sums.area * (1 + 1e-5));
  EXPECT_GE(sums.textureArea, 16 * sums.area * 0.95);
}

testing::AssertionResult succeeds(const std::string& arguments) {
  const ProgramRun run = runProgram(arguments);
  if (run.exitCode == 0) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "exit code " << run.exitCode << ": " << run.output;
}

TEST(Graphs, FewerPiecesAfterMoreLeaveNoStaleFilesAndTouchNothingElse) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("pieces"), run = "run '" + kGraphs +
                                                        "mushroom_drop.json' --target all" + kQuickPicture +
                                                        " --var out='" + out + "' --var degree=";
  ASSERT_TRUE(succeeds(run + "30"));
  EXPECT_GE(measureExported(out, kAssets + "mushroom.obj").pieces, 30u);
  std::ofstream(out + "/notes.txt") << "mine";
  std::ofstream(out + "/piece_9999_surface.obj") << "mine too";
  ASSERT_TRUE(succeeds(run + "5"));
  std::filesystem::remove(out + "/piece_9999_surface.obj");
  expectBroken(out, kAssets + "mushroom.obj", 5, 7);
  EXPECT_EQ(contentOf(out + "/notes.txt"), "mine");
}

TEST(Graphs, AWeakHitBreaksNothingAndSaysSo) {
  const ScratchDirectory scratch;
  const ProgramRun run = runProgram("run '" + kGraphs + "mushroom_drop.json' --var gamma=1e9 --var out='" +
                                    scratch.file("whole") + "'" + kQuickPicture);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_NE(run.output.find("not break"), std::string::npos) << run.output;
  EXPECT_TRUE(std::filesystem::exists(scratch.file("whole/piece_0001_surface.obj")));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("whole/piece_0001_crack.obj")));
}

struct BadCase {
  const char* name;
  const char* arguments;  ///< behind `run mushroom_drop.json`
  int exitCode;
  const char* says;
};

std::ostream& operator<<(std::ostream& out, const BadCase& c) { return out << c.arguments; }

class BadInput : public testing::TestWithParam<BadCase> {};

TEST_P(BadInput, IsRefusedByName) {
  const ScratchDirectory scratch;
  std::ofstream(scratch.file("empty.obj"));
  std::ofstream(scratch.file("words.obj")) << "this is no mesh\n";
  std::ofstream(scratch.file("open.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::ofstream(scratch.file("nan.obj"))
      << "v 0 0 nan\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const std::string tetra = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  std::ofstream(scratch.file("crossing.obj"))
      << tetra << "v .1 .1 .1\nv 1.1 .1 .1\nv .1 1.1 .1\nv .1 .1 1.1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
  std::ofstream(scratch.file("nonmanifold.obj"))
      << tetra << "v 0 -1 0\nv 1 0 -1\nf 1 2 5\nf 1 6 2\nf 1 5 6\nf 2 6 5\n";
  std::ofstream(scratch.file("file")) << "not a directory\n";
  const ProgramRun run = runProgram("run '" + kGraphs + "mushroom_drop.json' --var out='" +
                                        scratch.file("out") + "' " + GetParam().arguments,
                                    "cd '" + scratch.file("") + "' &&");
  EXPECT_EQ(run.exitCode, GetParam().exitCode) << run.output;
  EXPECT_NE(run.output.find(GetParam().says), std::string::npos) << run.output;
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadInput,
    testing::Values(BadCase{"MissingFile", "--var mesh=nowhere.obj", 2, "nowhere.obj"},
                    BadCase{"EmptyFile", "--var mesh=empty.obj", 1, "empty.obj"},
                    BadCase{"NoMesh", "--var mesh=words.obj", 1, "words.obj"},
                    BadCase{"OpenMesh", "--var mesh=open.obj --set mesh.repair=strict", 1, "open"},
                    BadCase{"NotANumber", "--var mesh=nan.obj", 1, "NaN"},
                    BadCase{"SelfIntersecting", "--var mesh=crossing.obj --set mesh.repair=strict", 1,
                            "intersect"},
                    BadCase{"NonManifold", "--var mesh=nonmanifold.obj", 1, "manifold"},
                    BadCase{"OutCannotBeWritten", "--var out=/proc/none", 1, "/proc/none"},
                    BadCase{"UnknownVariable", "--var mehs=a.obj", 2, "mesh"},
                    BadCase{"UnknownNode", "--set hti.density=1", 2, "hit"},
                    BadCase{"UnknownParameter", "--set hit.densty=1", 2, "density"},
                    BadCase{"OutOfRange", "--set hit.poisson=0.7", 2, "poisson"},
                    BadCase{"WrongType", "--set hit.density=heavy", 2, "density"},
                    BadCase{"UnknownTarget", "--target al", 2, "all"},
                    BadCase{"OutIsAFile", "--var out=file", 2, "file"}),
    [](const auto& info) { return std::string(info.param.name); });

class SlowGraphs : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(SlowGraphs, BreakTheirModels) {
  const auto [graph, model] = GetParam();
  const ScratchDirectory scratch;
  const ProgramRun run =
      runProgram("run '" + kGraphs + graph + "' --var out='" + scratch.file("out") + "'" + kQuickPicture);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  expectBroken(scratch.file("out"), kAssets + model, 10, 80);
}

INSTANTIATE_TEST_SUITE_P(Cases, SlowGraphs,
                         testing::Values(std::pair("first_fracture.json", "vase.obj"),
                                         std::pair("wall_ball.json", "wall.obj")),
                         [](const auto& info) { return std::string(info.param.second).substr(0, 4); });

TEST(SlowGraphs, TheRecipeGivesWhatItsNodesWouldGive) {
  const ScratchDirectory scratch;
  for (const char* graph : {"recipe", "first_fracture"}) {
    const ProgramRun run = runProgram("run '" + kGraphs + graph + ".json' --var out='" + scratch.file(graph) +
                                      "'" + kQuickPicture);
    ASSERT_EQ(run.exitCode, 0) << run.output;
  }
  const auto recipe = filesBelow(scratch.file("recipe")), flat = filesBelow(scratch.file("first_fracture"));
  EXPECT_GT(flat.size(), 20u);
  EXPECT_TRUE(recipe == flat);
}

TEST(SlowGraphs, ThreeToughnessesGiveFallingCounts) {
  const ScratchDirectory scratch;
  const ProgramRun run = runProgram("run '" + kGraphs + "toughness.json' --var out='" + scratch.file("out") +
                                    "'" + kQuickPicture);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/sheet.png")));
  std::size_t last = 1000;
  for (const char* name : {"gamma_2", "gamma_20", "gamma_200"}) {
    const ExportedReport report = measureExported(scratch.file("out/") + name, kAssets + "table.obj");
    EXPECT_LT(report.pieces, last) << name;
    EXPECT_EQ(report.openEdges + report.lonelyCracks, 0u) << name;
    last = report.pieces;
  }
}

TEST(SlowGraphs, HigherDropsBreakIntoMorePieces) {
  const ScratchDirectory scratch;
  const ProgramRun run = runProgram("run '" + kGraphs + "higher_drops.json' --frames 1,4 --var out='" +
                                    scratch.file("out") + "'" + kQuickPicture);
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/drop.0004.png")));
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/sheet.png")));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("out/0002")));
  const ExportedReport low = measureExported(scratch.file("out/0001"), kAssets + "mushroom.obj");
  const ExportedReport high = measureExported(scratch.file("out/0004"), kAssets + "mushroom.obj");
  EXPECT_LT(low.pieces, high.pieces);
}

TEST(Graphs, LearnedDegreesStandInForSearches) {
  const ScratchDirectory scratch;
  const ProgramRun run =
      runProgram("run '" + kGraphs + "learn.json' --to crack --frames 1,4 --var orientations=8 " +
                 "--var out='" + scratch.file("out") + "'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_NE(run.output.find("learned from 32 drops"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("the model foretells"), std::string::npos) << run.output;
  expectBroken(scratch.file("out/0001"), kAssets + "mushroom.obj", 2, 80);
  const ProgramRun other =
      runProgram("run '" + kGraphs + "learn.json' --to degree --frames 1 --var orientations=8 " +
                 "--set weights.alpha=0.5 --var out='" + scratch.file("out") + "'");
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_NE(other.output.find("α (1 there, 0.5 here)"), std::string::npos) << other.output;
}

TEST(Graphs, LearnedFromBallsBreaksAWallByWhatWasLearned) {
  const ScratchDirectory scratch;
  const ProgramRun run =
      runProgram("run '" + kGraphs + "learn_wall.json' --to crack --frames 15 --var balls=12 " +
                 "--set degree.outside=predict --var out='" + scratch.file("out") + "'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  EXPECT_NE(run.output.find("learned from 48 balls"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("the model foretells"), std::string::npos) << run.output;
  expectBroken(scratch.file("out/0015"), kAssets + "wall.obj", 5, 60);
}

class SlowModels : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(SlowModels, KeepEveryPromise) {
  const auto [model, degree] = GetParam();
  const std::string mesh = kMeshes + model + ".obj";
  if (!std::filesystem::exists(mesh)) GTEST_SKIP() << mesh << " is not there";
  const ScratchDirectory scratch;
  const ProgramRun run =
      runProgram("run '" + kGraphs + "first_fracture.json' --to crack --var mesh='" + mesh +
                 "' --var degree=" + std::to_string(degree) + " --var out='" + scratch.file("out") + "'");
  ASSERT_EQ(run.exitCode, 0) << run.output;
  const auto wanted = static_cast<std::size_t>(degree);
  // Parts below min_volume join a neighbour, and parts that the cut detaches are pieces of their own.
  expectBroken(scratch.file("out"), mesh, wanted - wanted / 10, 2 * wanted);
}

INSTANTIATE_TEST_SUITE_P(Cases, SlowModels,
                         testing::Combine(testing::Values("horse", "bunny", "bunny_7k", "spot", "fertility",
                                                          "knight", "three_holes", "screwdriver",
                                                          "armadillo"),
                                          testing::Values(48)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param)) + "_" +
                                  std::to_string(std::get<1>(info.param));
                         });

}  // namespace
}  // namespace sherd
