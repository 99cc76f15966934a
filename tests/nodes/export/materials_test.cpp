// Materials in exported files: GLB's, and the library beside OBJ files.
#include <gtest/gtest.h>

#include "export/export_crack_surface.h"
#include "export/export_pieces.h"
#include "export/owned_files.h"
#include "support/fragment_families.h"
#include "support/glb_file.h"
#include "support/program.h"
#include "support/said.h"
#include "support/textured_crate.h"
#include "types/surface_looks.h"

namespace sherd {
namespace {

class ExportMaterials : public testing::Test {
 protected:
  ExportMaterials() {
    looks.images = {{"planks of oak.png", test::planksPng()}, {"dents.png", test::dentsPng()}};
    Look paint;
    paint.baseColour = {0.5, 0.25, 1, 0.75};
    paint.metallic = 0.25;
    paint.alpha = Look::Alpha::Blend;
    paint.doubleSided = true;
    paint.colourTexture.image = 0;
    paint.normalTexture = {1, 0, 0.5, Texture::Wrap::Clamp, Texture::Wrap::Mirror};
    looks.looks = {paint};
    box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  }
  Fragments broken() {
    box.looks = std::make_shared<const SurfaceLooks>(looks);
    return test::slices(box, {1.1});
  }
  nlohmann::json glb(const Fragments& f) {
    EXPECT_TRUE(exportPieces(f, {.directory = out}, said.exec).ok());
    const test::GlbFile file(out + "/pieces.glb");
    for (const std::string& fault : file.faults) ADD_FAILURE() << fault;
    images.clear();
    for (std::size_t i = 0; file.json.contains("images") && i < file.json["images"].size(); ++i)
      images.push_back(file.image(i));
    return file.json;
  }
  void obj(const Fragments& f, ExportCrackSurfaceParams::Format format = {}) {
    const auto report = exportCrackSurface(f, {.directory = out, .format = format}, said.exec);
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().text());
  }

  ScratchDirectory scratch;
  const std::string out = scratch.file("out");
  SurfaceLooks looks;
  TriMesh box;
  std::vector<std::string> images;
  Said said;
};

TEST_F(ExportMaterials, StandInGlbWithTheirPicturesOnce) {
  const nlohmann::json json = glb(broken());
  EXPECT_EQ(images, (std::vector<std::string>{test::planksPng(), test::dentsPng()}));
  const auto& paint = json["materials"][0];
  EXPECT_EQ(paint["name"], "paint");
  EXPECT_EQ(paint["alphaMode"], "BLEND");
  EXPECT_EQ(paint["doubleSided"], true);
  EXPECT_EQ(paint["normalTexture"]["scale"], 0.5);
  const auto& surface = paint["pbrMetallicRoughness"];
  EXPECT_EQ(surface["baseColorFactor"], (nlohmann::json{0.5, 0.25, 1.0, 0.75}));
  EXPECT_EQ(surface["metallicFactor"], 0.25);
  EXPECT_EQ(surface["roughnessFactor"], 1);
  const auto& normal = json["textures"][paint["normalTexture"]["index"].get<std::size_t>()];
  EXPECT_EQ(json["images"][normal["source"].get<std::size_t>()]["name"], "dents.png");
  const auto& sampler = json["samplers"][normal["sampler"].get<std::size_t>()];
  EXPECT_EQ(sampler, (nlohmann::json{{"wrapS", 33071}, {"wrapT", 33648}}));
  EXPECT_EQ(json["materials"].size(), 3u);
  EXPECT_TRUE(said.lines.back().first == LogLevel::Info);
}

TEST_F(ExportMaterials, ThatAreNamesOnlyAndInsideLookAsBefore) {
  const nlohmann::json with = glb(broken());
  box.looks = nullptr;
  const nlohmann::json without = glb(test::slices(box, {1.1}));
  EXPECT_TRUE(images.empty());
  EXPECT_FALSE(without.contains("images") || without.contains("textures"));
  for (const std::size_t m : {1, 2}) EXPECT_EQ(with["materials"][m], without["materials"][m]);
  EXPECT_EQ(without["materials"][2]["name"], "inside");
}

TEST_F(ExportMaterials, GlbLeavesOutWhatItCannotHold) {
  looks.images[0].bytes = "GIF89a";
  looks.looks[0]->normalTexture.uvSet = 1;
  const nlohmann::json json = glb(broken());
  EXPECT_TRUE(said.warning(
      "texture 'planks of oak.png' of material 'paint' is left out: GLB files hold PNG and JPEG"));
  EXPECT_TRUE(said.warning("'dents.png' of material 'paint' is left out: the mesh lacks the UV set"));
  EXPECT_TRUE(images.empty());
  EXPECT_FALSE(json["materials"][0].contains("normalTexture"));
}

TEST_F(ExportMaterials, StandInALibraryBesideObjFiles) {
  looks.looks[0]->occlusionTexture.image = 0;
  obj(broken());
  EXPECT_TRUE(said.warning("have no word for textures of metal"));
  const std::string mtl = contentOf(out + "/pieces.mtl");
  EXPECT_NE(
      mtl.find(
          "\nnewmtl paint\nKd 0.5 0.25 1\nd 0.75\nPr 1\nPm 0.25\nmap_Kd pieces_texture_01_planks_of_oak.png\n"
          "map_d pieces_texture_01_planks_of_oak.png\nnorm pieces_texture_02_dents.png\n"),
      std::string::npos)
      << mtl;
  EXPECT_NE(mtl.find("\nnewmtl base\nKd 0.8 0.8 0.8\n"), std::string::npos) << mtl;
  EXPECT_NE(mtl.find("\nnewmtl inside\nKd 0.55 0.5 0.45\n"), std::string::npos) << mtl;
  EXPECT_EQ(contentOf(out + "/pieces_texture_01_planks_of_oak.png"), test::planksPng());
  EXPECT_EQ(contentOf(out + "/pieces_texture_02_dents.png"), test::dentsPng());
  for (const char* file : {"/piece_0001_surface.obj", "/piece_0002_crack.obj"})
    EXPECT_NE(contentOf(out + file).find("\nmtllib pieces.mtl\no "), std::string::npos);
  const std::string manifest = contentOf(out + "/sherd_manifest.json");
  for (const char* name : {"\"pieces.mtl\"", "\"pieces_texture_02_dents.png\""})
    EXPECT_NE(manifest.find(name), std::string::npos);
}

TEST_F(ExportMaterials, OfAnOldLibraryAreSaidAgainWordForWord) {
  looks.looks[0]->mtl = {{"Ka 0 0 0", -1}, {"illum 2", -1}, {"map_Bump -bm 0.3", 1}};
  obj(broken());
  const std::string mtl = contentOf(out + "/pieces.mtl");
  EXPECT_NE(mtl.find("newmtl paint\nKa 0 0 0\nillum 2\nmap_Bump -bm 0.3 pieces_texture_01_dents.png\n\n"),
            std::string::npos)
      << mtl;
  EXPECT_FALSE(std::filesystem::exists(out + "/pieces_texture_01_planks_of_oak.png"));
}

TEST_F(ExportMaterials, PicturesMayHaveAnyName) {
  looks.images[0].name = std::string(400, 'x') + "/../\n\xc3\xa9 .png";
  looks.images[1].name = "";
  obj(broken());
  EXPECT_EQ(contentOf(out + "/pieces_texture_02_"), test::dentsPng());
  const std::string name = "pieces_texture_01_" + std::string(88, 'x') + "_.._____.png";
  EXPECT_EQ(contentOf(out + '/' + name), test::planksPng());
  EXPECT_NE(contentOf(out + "/pieces.mtl").find("map_Kd " + name + "\n"), std::string::npos);
}

TEST_F(ExportMaterials, AreRemovedWhenTheyAreNoLongerWritten) {
  obj(broken());
  const std::size_t files = filesBelow(out).size();
  box.looks = nullptr;
  obj(test::slices(box, {1.1}));
  EXPECT_EQ(filesBelow(out).size(), files - 3);
  EXPECT_EQ(contentOf(out + "/piece_0001_surface.obj").find("mtllib"), std::string::npos);
  obj(broken());
  EXPECT_EQ(filesBelow(out).size(), files);
  obj(broken(), ExportCrackSurfaceParams::Format::Ply);
  EXPECT_TRUE(said.info("PLY holds the names of materials only"));
  EXPECT_EQ(filesBelow(out).size(), files - 3);
}

TEST_F(ExportMaterials, TheirFilesCanBeOursAndStrangersCannot) {
  for (const char* name : {"pieces.mtl", "pieces_texture_01_a.png", "pieces_texture_12_B-c_d.e.jpg"})
    EXPECT_TRUE(OwnedFiles::canBeOurs(name)) << name;
  for (const char* name : {"other.mtl", "pieces_texture_", "pieces_texture_a.png",
                           "pieces_texture_01_a/b.png", "pieces_texture_01_a b.png"})
    EXPECT_FALSE(OwnedFiles::canBeOurs(name)) << name;
}

TEST_F(ExportMaterials, OfAPieceStayAndItsInsideIsOurs) {
  box.materials = {"paint", "inside"};
  box.piece = "piece_0001";
  const nlohmann::json json = glb(broken());
  ASSERT_EQ(json["materials"].size(), 2u);
  EXPECT_EQ(json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"][0], static_cast<double>(0.55f));
  EXPECT_EQ(images.size(), 2u);
  obj(broken());
  EXPECT_NE(contentOf(out + "/pieces.mtl").find("newmtl inside\nKd 0.55 0.5 0.45\n"), std::string::npos);
  EXPECT_FALSE(said.warning("'inside'"));
}

}  // namespace
}  // namespace sherd
