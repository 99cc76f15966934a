#include "reader_checks.h"

namespace sherd {
namespace {

using test::expectError;

TEST(OffReader, KeepsDoubles) {
  const auto points = test::awkwardPoints();
  std::string text = "OFF\n" + std::to_string(points.size()) + " 1 0\n";
  for (const Vec3& p : points) {
    text += test::exactly(p.x()) + " " + test::exactly(p.y()) + " " + test::exactly(p.z()) + "\n";
  }
  const auto file = readOff(text + "3 0 1 2\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->mesh.positions, points);
}

TEST(OffReader, CommentsPolygonsAndFaceColours) {
  const auto file = readOff(
      "# made by hand\r\nOFF 5 2 # no edges\r\n\r\n0 0 0\r\n1 0 0 # second\r\n1 1 0\r\n0 1 0\r\n\r\n"
      "0.5 0.5 0\r\n4 0 1 2 3 255 0 0\r\n5 0 1 4 2 3\r\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->mesh.triangles.size(), 5u);
  EXPECT_NEAR(test::areaOf(file->mesh), 1.75, 1e-15);
  EXPECT_TRUE(file->mesh.colorSets.empty() && file->mesh.normals.empty() && file->mesh.uvSets.empty());
}

TEST(OffReader, Attributes) {
  const auto file = readOff(
      "STCNOFF\n3 1 0\n0 0 0 0 0 2 255 0 51 255 0 1\n1 0 0 0 0 1 0 0 0 0 1 1\n0 1 0 1 0 0 0 0 0 0.25 0.5\n3 "
      "0 1 2\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  test::expectConsistent(*file);
  const TriMesh& m = file->mesh;
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(m.colorSets[0].rgba[0], Vec4(1, 0, 0.2, 1));
  EXPECT_EQ(m.colorSets[0].rgba[1][3], 0);
  EXPECT_EQ(m.colorSets[0].rgba[2][3], 1);  // none given
  EXPECT_EQ(m.uvSets[0].uv[0], Vec2(0, 1));
  EXPECT_EQ(m.uvSets[0].uv[2], Vec2(0.25, 0.5));
}

TEST(OffReader, RealColours) {
  const auto file = readOff("COFF\n3 1 0\n0 0 0 1 0.5 0 0.25\n1 0 0 0 0 0 1\n0 1 0 0 0 0 1\n3 0 1 2\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->mesh.colorSets[0].rgba[0], Vec4(1, 0.5, 0, 0.25));
}

TEST(OffReader, Errors) {
  const std::string three = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  expectError(readOff(""), "line 1: this is no OFF file");
  expectError(readOff("solid\n"), "line 1: this is no OFF file; one starts with OFF, COFF, NOFF or CNOFF;");
  expectError(readOff("4OFF\n"), "not three-dimensional");
  expectError(readOff("OFF BINARY\n"), "binary OFF is not read");
  expectError(readOff("OFF\nx 1 0\n"), "line 2: 'x' is no number of vertices");
  expectError(readOff("OFF\n3\n"), "the file ends here");
  expectError(readOff("OFF\n-3 1 0\n"), "line 2: '-3' is no number of vertices");
  expectError(readOff("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), "no faces");
  expectError(readOff("OFF\n3 1 0\n0 0 0\n1 0\n"), "line 4: the file or the line ends within a vertex");
  expectError(readOff("OFF\n3 1 0\n0 0 y\n"), "line 3: 'y' is not a number; a number such as 1.5");
  expectError(readOff(three), "ends within the faces");
  expectError(readOff(three + "3 0 1\n"), "line 6: the file or the line ends within a face");
  expectError(readOff(three + "3 0 1 3\n"), "line 6: there is no vertex 3");
  expectError(readOff(three + "2 0 1\n"), "line 6: a face with 2 corners");
  expectError(readOff("OFF\n2000000000 2000000000 0\n0 0 0\n"), "the file or the line ends");
}

TEST(OffReader, EndsWhenCancelled) {
  test::expectEndsWhenCancelled(readOff, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
}

TEST(OffReader, DamagedFiles) {
  test::expectNoCrashOnDamage(
      readOff, "CNOFF\n3 1 0\n0 0 0 0 0 2 255 0 51 255\n1 0 0 0 0 1 0 0 0 0\n0 1 0 1 0 0 0 0 0\n3 0 1 2 9\n");
}

}  // namespace
}  // namespace sherd
