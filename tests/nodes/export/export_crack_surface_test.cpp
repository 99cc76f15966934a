#include "export/export_crack_surface.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/parallel.h"
#include "graph/node_type.h"
#include "nodes/export/export_fixture.h"
#include "support/fragment_families.h"

namespace sherd {

NodeType exportCrackSurfaceNode();

namespace {

using namespace export_test;

TEST_F(Export, RefusesNoPieces) {
  const auto result = run(Fragments{});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "pieces");
  EXPECT_FALSE(fs::exists(params.directory));
}

TEST_F(Export, UnbrokenBodyIsOnePieceWithoutCrackFile) {
  Fragments f = test::slicedBox(1);
  f.energy = 0.5;
  f.gamma = 2;
  ASSERT_TRUE(run(f).ok());
  EXPECT_EQ(namesIn(params.directory),
            (std::set<std::string>{"piece_0001_surface.obj", "pieces.json", "sherd_manifest.json"}));
  ASSERT_EQ(listener.infos.size(), 1u);
  EXPECT_NE(listener.infos[0].find("nothing broke: E_D = 0.5 J·m² is below γ = 2 J·m²"), std::string::npos)
      << listener.infos[0];
  const auto json = nlohmann::json::parse(slurp(out("pieces.json")));
  EXPECT_TRUE(json["below_threshold"]);
  EXPECT_TRUE(json["pieces"][0]["crack"].is_null());
}

TEST_F(Export, BrokenBodyIsNotCalledWhole) {
  Fragments f = test::slicedBox(2);
  f.energy = 3;
  f.gamma = 2;
  ASSERT_TRUE(run(f).ok());
  ASSERT_EQ(listener.infos.size(), 1u);
  EXPECT_NE(listener.infos[0].find("2 pieces from 2 sites (E_D = 3 J·m² is not below"), std::string::npos);
  EXPECT_FALSE(nlohmann::json::parse(slurp(out("pieces.json")))["below_threshold"]);
}

TEST_F(Export, GammaOfZeroIsNoDegreeGiven) {
  Fragments f = test::slicedBox(2);
  f.energy = 3;
  ASSERT_TRUE(run(f).ok());
  EXPECT_NE(listener.infos.back().find("is not below γ = 0 J·m²"), std::string::npos)
      << listener.infos.back();
  auto json = nlohmann::json::parse(slurp(out("pieces.json")));
  EXPECT_FALSE(json["degree_given"]);
  EXPECT_FALSE(json["below_threshold"]);
  f.degreeGiven = true;
  ASSERT_TRUE(run(f).ok());
  EXPECT_NE(listener.infos.back().find("degree given"), std::string::npos) << listener.infos.back();
  json = nlohmann::json::parse(slurp(out("pieces.json")));
  EXPECT_TRUE(json["degree_given"]);
  EXPECT_TRUE(json["gamma"].is_null()) << "cells of no γ";
  EXPECT_TRUE(json["below_threshold"].is_null()) << "nothing was judged";
  f.gamma = 5;
  ASSERT_TRUE(run(f).ok());
  json = nlohmann::json::parse(slurp(out("pieces.json")));
  EXPECT_EQ(json["gamma"], 5);
  EXPECT_TRUE(json["below_threshold"].is_null());
}

TEST_F(Export, MergedPartsAreCounted) {
  Fragments f = test::slicedBox(2);
  ASSERT_TRUE(run(f).ok());
  EXPECT_EQ(nlohmann::json::parse(slurp(out("pieces.json")))["merged_parts"], 0);
  f.counts.mergedParts = 3;
  ASSERT_TRUE(run(f).ok());
  EXPECT_EQ(nlohmann::json::parse(slurp(out("pieces.json")))["merged_parts"], 3);
}

TEST_F(Export, HowTheDegreeCameAboutIsPartOfTheHash) {
  Fragments f = test::slicedBox(2);
  Hasher found, given;
  hashValue(found, f);
  f.degreeGiven = true;
  hashValue(given, f);
  EXPECT_NE(found.digest().hex(), given.digest().hex());
}

TEST_F(Export, PiecesCloseAndCrackFacesHaveTwins) {
  for (const double metresPerUnit : {1.0, 0.01}) {
    TriMesh box = test::boxMesh(Vec3(0.1, 0.2, 0.3), Vec3(4.7, 1.3, 1.9));
    box.frame = {metresPerUnit, metresPerUnit == 1 ? FileFrame::Up::Y : FileFrame::Up::Z};
    ASSERT_TRUE(run(test::slices(box, {1.1, 1.7, 3.3})).ok());
    std::map<std::array<Coordinates, 3>, int> turning;  // crack triangles, sorted: +1 or −1 by orientation
    for (int p = 1; p <= 4; ++p) {
      const std::string name = "piece_000" + std::to_string(p);
      std::map<std::pair<Coordinates, Coordinates>, int> edges;
      for (const char* part : {"_surface.obj", "_crack.obj"}) {
        const Obj obj = readObj(out(name + part));
        for (const auto& face : obj.faces) {
          std::array<Coordinates, 3> key;
          for (std::size_t c = 0; c < 3; ++c) key[c] = obj.positions.at(face[c]);
          for (std::size_t c = 0; c < 3; ++c) {
            ++edges[{key[c], key[(c + 1) % 3]}];
            --edges[{key[(c + 1) % 3], key[c]}];
          }
          if (part[1] != 'c') continue;
          const int inversions = (key[0] > key[1]) + (key[1] > key[2]) + (key[0] > key[2]);
          std::sort(key.begin(), key.end());
          turning[key] += inversions % 2 ? 1 : -1;
        }
      }
      for (const auto& [edge, count] : edges) EXPECT_EQ(count, 0);
    }
    EXPECT_FALSE(turning.empty());
    for (const auto& [triangle, sum] : turning) EXPECT_EQ(sum, 0);
  }
}

TEST_F(Export, CoordinatesAreTheVeryDoubles) {
  Fragments f =
      test::slices(test::boxMesh(Vec3(1e6 + 0.1, -1.0 / 3, 1e-17), Vec3(1e6 + 1.7, 2.0 / 3, 0.1)), {1e6 + 1});
  ASSERT_TRUE(run(f).ok());
  std::set<Coordinates> expected, found;
  for (const Vec3& p : f.positions) expected.insert({p.x(), p.y(), p.z()});
  for (const char* file : {"piece_0001_surface.obj", "piece_0002_surface.obj"})
    for (const Coordinates& p : readObj(out(file)).positions) found.insert(p);
  EXPECT_EQ(expected, found);
}

TEST_F(Export, NamesAndAttributes) {
  ASSERT_TRUE(run(test::slicedBox(3)).ok());
  const Obj surface = readObj(out("piece_0002_surface.obj")), crack = readObj(out("piece_0002_crack.obj"));
  EXPECT_EQ(std::set<std::string>(surface.groups.begin(), surface.groups.end()),
            std::set<std::string>{"piece_0002"});
  EXPECT_EQ(std::set<std::string>(surface.materials.begin(), surface.materials.end()),
            (std::set<std::string>{"paint", "base"}));
  EXPECT_EQ(surface.normals, 4u);  // of the four sides of a middle slice
  EXPECT_GT(surface.uvs, 0u);
  EXPECT_EQ(crack.groups, (std::vector<std::string>{"piece_0002_crack_with_piece_0001",
                                                    "piece_0002_crack_with_piece_0003"}));
  EXPECT_EQ(crack.materials, (std::vector<std::string>{"inside", "inside"}));
  EXPECT_EQ(crack.normals, 2u);
  EXPECT_EQ(crack.uvs, 16u);  // two sections of eight vertices
}

TEST_F(Export, FacesWithoutMaterialAreOutside) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.materialOf[0] = -1;
  for (const bool hasMaterials : {true, false}) {
    if (!hasMaterials) box.materials.clear(), box.materialOf.clear();
    params.format = Params::Format::Obj;
    ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
    const Obj surface = readObj(out("piece_0001_surface.obj"));
    EXPECT_EQ(surface.materials.front(), "outside");
    EXPECT_EQ(surface.materials.size(), hasMaterials ? 4u : 1u);
    params.format = Params::Format::Ply;
    ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
    EXPECT_NE(slurp(out("piece_0001_surface.ply"))
                  .find(hasMaterials ? "comment material 2 outside\n" : "comment material 0 outside\n"),
              std::string::npos);
  }
}

TEST_F(Export, AMaterialNamedAsOursIsWarnedOf) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.materials[1] = "inside";
  ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
  ASSERT_EQ(listener.warnings.size(), 1u);
  EXPECT_NE(listener.warnings[0].find("'inside'"), std::string::npos);
}

TEST_F(Export, FacesOfAnEarlierFractureAreSkinOfThisOne) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.materials = {"crackle glaze", "inside"};
  box.piece = "piece_0001";
  ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
  EXPECT_TRUE(listener.warnings.empty());
  std::istringstream lines(slurp(out("piece_0001_surface.obj")));
  std::string last;
  std::size_t faces = 0;
  std::set<std::string> materials;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("usemtl ")) materials.insert(line.substr(7));
    if (line.starts_with("usemtl ") || line.starts_with("g ")) last = line;
    if (!line.starts_with("f ")) continue;
    EXPECT_EQ(last, "g piece_0001");
    ++faces;
  }
  EXPECT_GT(faces, 8u);
  EXPECT_EQ(materials, (std::set<std::string>{"crackle glaze", "inside"}));
  const std::string crack = slurp(out("piece_0001_crack.obj"));
  EXPECT_NE(crack.find("usemtl inside\ng piece_0001_crack_with_piece_0002\nf "), std::string::npos);
}

TEST_F(Export, TextureDensityScalesCrackUvs) {
  const Fragments f = test::slicedBox(2);
  for (const double density : {1.0, 8.0}) {
    params.textureDensity = density;
    ASSERT_TRUE(run(f).ok());
    std::ifstream in(out("piece_0001_crack.obj"));
    double largest = 0;
    for (std::string line, key; std::getline(in, line);) {
      std::istringstream words(line);
      double u = 0, v = 0;
      if (words >> key && key == "vt" && words >> u >> v) largest = std::max({largest, u, v});
    }
    EXPECT_NEAR(largest, density, 1e-6);  // the section is a square of a metre
  }
  for (const double density : {0.0, -1.0, 1e39, std::nan("")}) {
    params.textureDensity = density;
    const auto result = run(f);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().port, "texture_density");
  }
}

TEST_F(Export, DescriptionAddsUp) {
  Fragments four = test::slicedBox(4);
  four.degreeGiven = true;
  ASSERT_TRUE(run(four).ok());
  const auto json = nlohmann::json::parse(slurp(out("pieces.json")));
  EXPECT_EQ(json["N"], 4);
  EXPECT_EQ(json["piece_count"], 4);
  EXPECT_TRUE(json["degree_given"]);
  double mass = 0;
  for (const auto& piece : json["pieces"]) {
    mass += piece["mass"].get<double>();
    EXPECT_TRUE(fs::exists(out(piece["surface"])));
    EXPECT_TRUE(fs::exists(out(piece["crack"])));
    for (const auto& neighbour : piece["neighbours"]) {
      EXPECT_NEAR(neighbour["contact_area"].get<double>(), 1, 1e-12);
      EXPECT_NEAR(neighbour["normal"][0].get<double>(), neighbour["name"] < piece["name"] ? -1 : 1, 1e-12);
    }
  }
  ASSERT_EQ(json["bonds"].size(), 3u);
  const auto& bond = json["bonds"][1];
  EXPECT_EQ(bond["pieces"], (nlohmann::json{"piece_0002", "piece_0003"}));
  EXPECT_NEAR(bond["contact_area"].get<double>(), 1, 1e-12);
  const double centroid[] = {2.1, 0.5, 0.5}, normal[] = {1, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(bond["centroid"][i].get<double>(), centroid[i], 1e-12);
    EXPECT_NEAR(bond["normal"][i].get<double>(), normal[i], 1e-12);
  }
  EXPECT_NEAR(mass, 4 * 2400, 1e-9);
  EXPECT_EQ(json["pieces"][1]["neighbours"].size(), 2u);
  EXPECT_NEAR(json["pieces"][1]["inertia"][0][0].get<double>(), 2400.0 / 6, 1e-9);
  EXPECT_NEAR(json["pieces"][1]["centre_of_mass"][0].get<double>(), 1.6, 1e-12);
}

TEST_F(Export, WarnsOfWhatObjCannotHold) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  box.uvSets.push_back(box.uvSets.front());
  box.colorSets.push_back({"paint", std::vector<Vec4>(box.cornerCount(), Vec4(1, 0.5, 0.25, 1))});
  ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
  ASSERT_EQ(listener.warnings.size(), 1u);
  EXPECT_EQ(listener.warnings[0],
            "OBJ holds the first UV set only, and no colours: 1 more UV set and 1 colour set are left out; "
            "format ply keeps them");
  params.format = Params::Format::Ply;
  ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
  EXPECT_EQ(listener.warnings.size(), 1u);
  const std::string ply = slurp(out("piece_0001_surface.ply"));
  for (const char* line : {"property double x\n", "property double s1\n", "property double alpha\n",
                           "property int material_index\n", "comment material 0 paint\n"})
    EXPECT_NE(ply.find(line), std::string::npos) << line;
  EXPECT_FALSE(fs::exists(out("piece_0001_surface.obj")));
}

TEST_F(Export, WarnsOfNothingThatIsNotLost) {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(2, 1, 1));
  ASSERT_EQ(box.uvSets.size(), 1u);
  ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
  EXPECT_TRUE(listener.warnings.empty());
  TriMesh coloured = box;
  coloured.uvSets.clear();
  coloured.colorSets.push_back({"paint", std::vector<Vec4>(box.cornerCount(), Vec4(1, 0.5, 0.25, 1))});
  ASSERT_TRUE(run(test::slices(coloured, {1.1})).ok());
  box.uvSets.resize(3, box.uvSets.front());
  ASSERT_TRUE(run(test::slices(box, {1.1})).ok());
  EXPECT_EQ(listener.warnings,
            (std::vector<std::string>{
                "OBJ holds no colours: 1 colour set is left out; format ply keeps it",
                "OBJ holds the first UV set only: 2 more UV sets are left out; format ply keeps them"}));
}

TEST_F(Export, PlyHoldsWhatItsHeaderSays) {
  params.format = Params::Format::Ply;
  ASSERT_TRUE(run(test::slicedBox(2)).ok());
  const std::string ply = slurp(out("piece_0001_crack.ply"));
  const std::size_t body = ply.find("end_header\n") + 11;
  // A square section with a diagonal's crossings on each of its sides: 8 vertices of eight doubles,
  // 6 triangles.
  EXPECT_NE(ply.find("element vertex 8\n"), std::string::npos);
  EXPECT_NE(ply.find("element face 6\n"), std::string::npos);
  EXPECT_EQ(ply.size() - body, 8u * 8 * sizeof(double) + 6u * (1 + 3 * 4 + 4));
  double x = 0;
  std::memcpy(&x, ply.data() + body, sizeof x);
  EXPECT_EQ(x, 1.1);
}

TEST_F(Export, FlatAndSmoothNormalsOfAPlaneAreOne) {
  for (const auto kind : {CrackNormals::Flat, CrackNormals::Smooth}) {
    params.crackNormals = kind;
    ASSERT_TRUE(run(test::slicedBox(2)).ok());
    EXPECT_EQ(readObj(out("piece_0001_crack.obj")).normals, 1u);
  }
}

TEST_F(Export, SameBytesForAnyNumberOfThreads) {
  const Fragments f = test::slicedBox(9);
  std::map<std::string, std::string> files[2];
  for (int run = 0; run < 2; ++run) {
    params.directory = (root / ("threads" + std::to_string(run))).string();
    setThreadLimit(run + 1);
    inArena([&] { ASSERT_TRUE(this->run(f).ok()); });
    for (const std::string& name : namesIn(params.directory)) files[run][name] = slurp(out(name));
  }
  setThreadLimit(0);
  EXPECT_EQ(files[0].size(), 20u);
  EXPECT_EQ(files[0], files[1]);
}

TEST_F(Export, NodeWritesAndTellsOfItsFiles) {
  const NodeType type = exportCrackSurfaceNode();
  EXPECT_TRUE(type.writesFiles);
  ASSERT_NE(type.params.size(), 0u);
  EXPECT_TRUE(type.params[0].required);
  ParamValues values;
  for (const ParamInfo& info : type.params) values[info.name] = info.fallback;
  values["directory"] = params.directory;
  NodeIo io(listener.exec);
  io.setInput("pieces", Value::of<Fragments>(std::make_shared<const Fragments>(test::slicedBox(2))));
  ASSERT_TRUE(type.run(values, io).ok());
  EXPECT_EQ(*io.output("manifest").as<std::string>(), out("pieces.json").string());
  EXPECT_EQ(io.written().size(), 6u);
  for (const std::string& file : io.written()) EXPECT_TRUE(fs::exists(file));
}

}  // namespace
}  // namespace sherd
