#include <cmath>
#include <fstream>
#include <iterator>

#include "reader_checks.h"

namespace sherd {
namespace {

using test::expectError;

const char* kFull =
    "# a comment\nmtllib x.mtl\no thing\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0.5 0.5 0.5\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\nvn 0 0 1\ng a b\ns off\nusemtl two words\n"
    "f 1/1/1 2/2/1 3/3/2\nusemtl other # one\nf -4/-4/-2 -2/-2/-1 -1/-1/-1\n";

TEST(ObjReader, KeepsDoubles) {
  std::string text;
  const auto points = test::awkwardPoints();
  for (const Vec3& p : points) {
    text += "v " + test::exactly(p.x()) + " " + test::exactly(p.y()) + " " + test::exactly(p.z()) + "\n";
  }
  const auto file = readObj(text + "f 1 2 3\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->mesh.positions, points);
  EXPECT_FALSE(file->metresPerUnit || file->up);
}

TEST(ObjReader, AttributesPerCorner) {
  const auto file = readObj(kFull);
  ASSERT_TRUE(file.ok()) << file.error().text();
  test::expectConsistent(*file);
  const TriMesh& m = file->mesh;
  EXPECT_EQ(m.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(m.uvSets.size(), 1u);
  EXPECT_EQ(m.uvSets[0].uv[2], Vec2(1, 1));
  EXPECT_EQ(m.uvSets[0].uv[5], Vec2(0, 1));
  for (const Vec3& n : m.normals) EXPECT_EQ(n, Vec3(0, 0, 1));
  ASSERT_EQ(m.colorSets.size(), 1u);
  EXPECT_EQ(m.colorSets[0].rgba[1], Vec4(0, 1, 0, 1));
  EXPECT_EQ(m.materials, (std::vector<std::string>{"two words", "other # one"}));
  EXPECT_EQ(m.materialOf, (std::vector<Index>{0, 1}));
}

TEST(ObjReader, CornersWithoutAnAttribute) {
  const auto file =
      readObj("v 0 0 0\nv 2 0 0\nv 0 2 0\nvt 0.5 0.5\nvn 1 0 0\nf 1/1/1 2//1 3\nusemtl m\nf 1 3 2\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  const TriMesh& m = file->mesh;
  EXPECT_EQ(m.uvSets[0].uv[0], Vec2(0.5, 0.5));
  EXPECT_EQ(m.uvSets[0].uv[1], Vec2(0, 0));
  EXPECT_EQ(m.normals[1], Vec3(1, 0, 0));
  EXPECT_EQ(m.normals[2], Vec3(0, 0, 1));
  EXPECT_EQ(m.normals[3], Vec3(0, 0, -1));
  EXPECT_EQ(m.materials, (std::vector<std::string>{"m", ""}));
  EXPECT_EQ(m.materialOf, (std::vector<Index>{1, 0}));
}

TEST(ObjReader, LineEndsAndJoins) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const std::string e = end;
    const auto file = readObj("\xEF\xBB\xBFv 0 0 0" + e + "v\t1 0 0 " + e + e + "v 0 \\" + e + " 1 0" + e +
                              "f 1 2 \\" + e + "3");
    ASSERT_TRUE(file.ok()) << file.error().text();
    EXPECT_EQ(file->mesh.positions[2], Vec3(0, 1, 0));
    expectError(readObj("v 0 0 0" + e + "v \\" + e + "1 0 0" + e + "v 1 x 0" + e),
                "line 4: 'x' is not a number");
  }
}

TEST(ObjReader, NamesNanAndInfinity) {
  const auto file = readObj("v nan inf -inf\nv 1e999 -1e999 1e-999\nv +1 NaN Infinity\nf 1 2 3\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  const auto& p = file->mesh.positions;
  EXPECT_TRUE(std::isnan(p[0].x()) && std::isnan(p[2].y()));
  EXPECT_TRUE(std::isinf(p[0].y()) && std::isinf(p[1].x()) && std::isinf(p[1].y()) && std::isinf(p[2].z()));
  EXPECT_EQ(p[1].z(), 0);
  EXPECT_EQ(p[2].x(), 1);
}

TEST(ObjReader, FacesBeforeTheirVertices) {
  const auto file = readObj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  expectError(readObj("# x\nf 1 2 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
              "line 2: there is no vertex 4, the file has 3");
}

TEST(ObjReader, Errors) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expectError(readObj(""), "no faces");
  expectError(readObj(three), "no faces (3 vertices)");
  expectError(readObj("v 1 2\n"), "line 1: 'v' has 2 numbers where 3 are needed");
  expectError(readObj("v 1 2 3 4 5\n"), "line 1: 'v' has 5 numbers");
  expectError(readObj("v 1 2 3 4 5 6 7 8\n"), "line 1: more than 7 numbers");
  expectError(readObj("vn 1 2\n"), "line 1: 'vn' has 2 numbers");
  expectError(readObj("vt\n"), "line 1: 'vt' has 0 numbers");
  expectError(readObj("v 1 2 3x\n"),
              "line 1: '3x' is not a number; a number such as 1.5 or 2e-3 is expected");
  expectError(readObj(three + "f 1 2\n"), "line 4: a face with 2 corners");
  expectError(readObj(three + "f 0 1 2\n"), "numbers start at 1");
  expectError(readObj(three + "f 1 2 -4\n"), "line 4: there is no vertex -4");
  expectError(readObj(three + "f 1 2 99999999999\n"), "line 4: there is no vertex 99999999999");
  expectError(readObj(three + "f 1/1 2/1 3/1\n"), "line 4: there is no texture vertex 1, the file has 0");
  expectError(readObj(three + "f 1//1 2//1 3//1\n"), "line 4: there is no vertex normal 1");
  expectError(readObj(three + "f a b c\n"), "line 4: 'a' is no corner of a face");
  expectError(readObj(three + "surf 0 1 0 1 1 2 3\n"), "line 4: free-form geometry");
  expectError(readObj("\x7f"
                      "ELF\x01\x02 x\n"),
              "line 1: '?ELF?"
              "?' is no OBJ statement");
}

TEST(ObjReader, EndsWhenCancelled) { test::expectEndsWhenCancelled(readObj, kFull); }

TEST(ObjReader, DamagedFiles) { test::expectNoCrashOnDamage(readObj, kFull); }

TEST(ObjReader, SharedModel) {
  std::ifstream in(SHERD_SOURCE_DIR "/../shared/meshes/spot.obj", std::ios::binary);
  if (!in) GTEST_SKIP() << "the shared meshes are not here";
  const auto file = readObj(std::string(std::istreambuf_iterator<char>(in), {}));
  ASSERT_TRUE(file.ok()) << file.error().text();
  test::expectConsistent(*file);
  EXPECT_EQ(file->mesh.positions.size(), 2930u);
  EXPECT_EQ(file->mesh.triangles.size(), 5856u);
  EXPECT_EQ(file->mesh.uvSets.size(), 1u);
}

}  // namespace
}  // namespace sherd
