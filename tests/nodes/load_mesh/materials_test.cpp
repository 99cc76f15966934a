// Materials as files give them: MTL, glTF, textures in files and beside them.
#include <gtest/gtest.h>

#include "load_mesh/file_looks.h"
#include "load_mesh/load_mesh.h"
#include "support/program.h"
#include "support/said.h"
#include "support/textured_crate.h"

namespace sherd {
namespace {

class Materials : public testing::Test {
 protected:
  TriMesh load(const std::string& name) {
    LoadMeshParams params;
    params.file = scratch.file(name);
    auto mesh = loadMesh(params, said.exec);
    EXPECT_TRUE(mesh.ok()) << (mesh.ok() ? "" : mesh.error().text());
    return mesh.ok() ? std::move(mesh).value() : TriMesh{};
  }
  /// The look of the material of that name.
  const Look& look(const TriMesh& mesh, const std::string& name) {
    static const Look kNone;
    const auto found = std::find(mesh.materials.begin(), mesh.materials.end(), name);
    const Look* look = lookOf(mesh.looks.get(), static_cast<Index>(found - mesh.materials.begin()));
    EXPECT_NE(look, nullptr) << name;
    return look == nullptr ? kNone : *look;
  }
  std::size_t warnings() const {
    return static_cast<std::size_t>(std::count_if(said.lines.begin(), said.lines.end(), [](const auto& line) {
      return line.first == LogLevel::Warning;
    }));
  }
  std::string folder() const { return std::filesystem::path(scratch.file("x")).parent_path().string(); }

  ScratchDirectory scratch;
  Said said;
};

TEST_F(Materials, OfAnObjFileStandInItsLibrary) {
  test::writeCrateObj(folder());
  const TriMesh mesh = load("crate.obj");
  EXPECT_EQ(warnings(), 0u);
  const Look &wood = look(mesh, "wood"), &glass = look(mesh, "glass");
  EXPECT_EQ(wood.baseColour, (std::array<double, 4>{1, 1, 1, 1}));  // the picture's
  EXPECT_DOUBLE_EQ(wood.roughness, 0.5);
  EXPECT_EQ(wood.alpha, Look::Alpha::Opaque);
  ASSERT_GE(wood.colourTexture.image, 0);
  EXPECT_EQ(wood.colourTexture.wrapU, Texture::Wrap::Clamp);
  EXPECT_EQ(wood.normalTexture.image, -1);  // a bump map is none
  const ImageFile& planks = mesh.looks->images[at(wood.colourTexture.image)];
  EXPECT_EQ(planks.name, "planks of oak.png");
  EXPECT_EQ(planks.bytes, test::planksPng());
  EXPECT_EQ(mesh.looks->images.size(), 2u);
  ASSERT_EQ(wood.mtl.size(), 6u);
  EXPECT_EQ(wood.mtl[0].text, "Ka 0 0 0");
  EXPECT_EQ(wood.mtl[4].text, "map_Kd -clamp on");
  EXPECT_EQ(wood.mtl[5].text, "map_Bump -bm 0.3");
  EXPECT_EQ(mesh.looks->images[at(wood.mtl[5].image)].bytes, test::dentsPng());
  EXPECT_EQ(glass.baseColour, (std::array<double, 4>{0.1, 0.2, 0.3, 0.25}));
  EXPECT_EQ(glass.alpha, Look::Alpha::Blend);
  EXPECT_EQ(glass.roughness, 0.125);
  EXPECT_EQ(glass.metallic, 1);
  EXPECT_EQ(glass.emissive, (std::array<double, 3>{0, 0.5, 0}));
}

TEST_F(Materials, ThatCannotBeHadAreWarnedOfByName) {
  test::writeCrateObj(folder(), "map_Ks missing.png\nmap_Ns fake.png\nnorm -s 2 2 dents.png\nKd red\n");
  std::ofstream(scratch.file("fake.png")) << "no picture";
  const TriMesh mesh = load("crate.obj");
  EXPECT_TRUE(said.warning("texture 'missing.png' of material 'wood' can't be opened"));
  EXPECT_TRUE(said.warning("texture 'fake.png' of material 'wood' is no picture"));
  EXPECT_TRUE(said.warning("texture 'dents.png' of material 'wood' is moved or scaled"));
  EXPECT_TRUE(said.warning("crate.mtl, line 12: 'red' are no numbers"));
  EXPECT_EQ(warnings(), 4u);
  EXPECT_EQ(look(mesh, "wood").mtl.size(), 8u);  // without the two
  EXPECT_GE(look(mesh, "wood").normalTexture.image, 0);
  std::filesystem::remove(scratch.file("crate.mtl"));
  said.lines.clear();
  EXPECT_EQ(load("crate.obj").looks, nullptr);
  EXPECT_TRUE(said.warning("crate.obj: its material library 'crate.mtl' can't be opened"));
  EXPECT_EQ(warnings(), 1u);
  std::ofstream(scratch.file("crate.mtl")) << "newmtl wood\n";
  said.lines.clear();
  load("crate.obj");
  EXPECT_TRUE(said.warning("material 'glass' is in none of its material libraries"));
}

TEST_F(Materials, OfAGlbFileStandInIt) {
  test::writeCrateGlb(scratch.file("crate.glb"));
  const TriMesh mesh = load("crate.glb");
  EXPECT_EQ(warnings(), 0u);
  const Look &planks = look(mesh, "planks"), &lid = look(mesh, "lid");
  EXPECT_EQ(planks.baseColour, (std::array<double, 4>{0.5, 0.25, 1, 1}));
  EXPECT_EQ(planks.metallic, 0.25);
  EXPECT_EQ(planks.roughness, 0.75);
  EXPECT_EQ(planks.emissive, (std::array<double, 3>{0.25, 0, 0.5}));
  EXPECT_TRUE(planks.doubleSided);
  EXPECT_EQ(planks.alpha, Look::Alpha::Opaque);
  ASSERT_GE(planks.colourTexture.image, 0);
  ASSERT_GE(planks.normalTexture.image, 0);
  EXPECT_EQ(mesh.looks->images[at(planks.colourTexture.image)].bytes, test::planksPng());
  EXPECT_EQ(mesh.looks->images[at(planks.normalTexture.image)].bytes, test::dentsPng());
  EXPECT_EQ(planks.normalTexture.uvSet, 1);
  EXPECT_EQ(planks.normalTexture.strength, 0.5);
  EXPECT_EQ(planks.normalTexture.wrapU, Texture::Wrap::Clamp);
  EXPECT_EQ(planks.normalTexture.wrapV, Texture::Wrap::Mirror);
  EXPECT_EQ(planks.metallicRoughnessTexture.image, -1);
  EXPECT_EQ(lid.alpha, Look::Alpha::Mask);
  EXPECT_EQ(lid.alphaCutoff, 0.25);
  EXPECT_EQ(lid.baseColour[3], 0.5);
  EXPECT_EQ(lid.roughness, 0.125);
  EXPECT_FALSE(lid.doubleSided);
  EXPECT_EQ(mesh.uvSets.size(), 2u);
}

TEST_F(Materials, FilesThatAreReadWithAMeshAreKnown) {
  test::writeCrateObj(folder(), "map_Ks missing.png\n");
  const auto with = filesReadWith(scratch.file("crate.obj"));
  for (const char* name : {"crate.mtl", "planks of oak.png", "dents.png", "missing.png"})
    EXPECT_EQ(std::count(with.begin(), with.end(), scratch.file(name)), 1) << name;
  std::ofstream(scratch.file("a.gltf"))
      << R"({"buffers":[{"uri":"a%20b.bin"},{"uri":"data:x"}],"images":[{"uri":"c.png"},{"bufferView":0}]})";
  const auto gltf = filesReadWith(scratch.file("a.gltf"));
  EXPECT_EQ(gltf, (std::vector<std::string>{scratch.file("a b.bin"), scratch.file("a%20b.bin"),
                                            scratch.file("c.png")}));
  test::writeCrateGlb(scratch.file("crate.glb"));
  EXPECT_TRUE(filesReadWith(scratch.file("crate.glb")).empty());
  for (const char* content :
       {"", "glTF", "{", "[]", R"({"images":3})", R"({"images":[4]})", R"({"buffers":[{"uri":{}}]})"}) {
    for (const char* name : {"b.gltf", "b.glb", "b.obj"}) {
      std::ofstream(scratch.file(name)) << content;
      EXPECT_TRUE(filesReadWith(scratch.file(name)).empty()) << content;
    }
  }
  EXPECT_TRUE(filesReadWith(scratch.file("nowhere.obj")).empty());
  EXPECT_TRUE(filesReadWith(folder()).empty());
}

TEST_F(Materials, PicturesAreKnownByTheirFirstBytes) {
  EXPECT_EQ(mimeTypeOf({"a.jpg", test::planksPng()}), "image/png");
  EXPECT_EQ(mimeTypeOf({"a", "\xff\xd8\xff\xe0"}), "image/jpeg");
  EXPECT_EQ(mimeTypeOf({"a", "RIFF1234WEBP"}), "image/webp");
  EXPECT_EQ(mimeTypeOf({"a", "RIFF1234WAVE"}), "");
  EXPECT_EQ(mimeTypeOf({"a", "RIFF"}), "");
  EXPECT_EQ(mimeTypeOf({"a.TGA", std::string(40, '\0')}), "image/x-tga");
  EXPECT_EQ(mimeTypeOf({"a.png", "text"}), "");
  EXPECT_EQ(extensionOfMimeType("image/jpeg"), ".jpg");
}

TEST_F(Materials, EmbeddedPicturesHaveBareNamesAndStandOnce) {
  LooksBuilder looks(scratch.file("a.fbx"), said.exec);
  const Index first = looks.embedded("*0", "C:\\maps\\a.fbm\\oak.png", test::planksPng(), "wood");
  EXPECT_EQ(looks.embedded("*0", "", "", "wood"), first);
  EXPECT_EQ(looks.embedded("*1", "maps/oak.png", test::planksPng(), "wood"), first);
  EXPECT_EQ(looks.embedded("*2", "", test::dentsPng(), "wood"), 1);
  EXPECT_EQ(looks.embedded("*3", "", "text", "wood"), -1);
  EXPECT_TRUE(said.warning("a.fbx: texture 'texture' of material 'wood' is no picture"));
  looks.set(0, Look{});
  const auto taken = looks.take();
  ASSERT_EQ(taken->images.size(), 2u);
  EXPECT_EQ(taken->images[0].name, "oak.png");
  EXPECT_EQ(taken->images[1].name, "texture.png");
}

TEST_F(Materials, DamagedLibrariesDoNotHurt) {
  test::writeCrateObj(folder());
  FileMesh file;
  file.mesh.materials = {"wood", "glass"};
  file.materialLibraries = {"crate.mtl"};
  const std::string whole = test::crateMtl("norm -o 1\nmap_d\nmap_Ke -bm\nKe 1e999 nan\nTr\n");
  Exec silent;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    std::ofstream(scratch.file("crate.mtl")) << whole.substr(0, size);
    readMaterialLibraries(file, scratch.file("crate.obj"), silent);
    if (!file.mesh.looks) continue;
    for (const auto& look : file.mesh.looks->looks) {
      if (!look) continue;
      for (const double value : look->baseColour) EXPECT_TRUE(value >= 0 && value <= 1);
      for (const double value : look->emissive) EXPECT_TRUE(std::isfinite(value));
    }
  }
}

}  // namespace
}  // namespace sherd
