#include "export/export_pieces.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "base/parallel.h"
#include "export/export_crack_surface.h"
#include "export/float_rounding.h"
#include "export/glb.h"
#include "graph/node_type.h"
#include "support/fragment_families.h"
#include "support/glb_file.h"
#include "support/program.h"
#include "support/said.h"
#include "support/surface_families.h"

namespace sherd {

NodeType exportPiecesNode();

namespace {

namespace fs = std::filesystem;

class ExportGlb : public testing::Test {
 protected:
  ExportGlb() { params.directory = scratch.file("out"); }
  Result<ExportPiecesReport> run(const Fragments& f) { return exportPieces(f, params, said.exec); }
  std::string out(const std::string& name) const { return params.directory + '/' + name; }

  test::GlbFile mustExport(const Fragments& f) {
    const auto report = run(f);
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().text());
    test::GlbFile file(out("pieces.glb"));
    for (const std::string& fault : file.faults) ADD_FAILURE() << fault;
    return file;
  }

  ScratchDirectory scratch;
  ExportPiecesParams params;
  Said said;
};

Vec3 vec3(const std::vector<double>& list) { return {list[0], list[1], list[2]}; }
Vec3 vec3(const nlohmann::json& list) { return vec3(list.get<std::vector<double>>()); }

const nlohmann::json& primitivesOf(const test::GlbFile& file, std::size_t node) {
  return file.json["meshes"][file.json["nodes"][node]["mesh"].get<std::size_t>()]["primitives"];
}

std::string materialOf(const test::GlbFile& file, const nlohmann::json& primitive) {
  return file.json["materials"][primitive["material"].get<std::size_t>()]["name"];
}

/// Triangles of a node in the world.
std::vector<std::array<Vec3, 3>> worldTriangles(const test::GlbFile& file, std::size_t node, bool inside) {
  std::vector<std::array<Vec3, 3>> triangles;
  const Vec3 pivot = vec3(file.json["nodes"][node]["translation"]);
  for (const auto& primitive : primitivesOf(file, node)) {
    if (inside && materialOf(file, primitive) != "inside") continue;
    const test::GlbArray positions = file.attribute(primitive, "POSITION");
    const auto indices = file.indices(primitive);
    for (std::size_t i = 0; i < indices.size(); i += 3)
      triangles.push_back({pivot + vec3(positions[indices[i]]), pivot + vec3(positions[indices[i + 1]]),
                           pivot + vec3(positions[indices[i + 2]])});
  }
  return triangles;
}

TEST(FloatRounding, IsThatOfFloats) {
  EXPECT_EQ(roundedToFloat(Vec3(1000.6, 0.1, -1.0 / 3)),
            Vec3(1000.5999755859375, 0.100000001490116119384765625, -0.3333333432674407958984375));
  EXPECT_FALSE(std::signbit(roundedToFloat(-0.0)));
  EXPECT_TRUE(std::isinf(roundedToFloat(1e39)));
}

TEST_F(ExportGlb, RefusesNoPieces) {
  EXPECT_EQ(run(Fragments{}).error().port, "pieces");
  EXPECT_FALSE(fs::exists(params.directory));
}

TEST_F(ExportGlb, AnUnbrokenBodyIsOnePiece) {
  const test::GlbFile file = mustExport(test::slicedBox(1));
  ASSERT_EQ(file.json["nodes"].size(), 1u);
  EXPECT_EQ(file.json["materials"].size(), 2u);  // paint and base
  EXPECT_TRUE(said.info("1 piece in"));
}

TEST_F(ExportGlb, NamesMaterialsAndProperties) {
  const Fragments f = test::slicedBox(3);
  const test::GlbFile file = mustExport(f);
  ASSERT_EQ(file.json["nodes"].size(), 3u);
  std::vector<std::string> materials;
  for (const auto& material : file.json["materials"]) materials.push_back(material["name"]);
  EXPECT_EQ(materials, (std::vector<std::string>{"paint", "base", "inside"}));
  for (std::size_t p = 0; p < 3; ++p) {
    const auto& node = file.json["nodes"][p];
    EXPECT_EQ(node["name"], f.pieces[p].name);
    EXPECT_EQ(file.json["meshes"][node["mesh"].get<std::size_t>()]["name"], f.pieces[p].name);
    EXPECT_EQ(primitivesOf(file, p).size(), 3u);
    const auto& extras = node["extras"];
    EXPECT_EQ(extras["volume"], f.pieces[p].volume);
    EXPECT_EQ(extras["mass"], f.material.density * f.pieces[p].volume);
    EXPECT_EQ(vec3(extras["centre_of_mass"]), f.pieces[p].centreOfMass);
    EXPECT_EQ(extras["neighbours"].size(), p == 1 ? 2u : 1u);
    EXPECT_EQ(extras["parent"], "");
  }
  EXPECT_EQ(file.json["nodes"][1]["extras"]["neighbours"][1]["name"], "piece_0003");
}

TEST_F(ExportGlb, PivotsAreCentresOfMassAndTwinsAgree) {
  for (const double away : {0.0, 1000.0}) {
    const Vec3 low(away + 0.1, 0.2, -away);
    const double size = Vec3(4.7, 1.3, 1.9).norm();
    const Fragments f =
        test::slices(test::boxMesh(low, low + Vec3(4.7, 1.3, 1.9)), {low.x() + 1, low.x() + 3.3});
    const test::GlbFile file = mustExport(f);
    for (std::size_t p = 0; p < 3; ++p) {
      const Vec3 pivot = vec3(file.json["nodes"][p]["translation"]);
      EXPECT_LT((pivot - f.pieces[p].centreOfMass).norm(), 1e-7 * (size + 2 * away));
      double volume = 0;
      Vec3 moment = Vec3::Zero();
      for (const auto& [a, b, c] : worldTriangles(file, p, false)) {
        const double own = (a - pivot).cross(b - pivot).dot(c - pivot) / 6;
        volume += own;
        moment += own / 4 * (a + b + c - 3 * pivot);
      }
      EXPECT_NEAR(volume, f.pieces[p].volume, 1e-6 * f.pieces[p].volume);
      EXPECT_LT((moment / volume).norm(), 1e-6 * size + 1e-7 * away);
    }
    for (std::size_t p = 0; p < 3; ++p)
      for (const auto& triangle : worldTriangles(file, p, true))
        for (const Vec3& corner : triangle) {
          double nearest = 1e300;
          for (std::size_t other = 0; other < 3; ++other)
            if (other != p)
              for (const auto& twin : worldTriangles(file, other, true))
                for (const Vec3& x : twin) nearest = std::min(nearest, (x - corner).norm());
          EXPECT_LT(nearest, 1e-6 * size);
        }
  }
}

TEST_F(ExportGlb, OutsideIsTheArtistsAndInsideIsGenerated) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.uvSets.push_back({"lightmap", std::vector<Vec2>(box.cornerCount(), Vec2(0.25, 0.125))});
  box.colorSets.push_back({"dirt", std::vector<Vec4>(box.cornerCount(), Vec4(1.5, 0.5, 0.25, 1))});
  params.textureDensity = 4;
  const test::GlbFile file = mustExport(test::slices(box, {1.1}));
  EXPECT_TRUE(said.warning("colours in 'dirt' leave [0, 1]"));
  for (const auto& primitive : primitivesOf(file, 0)) {
    const auto& attributes = primitive["attributes"];
    EXPECT_TRUE(attributes.contains("TEXCOORD_1"));
    const bool isInside = materialOf(file, primitive) == "inside";
    EXPECT_NE(attributes.contains("COLOR_0"), isInside);
    const test::GlbArray uvs = file.attribute(primitive, "TEXCOORD_1");
    const test::GlbArray normals = file.attribute(primitive, "NORMAL");
    double widest = 0;
    for (std::size_t v = 0; v < uvs.size(); ++v) {
      if (isInside) {
        EXPECT_EQ(normals[v], (std::vector<double>{1, 0, 0}));
        for (const auto& other : uvs)
          widest = std::max({widest, std::abs(other[0] - uvs[v][0]), std::abs(other[1] - uvs[v][1])});
      } else {
        EXPECT_EQ(uvs[v], (std::vector<double>{0.25, 0.875}));
        EXPECT_EQ(file.attribute(primitive, "COLOR_0")[v], (std::vector<double>{1, 0.5, 0.25, 1}));
      }
    }
    EXPECT_NEAR(widest, isInside ? 4 : 0, 1e-6);  // a metre
  }
}

TEST_F(ExportGlb, OldAndNewCrackFacesAreOfOneMaterial) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.materials[1] = "inside";
  const nlohmann::json inside = mustExport(test::slicedBox(2)).json["materials"][2];
  for (const bool isPiece : {false, true}) {
    box.piece = isPiece ? "piece_0001" : "";
    said.lines.clear();
    const test::GlbFile file = mustExport(test::slices(box, {1.1}));
    EXPECT_NE(said.warning("'inside' of its own"), isPiece);
    const auto& materials = file.json["materials"];
    ASSERT_EQ(materials.size(), isPiece ? 2u : 3u);
    EXPECT_EQ(materials.back(), inside);
  }
  // Where no old crack face is left in sight the material is there all the same, once.
  box.materials = {"paint", "base", "inside"};
  const test::GlbFile file = mustExport(test::slices(box, {1.1}));
  EXPECT_EQ(file.json["materials"].size(), 3u);
}

TEST_F(ExportGlb, WhatTheSourceLacksIsLeftOut) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.normals.clear(), box.uvSets.clear(), box.materials.clear(), box.materialOf.clear();
  const test::GlbFile file = mustExport(test::slices(box, {1.1}));
  EXPECT_EQ(file.json["materials"][0]["name"], "outside");
  const auto& primitives = primitivesOf(file, 0);
  ASSERT_EQ(primitives.size(), 2u);
  EXPECT_EQ(primitives[0]["attributes"].size(), 1u);
  EXPECT_EQ(primitives[1]["attributes"].size(), 3u);
}

TEST_F(ExportGlb, VerticesAreSharedWhereTheirAttributesAreEqual) {
  TriMesh sphere = families::sphereSurface(Vec3::Zero(), 1, 40, 20);
  const test::GlbFile file = mustExport(test::slices(sphere, {}));
  EXPECT_EQ(file.attribute(primitivesOf(file, 0)[0], "POSITION").size(), sphere.positions.size());
}

TEST_F(ExportGlb, ManyVerticesGetWideIndices) {
  const TriMesh sphere = families::sphereSurface(Vec3(0.3, 0, 0), 1, 400, 200);
  const test::GlbFile file = mustExport(test::slices(sphere, {}));
  const auto& indices = file.json["accessors"][primitivesOf(file, 0)[0]["indices"].get<std::size_t>()];
  EXPECT_EQ(indices["componentType"], 5125);
}

TEST_F(ExportGlb, NamesThatAreNoUtf8DoNotHurt) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.materials = {"Stein \"\xfc\"\n", ""};
  mustExport(test::slices(box, {1.1}));
}

TEST_F(ExportGlb, NumbersBeyondFloatsAreAnError) {
  Fragments f = test::slices(test::boxMesh(Vec3::Zero(), Vec3(2e39, 1, 1)), {1e39});
  const auto result = run(f);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "pieces");
  EXPECT_NE(result.error().what.find("too large for GLB's floats"), std::string::npos);
  EXPECT_FALSE(fs::exists(params.directory));
}

TEST_F(ExportGlb, SecondRunTouchesNothingAndMendsWhatWasChanged) {
  const Fragments f = test::slicedBox(3);
  ASSERT_TRUE(run(f)->written);
  const std::string whole = contentOf(out("pieces.glb"));
  EXPECT_FALSE(run(f)->written);
  std::ofstream(out("pieces.glb")) << "else";
  std::ofstream(out("pieces.glb.0123456789abcdef.partial")) << "half";
  EXPECT_TRUE(run(f)->written);
  EXPECT_EQ(contentOf(out("pieces.glb")), whole);
  EXPECT_EQ(filesBelow(params.directory).size(), 2u);
}

TEST_F(ExportGlb, ForeignFilesAreLeftAlone) {
  fs::create_directories(params.directory);
  std::ofstream(out("pieces.glb")) << "a stranger's";
  std::ofstream(out("notes.txt")) << "mine";
  const auto result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "directory");
  EXPECT_EQ(contentOf(out("pieces.glb")), "a stranger's");
  EXPECT_EQ(filesBelow(params.directory).size(), 2u);
  fs::remove(out("pieces.glb"));
  ASSERT_TRUE(run(test::slicedBox(2)).ok());
  EXPECT_EQ(contentOf(out("notes.txt")), "mine");
}

TEST_F(ExportGlb, SharesItsDirectoryWithExportCrackSurface) {
  ExportCrackSurfaceParams crack;
  crack.directory = params.directory;
  for (const std::size_t count : {5, 3}) {
    const Fragments f = test::slicedBox(count);
    ASSERT_TRUE(run(f).ok());
    ASSERT_TRUE(exportCrackSurface(f, crack, Exec{}).ok());
    ASSERT_TRUE(run(f).ok());
    // Two files a piece, pieces.json, pieces.glb and two manifests.
    EXPECT_EQ(filesBelow(params.directory).size(), 2 * count + 4);
  }
}

TEST_F(ExportGlb, CancelledOrFailedRunLeavesTheOldFile) {
  ASSERT_TRUE(run(test::slicedBox(2)).ok());
  const auto before = filesBelow(params.directory);
  CancelToken token;
  said.exec.cancel = &token;
  said.exec.onProgress = [&](double) { token.cancel(); };
  EXPECT_EQ(run(test::slicedBox(3)).error().kind, Error::Kind::Cancelled);
  EXPECT_EQ(filesBelow(params.directory), before);
  said.exec = Exec{};
  params.directory += "/pieces.glb/below";
  EXPECT_EQ(run(test::slicedBox(3)).error().port, "directory");
}

TEST_F(ExportGlb, SameBytesForAnyNumberOfThreads) {
  const Fragments f = test::slicedBox(9);
  std::string bytes[2];
  for (int threads = 1; threads <= 2; ++threads) {
    setThreadLimit(threads);
    inArena([&] { mustExport(f); });
    bytes[threads - 1] = contentOf(out("pieces.glb"));
  }
  setThreadLimit(0);
  EXPECT_TRUE(bytes[0] == bytes[1]);
}

TEST_F(ExportGlb, NodeWritesAndTellsOfItsFiles) {
  const NodeType type = exportPiecesNode();
  EXPECT_TRUE(type.writesFiles);
  ParamValues values;
  for (const ParamInfo& info : type.params) values[info.name] = info.fallback;
  values["directory"] = params.directory;
  NodeIo io(said.exec);
  io.setInput("pieces", Value::of<Fragments>(std::make_shared<const Fragments>(test::slicedBox(2))));
  ASSERT_TRUE(type.run(values, io).ok());
  EXPECT_EQ(*io.output("file").as<std::string>(), out("pieces.glb"));
  EXPECT_EQ(io.written().size(), 2u);
}

/// The reader above finds what is wrong.
TEST_F(ExportGlb, TheReaderOfTheseTestsSeesDamage) {
  mustExport(test::slicedBox(2));
  const std::string whole = contentOf(out("pieces.glb"));
  const std::size_t json = whole.find("\"count\":");
  ASSERT_NE(json, std::string::npos);
  const auto faultsOf = [&](std::string bytes) {
    std::ofstream(scratch.file("damaged.glb"), std::ios::binary) << bytes;
    return test::GlbFile(scratch.file("damaged.glb")).faults.size();
  };
  EXPECT_EQ(faultsOf(whole), 0u);
  std::string damaged = whole;
  damaged[json + 8] = '9';
  EXPECT_GT(faultsOf(damaged), 0u);
  EXPECT_GT(faultsOf(whole.substr(0, whole.size() - 4)), 0u);
  damaged = whole;
  damaged.replace(damaged.size() - 4, 4, "\xff\xff\xff\xff");  // the last indices
  EXPECT_GT(faultsOf(damaged), 0u);
  damaged = whole;
  damaged[4] = 1;
  EXPECT_GT(faultsOf(damaged), 0u);
}

}  // namespace
}  // namespace sherd
