// Materials through the whole program, from the artist's file to the pieces' and the pieces of pieces'.
#include <gtest/gtest.h>

#include "support/glb_file.h"
#include "support/program.h"
#include "support/textured_crate.h"

namespace sherd {
namespace {

constexpr const char* kGraph = R"({
  "format": 1,
  "vars": { "mesh": "crate.glb" },
  "subgraphs": { "Shatter": ")" SHERD_SOURCE_DIR R"(/graphs/recipes/impact_to_pieces.json" },
  "nodes": {
    "mesh":   { "type": "LoadMesh@1", "params": { "file": "${mesh}" } },
    "tets":   { "type": "Tetrahedralize@1", "in": { "mesh": "mesh" }, "params": { "tets": 600 } },
    "break":  { "type": "Shatter", "in": { "body": "tets" }, "params": { "degree": 4 } },
    "piece":  { "type": "SelectPiece@1", "in": { "pieces": "break" } },
    "tets2":  { "type": "Tetrahedralize@1", "in": { "mesh": "piece" }, "params": { "tets": 600 } },
    "again":  { "type": "Shatter", "in": { "body": "tets2" }, "params": { "degree": 3 } },
    "glb":    { "type": "ExportPieces@1", "in": { "pieces": "break" }, "params": { "directory": "out/1" } },
    "obj":    { "type": "ExportCrackSurface@1", "in": { "pieces": "break" }, "params": { "directory": "out/1" } },
    "glb2":   { "type": "ExportPieces@1", "in": { "pieces": "again" }, "params": { "directory": "out/2" } },
    "obj2":   { "type": "ExportCrackSurface@1", "in": { "pieces": "again" }, "params": { "directory": "out/2" } },
  }
})";

class MaterialsRun : public testing::Test {
 protected:
  MaterialsRun() { std::ofstream(scratch.file("g.json")) << kGraph; }
  std::string run(const std::string& more = "") {
    const ProgramRun run = runProgram("run '" + scratch.file("g.json") + "'" + more);
    EXPECT_EQ(run.exitCode, 0) << run.output;
    return run.output;
  }
  ScratchDirectory scratch;
};

TEST_F(MaterialsRun, OfAGlbFileReachPiecesOfPieces) {
  test::writeCrateGlb(scratch.file("crate.glb"));
  const std::string said = run();
  for (const char* complaint : {"leave [0, 1]", "of its own", "GLB"})
    EXPECT_EQ(said.find(complaint), std::string::npos) << said;
  EXPECT_NE(said.find("OBJ holds the first UV set only, and its texture 'dents.png' is laid by another"),
            std::string::npos)
      << said;
  for (const char* level : {"1", "2"}) {
    const test::GlbFile file(scratch.file("out/" + std::string(level) + "/pieces.glb"));
    for (const std::string& fault : file.faults) ADD_FAILURE() << fault;
    ASSERT_EQ(file.json["images"].size(), 2u);
    EXPECT_EQ(file.image(0), test::planksPng());
    EXPECT_EQ(file.image(1), test::dentsPng());
    std::map<std::string, nlohmann::json> materials;
    for (const auto& material : file.json["materials"]) materials[material["name"]] = material;
    ASSERT_EQ(materials.size(), file.json["materials"].size());
    const auto& planks = materials["planks"];
    EXPECT_EQ(planks["pbrMetallicRoughness"]["baseColorFactor"], (nlohmann::json{0.5, 0.25, 1.0, 1.0}));
    EXPECT_EQ(planks["pbrMetallicRoughness"]["metallicFactor"], 0.25);
    EXPECT_EQ(planks["normalTexture"]["texCoord"], 1);
    EXPECT_TRUE(materials.contains("inside"));
    for (const auto& mesh : file.json["meshes"])
      for (const auto& primitive : mesh["primitives"])
        EXPECT_TRUE(primitive["attributes"].contains("TEXCOORD_1"));
  }
}

/// The crate's own vertices keep their UVs.
TEST_F(MaterialsRun, UvsAreThoseOfTheFile) {
  test::writeCrateGlb(scratch.file("crate.glb"));
  run(" --to glb");
  const test::Crate crate;
  const test::GlbFile file(scratch.file("out/1/pieces.glb"));
  std::size_t found = 0;
  for (const auto& node : file.json["nodes"])
    for (const auto& primitive : file.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
      if (file.json["materials"][primitive["material"].get<std::size_t>()]["name"] == "inside") continue;
      const auto positions = file.attribute(primitive, "POSITION"),
                 normals = file.attribute(primitive, "NORMAL"), uvs = file.attribute(primitive, "TEXCOORD_0"),
                 dents = file.attribute(primitive, "TEXCOORD_1");
      for (std::size_t v = 0; v < positions.size(); ++v)
        for (std::size_t k = 0; k < crate.positions.size(); ++k) {
          double apart = 0;
          for (std::size_t c = 0; c < 3; ++c)
            apart += std::abs(positions[v][c] + node["translation"][c].get<double>() -
                              static_cast<double>(crate.positions[k][c])) +
                     std::abs(normals[v][c] - static_cast<double>(crate.normals[k][c]));
          if (apart > 1e-6) continue;
          ++found;
          for (std::size_t c = 0; c < 2; ++c) {
            EXPECT_EQ(uvs[v][c], static_cast<double>(crate.uvs[k][c]));
            EXPECT_EQ(dents[v][c], static_cast<double>(crate.dentUvs[k][c]));
          }
        }
    }
  EXPECT_GE(found, 24u);
}

TEST_F(MaterialsRun, OfAnObjFileComeBackFromThePiecesLibrary) {
  test::writeCrateObj(std::filesystem::path(scratch.file("x")).parent_path().string());
  run(" --var mesh='" + scratch.file("crate.obj") + "'");
  for (const char* level : {"out/1", "out/2"}) {
    const std::string directory = scratch.file(level);
    const std::string mtl = contentOf(directory + "/pieces.mtl");
    EXPECT_NE(mtl.find("newmtl wood\nKa 0 0 0\nKd 0.5 0.25 1\nNs 250\nillum 2\n"
                       "map_Kd -clamp on pieces_texture_01_planks_of_oak.png\n"
                       "map_Bump -bm 0.3 pieces_texture_02_dents.png\n"),
              std::string::npos)
        << mtl;
    EXPECT_NE(mtl.find("newmtl glass\nKd 0.1 0.2 0.3\nTr 0.75\n"), std::string::npos) << mtl;
    EXPECT_EQ(contentOf(directory + "/pieces_texture_01_planks_of_oak.png"), test::planksPng());
    const test::GlbFile file(directory + "/pieces.glb");
    ASSERT_EQ(file.json["images"].size(), 1u);
    EXPECT_EQ(file.image(0), test::planksPng());
  }
}

/// What stands beside a mesh is part of what comes of it.
TEST_F(MaterialsRun, AChangedLibraryOrPictureIsSeen) {
  const std::string folder = std::filesystem::path(scratch.file("x")).parent_path().string();
  test::writeCrateObj(folder);
  const std::string options =
      " --var mesh='" + scratch.file("crate.obj") + "' --to obj --cache '" + scratch.file("cache") + "'";
  run(options);
  std::ofstream(scratch.file("planks of oak.png"), std::ios::binary) << test::dentsPng();
  run(options);
  EXPECT_EQ(contentOf(scratch.file("out/1/pieces_texture_01_planks_of_oak.png")), test::dentsPng());
  std::ofstream(scratch.file("crate.mtl")) << "newmtl wood\nKd 0 1 0\nnewmtl glass\n";
  run(options);
  const std::string mtl = contentOf(scratch.file("out/1/pieces.mtl"));
  EXPECT_NE(mtl.find("newmtl wood\nKd 0 1 0\n"), std::string::npos) << mtl;
  EXPECT_FALSE(std::filesystem::exists(scratch.file("out/1/pieces_texture_01_planks_of_oak.png")));
  std::filesystem::remove(scratch.file("crate.mtl"));
  EXPECT_NE(run(options).find("its material library 'crate.mtl' can't be opened"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(scratch.file("out/1/pieces.mtl")));
}

}  // namespace
}  // namespace sherd
