#include "export/export_crack_surface.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/parallel.h"
#include "graph/node_type.h"
#include "support/fragment_families.h"

namespace sherd {

NodeType exportCrackSurfaceNode();

namespace {

namespace fs = std::filesystem;
using Params = ExportCrackSurfaceParams;

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void spill(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// What a run says to the user.
struct Listener {
  std::vector<std::string> infos, warnings;
  Exec exec;
  Listener() {
    exec.onMessage = [this](LogLevel level, const std::string& line) {
      (level == LogLevel::Info ? infos : warnings).push_back(line);
    };
  }
};

using Coordinates = std::array<double, 3>;

/// What the tests look at of an OBJ file.
struct Obj {
  std::vector<Coordinates> positions;
  std::vector<std::array<std::size_t, 3>> faces;
  std::vector<std::string> groups, materials;
  std::size_t normals = 0, uvs = 0;
};

Obj readObj(const fs::path& path) {
  Obj obj;
  std::ifstream in(path);
  for (std::string line, key; std::getline(in, line);) {
    std::istringstream words(line);
    words >> key;
    if (key == "v") {
      Coordinates p{};
      words >> p[0] >> p[1] >> p[2];
      obj.positions.push_back(p);
    } else if (key == "f") {
      std::array<std::size_t, 3> face{};
      for (auto& corner : face) {
        std::string word;
        words >> word;
        corner = std::stoul(word) - 1;
      }
      obj.faces.push_back(face);
    } else if (key == "g" || key == "usemtl") {
      std::string name;
      words >> name;
      (key == "g" ? obj.groups : obj.materials).push_back(name);
    }
    obj.normals += key == "vn";
    obj.uvs += key == "vt";
  }
  return obj;
}

std::set<std::string> namesIn(const fs::path& directory) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory)) names.insert(entry.path().filename().string());
  return names;
}

class Export : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    root = fs::temp_directory_path() / ("sherd_export_" + std::to_string(::getpid()) + "_" + info->name());
    fs::remove_all(root);
    fs::create_directories(root);
    params.directory = (root / "out").string();
  }
  void TearDown() override { fs::remove_all(root); }

  fs::path out(const std::string& name) const { return fs::path(params.directory) / name; }
  Result<ExportReport> run(const Fragments& f) { return exportCrackSurface(f, params, listener.exec); }

  fs::path root;
  Params params;
  Listener listener;
};

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

TEST_F(Export, TwelveAfterSixtySevenLeavesTwelveAndForeignFilesAlone) {
  ASSERT_TRUE(run(test::slicedBox(67)).ok());
  spill(out("notes.txt"), "mine");
  spill(out("piece_0070_surface.obj"), "mine too");
  const auto result = run(test::slicedBox(12));
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->removed, 2u * 55);
  EXPECT_EQ(namesIn(params.directory).size(), 2u * 12 + 2 + 2);
  EXPECT_EQ(slurp(out("notes.txt")), "mine");
  EXPECT_EQ(slurp(out("piece_0070_surface.obj")), "mine too");
}

TEST_F(Export, SecondRunTouchesNothingAndMendsWhatWasChanged) {
  const Fragments f = test::slicedBox(3);
  const auto first = run(f);
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(first->written, 7u);
  EXPECT_EQ(first->files.size(), 8u);
  const std::string whole = slurp(out("piece_0002_crack.obj"));
  const auto time = fs::last_write_time(out("sherd_manifest.json"));
  const auto second = run(f);
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(second->written, 0u);
  EXPECT_EQ(second->kept, 7u);
  EXPECT_EQ(fs::last_write_time(out("sherd_manifest.json")), time);
  spill(out("piece_0002_crack.obj"), whole.substr(0, whole.size() - 1) + "x");
  fs::remove(out("piece_0001_surface.obj"));
  const auto third = run(f);
  ASSERT_TRUE(third.ok());
  EXPECT_EQ(third->written, 3u);  // the two, and the description that was withdrawn before them
  EXPECT_EQ(slurp(out("piece_0002_crack.obj")), whole);
}

TEST_F(Export, ALonelyCrackTriangleIsAnErrorBeforeAnythingIsWritten) {
  Fragments f = test::slicedBox(2);
  std::swap(f.pieces[0].crack[0][0], f.pieces[0].crack[0][1]);
  const auto result = run(f);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "pieces");
  EXPECT_FALSE(fs::exists(params.directory));
}

TEST_F(Export, RefusesForeignFileUnderOurNameBeforeWriting) {
  fs::create_directories(params.directory);
  spill(out("piece_0002_crack.obj"), "a stranger's");
  const auto result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("piece_0002_crack.obj"), std::string::npos);
  EXPECT_EQ(result.error().port, "directory");
  EXPECT_EQ(namesIn(params.directory), std::set<std::string>{"piece_0002_crack.obj"});
}

TEST_F(Export, KilledRunIsCleanedUp) {
  ASSERT_TRUE(run(test::slicedBox(5)).ok());
  // A run of more pieces that was killed while it wrote piece 6: claimed, partly there.
  auto manifest = nlohmann::json::parse(slurp(out("sherd_manifest.json")));
  manifest["files"]["piece_0006_surface.obj"] = "";
  manifest["files"]["piece_0007_surface.obj"] = "";
  spill(out("sherd_manifest.json"), manifest.dump());
  spill(out("piece_0006_surface.obj"), "v 0 0 0");
  spill(out("piece_0007_surface.obj.0123456789abcdef.partial"), "v 0");
  ASSERT_TRUE(run(test::slicedBox(2)).ok());
  EXPECT_EQ(namesIn(params.directory).size(), 2u * 2 + 2);
}

TEST_F(Export, HostileManifestRemovesNothingOfOthers) {
  fs::create_directories(params.directory);
  spill(root / "precious.txt", "precious");
  spill(root / "piece_0009_surface.obj", "precious");
  spill(out("scene.blend"), "precious");
  spill(
      out("sherd_manifest.json"),
      R"({"files": {"../precious.txt": "", "../piece_0009_surface.obj": "", "scene.blend": "", "..": "", "": 3}})");
  ASSERT_TRUE(run(test::slicedBox(2)).ok());
  EXPECT_EQ(slurp(root / "precious.txt"), "precious");
  EXPECT_EQ(slurp(root / "piece_0009_surface.obj"), "precious");
  EXPECT_EQ(slurp(out("scene.blend")), "precious");
}

TEST_F(Export, DamagedManifestIsAnError) {
  fs::create_directories(params.directory);
  for (const char* text : {"", "{", "[]", "{\"files\": 3}", "\xff\xfe"}) {
    spill(out("sherd_manifest.json"), text);
    const auto result = run(test::slicedBox(2));
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().what.find("sherd_manifest.json"), std::string::npos);
  }
}

TEST_F(Export, DirectoryThatCannotBe) {
  spill(root / "file", "");
  params.directory = (root / "file").string();
  auto result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("is a file, not a directory"), std::string::npos);
  EXPECT_EQ(result.error().port, "directory");
  params.directory = (root / "file" / "below").string();
  result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("cannot create the directory"), std::string::npos);
  EXPECT_EQ(result.error().port, "directory");
  params.directory = "/proc/sherd";
  EXPECT_FALSE(run(test::slicedBox(2)).ok());
}

TEST_F(Export, FailedWriteLeavesNoStrayFile) {
  // No file may grow beyond the limit: what a full disk does, without one. The manifest of the names still
  // fits.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{700, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const auto result = run(test::slicedBox(2));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().what.find("cannot write '" + params.directory), std::string::npos)
      << result.error().what;
  EXPECT_EQ(result.error().port, "directory");
  EXPECT_FALSE(result.error().remedy.empty());
  for (const std::string& name : namesIn(params.directory))
    EXPECT_EQ(name.find(".partial"), std::string::npos);
  EXPECT_TRUE(run(test::slicedBox(2)).ok());
}

TEST_F(Export, CancelledRunLeavesNoPieces) {
  CancelToken token;
  token.cancel();
  listener.exec.cancel = &token;
  const auto result = run(test::slicedBox(2));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, Error::Kind::Cancelled);
  EXPECT_FALSE(fs::exists(params.directory));
}

/// New pieces never stand beside the description of old ones.
TEST_F(Export, CancelledMidwayLeavesNoDescription) {
  ASSERT_TRUE(run(test::slicedBox(3)).ok());
  CancelToken token;
  listener.exec.cancel = &token;
  listener.exec.onProgress = [&](double share) {
    if (share >= 0.5) token.cancel();  // beyond the three old pieces' names
  };
  auto result = run(test::slicedBox(9));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, Error::Kind::Cancelled);
  EXPECT_EQ(result.error().port, "");
  EXPECT_FALSE(fs::exists(out("pieces.json")));
  EXPECT_TRUE(fs::exists(out("piece_0001_surface.obj")));
  listener.exec.cancel = nullptr;
  ASSERT_TRUE(run(test::slicedBox(9)).ok());
  EXPECT_EQ(nlohmann::json::parse(slurp(out("pieces.json")))["piece_count"], 9);
}

TEST_F(Export, FailedMidwayLeavesNoDescription) {
  ASSERT_TRUE(run(test::slicedBox(3)).ok());
  fs::remove(out("piece_0002_surface.obj"));
  fs::create_directories(out("piece_0002_surface.obj") / "in the way");
  const auto result = run(test::slicedBox(4));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().port, "directory");
  EXPECT_FALSE(result.error().remedy.empty());
  EXPECT_FALSE(fs::exists(out("pieces.json")));
  fs::remove_all(out("piece_0002_surface.obj"));
  ASSERT_TRUE(run(test::slicedBox(4)).ok());
  EXPECT_EQ(nlohmann::json::parse(slurp(out("pieces.json")))["piece_count"], 4);
}

TEST_F(Export, CancelledWhereNothingChangesKeepsTheDescription) {
  ASSERT_TRUE(run(test::slicedBox(3)).ok());
  CancelToken token;
  listener.exec.cancel = &token;
  listener.exec.onProgress = [&](double) { token.cancel(); };
  ASSERT_FALSE(run(test::slicedBox(3)).ok());
  EXPECT_TRUE(fs::exists(out("pieces.json")));
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
