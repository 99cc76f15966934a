#include "load_mesh/load_mesh.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/hash.h"
#include "base/parallel.h"
#include "geometry/solid.h"
#include "support/said.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

/// A folder of its own per test, and the few lines that write meshes into it.
class LoadMesh : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("sherd_load_mesh_" + std::to_string(::getpid()) + "_" + test->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }
  static std::string obj(const TriMesh& mesh) {
    std::string text;
    char line[120];
    for (const Vec3& p : mesh.positions) {
      std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
      text += line;
    }
    for (const Triangle& t : mesh.triangles) {
      std::snprintf(line, sizeof line, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
      text += line;
    }
    return text;
  }
  /// A cube all of whose corners have the one normal that `line` gives.
  static std::string cubeWithNormal(const std::string& line) {
    const TriMesh cube = families::boxSurface(Vec3::Zero(), Vec3::Ones(), 1, 1, 1);
    TriMesh points;
    points.positions = cube.positions;
    std::string text = obj(points) + line + "\n";
    char face[120];
    for (const Triangle& t : cube.triangles) {
      std::snprintf(face, sizeof face, "f %d//1 %d//1 %d//1\n", t[0] + 1, t[1] + 1, t[2] + 1);
      text += face;
    }
    return text;
  }
  Result<TriMesh> load(const std::string& file) { return loadMesh({.file = file}, said_.exec); }
  Result<TriMesh> loadObj(const TriMesh& mesh) { return load(write("a.obj", obj(mesh))); }
  Result<TriMesh> loadStrict(const TriMesh& mesh) {
    return loadMesh({.file = write("a.obj", obj(mesh)), .repair = RepairMode::Strict}, said_.exec);
  }
  /// The error's text; a test failure where there is none.
  static std::string refused(const Result<TriMesh>& mesh) {
    EXPECT_FALSE(mesh.ok());
    return mesh.ok() ? "" : mesh.error().text();
  }

  fs::path folder_;
  Said said_;
};

TriMesh box(const Vec3& low, const Vec3& high) { return families::boxSurface(low, high, 1, 1, 1); }
TriMesh cube(double low = 0, double high = 1) { return box(Vec3::Constant(low), Vec3::Constant(high)); }
bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(LoadMesh, KeepsTheDoublesOfTheFile) {
  const TriMesh given = box(Vec3(1000000.1234567, -1.0 / 3, 1e-17), Vec3(1000001.7654321, 2.0 / 3, 1));
  const auto mesh = loadObj(given);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_EQ(mesh->positions, given.positions);
  EXPECT_EQ(mesh->triangles, given.triangles);
  EXPECT_EQ(mesh->source, (folder_ / "a.obj").string());
  EXPECT_TRUE(said_.info("doesn't say which axis points up; taking y"));
  EXPECT_TRUE(said_.info("taking 1 m"));
}

TEST_F(LoadMesh, UnitAndUpEnterTheFrame) {
  const TriMesh given = box(Vec3::Zero(), Vec3(1, 2, 3));
  const std::string file = write("a.obj", obj(given));
  const auto mesh = loadMesh({.file = file, .up = UpAxis::Z, .unit = 0.01}, said_.exec);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  const Box bounds = boxOf(mesh->positions);
  EXPECT_TRUE(bounds.low.isApprox(Vec3(0, 0, -0.02)));
  EXPECT_TRUE(bounds.high.isApprox(Vec3(0.01, 0.03, 0)));
  for (std::size_t v = 0; v < given.positions.size(); ++v)
    EXPECT_TRUE(mesh->frame.toFile(mesh->positions[v]).isApprox(given.positions[v], 1e-15));
  EXPECT_TRUE(said_.lines.empty()) << said_.lines[0].second;
}

TEST_F(LoadMesh, LengthScalesTheLongestSide) {
  const std::string file = write("a.obj", obj(box(Vec3::Zero(), Vec3(1, 4, 3))));
  const auto mesh = loadMesh({.file = file, .up = UpAxis::Y, .length = 0.5}, said_.exec);
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->frame.metresPerUnit, 0.125);
  EXPECT_EQ(boxOf(mesh->positions).high, Vec3(0.125, 0.5, 0.375));
  EXPECT_TRUE(said_.lines.empty());
  ASSERT_TRUE(loadMesh({.file = file, .up = UpAxis::Y, .unit = 2, .length = 0.5}, said_.exec).ok());
  EXPECT_TRUE(said_.warning("`length` decides"));
}

TEST_F(LoadMesh, NormalsTurnAlong) {
  const auto mesh =
      loadMesh({.file = write("a.obj", cubeWithNormal("vn 0 0 1")), .up = UpAxis::Z}, said_.exec);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  ASSERT_EQ(mesh->normals.size(), mesh->cornerCount());
  EXPECT_EQ(mesh->normals[0], Vec3(0, 1, 0));
}

TEST_F(LoadMesh, ZeroNormalsBecomeTheTriangles) {
  const auto mesh = load(write("a.obj", cubeWithNormal("vn 0 0 0")));
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  for (std::size_t k = 0; k < mesh->cornerCount(); ++k) {
    const Triangle& t = mesh->triangles[k / 3];
    const auto p = [&](std::size_t c) { return mesh->positions[at(t[c])]; };
    EXPECT_NEAR(mesh->normals[k].dot((p(1) - p(0)).cross(p(2) - p(0))), 1, 1e-14);
  }
}

TEST_F(LoadMesh, FilesThatCannotBeRead) {
  EXPECT_TRUE(holds(refused(load((folder_ / "none.obj").string())), "none.obj: no such file"));
  EXPECT_TRUE(holds(refused(load(folder_.string())), "is a folder"));
  EXPECT_TRUE(holds(refused(load("/dev/null")), "is no regular file"));
  for (const char* name : {"empty.obj", "empty.ply", "empty.stl", "empty.off", "empty.glb"})
    EXPECT_TRUE(holds(refused(load(write(name, ""))), "is empty")) << name;
  EXPECT_EQ(load((folder_ / "none.obj").string()).error().port, "file");
}

TEST_F(LoadMesh, AnUnreadableFile) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const std::string file = write("a.obj", obj(cube()));
  fs::permissions(file, fs::perms::none);
  EXPECT_TRUE(holds(refused(load(file)), "can't be opened: Permission denied"));
}

TEST_F(LoadMesh, FilesThatAreNoMesh) {
  const std::string letter = "Dear all,\nthe vase is not ready yet.\n";
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off", "a.glb", "a.gltf", "a.fbx", "a.txt", "a"}) {
    const std::string text = refused(load(write(name, letter)));
    EXPECT_TRUE(holds(text, (folder_ / name).string())) << text;
  }
  EXPECT_TRUE(holds(refused(load(write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"))), "no faces"));
}

TEST_F(LoadMesh, NotFinite) {
  const std::string text = obj(cube());
  for (const std::string bad : {"nan", "inf", "-inf", "1e999"})
    EXPECT_FALSE(load(write("a.obj", "v 0 " + bad + " 0\n" + text)).ok()) << bad;
  const std::string file = write("b.obj", obj(cube(0, 1e300)));
  EXPECT_TRUE(holds(refused(loadMesh({.file = file, .unit = 1e200}, {})), "too large in metres"));
  EXPECT_TRUE(holds(refused(loadMesh({.file = file, .unit = -1}, {})), "unit is -1"));
  EXPECT_TRUE(holds(refused(loadMesh({.file = file, .length = std::nan("")}, {})), "length is nan"));
}

TEST_F(LoadMesh, LengthOfAPoint) {
  const std::string file = write("a.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(loadMesh({.file = file, .length = 1}, {}).error().port, "length");
  EXPECT_TRUE(holds(refused(loadMesh({.file = file}, {})), "no triangles")) << "all of them collapsed";
}

TEST_F(LoadMesh, WeldsAndSaysWhatIsLeftOut) {
  TriMesh mesh = cube();
  TriMesh seams;  // every triangle with vertices of its own
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) seams.positions.push_back(mesh.positions[at(v)]);
  for (Index k = 0; k < 36; k += 3) seams.triangles.push_back({k, k + 1, k + 2});
  seams.triangles.push_back({0, 1, 0});
  seams.positions.emplace_back(7, 7, 7);
  const auto loaded = loadObj(seams);
  ASSERT_TRUE(loaded.ok()) << loaded.error().text();
  EXPECT_EQ(loaded->positions.size(), 8u);
  EXPECT_EQ(loaded->triangles.size(), 12u);
  EXPECT_TRUE(said_.info("joined 28 vertices"));
  EXPECT_TRUE(said_.warning("left out 1 triangle with two corners in one place"));
  EXPECT_TRUE(said_.info("left out 1 vertex that no face uses"));
}

TEST_F(LoadMesh, TurnsWhatIsInsideOutAndSaysSo) {
  auto mesh = loadObj(families::reversed(cube()));
  ASSERT_TRUE(mesh.ok());
  EXPECT_DOUBLE_EQ(solidVolume(mesh->positions, mesh->triangles), 1);
  EXPECT_TRUE(said_.info("turned 1 part that was inside out"));
  mesh = loadObj(families::joined(cube(), families::reversed(cube(2, 3))));
  ASSERT_TRUE(mesh.ok());
  EXPECT_DOUBLE_EQ(solidVolume(mesh->positions, mesh->triangles), 2);
  mesh = loadObj(families::joined(cube(0, 2), cube(0.5, 1.5)));
  ASSERT_TRUE(mesh.ok());
  EXPECT_DOUBLE_EQ(solidVolume(mesh->positions, mesh->triangles), 8);
  EXPECT_TRUE(said_.info("left out 1 part within the solid that faced outward"));
  TriMesh mixed = cube();
  std::swap(mixed.triangles[4][0], mixed.triangles[4][1]);
  ASSERT_TRUE(loadObj(mixed).ok());
  EXPECT_TRUE(said_.info("turned 1 face that faced the other way"));
}

TEST_F(LoadMesh, StrictRefusesWithCountPlaceAndRemedy) {
  TriMesh open = cube();
  open.triangles.pop_back();
  EXPECT_TRUE(holds(refused(loadStrict(open)), "3 open edges (the first near ("));
  EXPECT_TRUE(holds(refused(loadStrict(open)), "fill the holes"));
  EXPECT_TRUE(holds(refused(loadStrict(families::joined(cube(), cube(0.5, 2)))), "intersecting triangles"));
  EXPECT_TRUE(holds(refused(loadStrict(families::joined(cube(), box(Vec3(1, 1, 0), Vec3(2, 2, 1))))),
                    "1 edge with more than two triangles near (1, 1, 0.5)"));
  EXPECT_TRUE(holds(refused(loadStrict(families::joined(cube(), cube(1, 2)))),
                    "1 vertex where separate parts touch near (1, 1, 1)"));
  TriMesh twice = cube();
  twice.triangles.push_back(twice.triangles[3]);
  EXPECT_TRUE(holds(refused(loadStrict(twice)), "1 duplicate triangle near ("));
  TriMesh flat = cube();
  for (Vec3& p : flat.positions) p.y() = 0.5;
  EXPECT_FALSE(loadStrict(flat).ok());
  EXPECT_TRUE(holds(refused(loadStrict(families::reversed(cube()))), "1 part turned inside out"));
}

TEST_F(LoadMesh, MendsWhatIsBrokenAndSaysSo) {
  TriMesh open = cube();
  open.triangles.pop_back();
  auto mesh = loadObj(open);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_DOUBLE_EQ(solidVolume(mesh->positions, mesh->triangles), 1);
  EXPECT_TRUE(said_.warning("filled 1 large hole"));
  mesh = loadObj(families::joined(cube(), cube(0.5, 2)));
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_DOUBLE_EQ(solidVolume(mesh->positions, mesh->triangles), 1 + 3.375 - 0.125);
  EXPECT_TRUE(said_.info("into one outer surface"));
}

TEST_F(LoadMesh, PlacesAreThoseOfTheFile) {
  const std::string file = write("a.obj", obj(families::joined(cube(), cube(1, 2))));
  const std::string text =
      refused(loadMesh({.file = file, .up = UpAxis::Z, .length = 10, .repair = RepairMode::Strict}, {}));
  EXPECT_TRUE(holds(text, "touch near (1, 1, 1)")) << text;
}

TEST_F(LoadMesh, CancelledIsCancelled) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  EXPECT_EQ(loadMesh({.file = write("a.obj", obj(cube()))}, exec).error().kind, Error::Kind::Cancelled);
}

TEST_F(LoadMesh, SameBitsForAnyThreadCount) {
  const std::string file = write("a.obj", obj(families::reversed(families::torusSurface(2, 0.7, 60, 40))));
  const auto digest = [&] {
    Hasher hasher;
    hashValue(hasher, *load(file));
    return hasher.digest();
  };
  const int limit = threadLimit();
  setThreadLimit(1);
  const Digest one = digest();
  setThreadLimit(2);
  EXPECT_EQ(one, digest());
  setThreadLimit(limit);
}

}  // namespace
}  // namespace sherd
