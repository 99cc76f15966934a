#include <bit>

#include "reader_checks.h"

namespace sherd {
namespace {

using test::expectError;

std::string asciiFacet(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::string text = "  facet normal 0 0 0\n    outer loop\n";
  for (const Vec3& p : {a, b, c}) {
    text += "      vertex " + test::exactly(p.x()) + " " + test::exactly(p.y()) + " " + test::exactly(p.z()) +
            "\n";
  }
  return text + "    endloop\n  endfacet\n";
}

std::string littleEndian(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 255);
  return bytes;
}

std::string binary(const std::vector<Vec3>& points, std::string header = "") {
  header.resize(80, ' ');
  std::string bytes = header + littleEndian(static_cast<std::uint32_t>(points.size() / 3));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 3 == 0) bytes += std::string(12, '\0');
    for (double x : points[i]) bytes += littleEndian(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    if (i % 3 == 2) bytes += std::string(2, '\0');
  }
  return bytes;
}

const std::vector<Vec3> kFour{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0, 0}, {0, -2, 0}};

TEST(StlReader, AsciiKeepsDoubles) {
  const auto points = test::awkwardPoints();
  std::string text = "solid a name\n";
  for (std::size_t i = 0; i < points.size(); i += 3)
    text += asciiFacet(points[i], points[i + 1], points[i + 2]);
  const auto file = readStl(text + "endsolid a name\n");
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->mesh.positions, points);
  EXPECT_EQ(file->mesh.triangles.size(), points.size() / 3);
  EXPECT_EQ(file->mesh.triangles[1], (Triangle{3, 4, 5}));
}

TEST(StlReader, AsciiWithSeveralSolidsAndCapitals) {
  const std::string solid = "solid\n" + asciiFacet(kFour[0], kFour[1], kFour[2]) + "endsolid\n";
  ASSERT_TRUE(readStl(solid + solid).ok());
  EXPECT_EQ(readStl(solid + solid)->mesh.triangles.size(), 2u);
  std::string capitals = solid;
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  EXPECT_TRUE(readStl(capitals).ok());
}

TEST(StlReader, Binary) {
  for (const char* header : {"", "solid that is none"}) {
    const auto file = readStl(binary(kFour, header));
    ASSERT_TRUE(file.ok()) << file.error().text();
    EXPECT_EQ(file->mesh.positions, kFour);
    EXPECT_EQ(file->mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  }
}

TEST(StlReader, Errors) {
  const std::string facet = asciiFacet(kFour[0], kFour[1], kFour[2]);
  expectError(readStl(""), "an STL file of 0 bytes");
  expectError(readStl(binary({})), "no triangles");
  expectError(readStl("solid\nendsolid\n"), "no triangles");
  expectError(readStl(binary(kFour) + "x"),
              "byte 80: a binary STL file with 2 triangles has 184 bytes, this one has 185");
  expectError(readStl("solid\n" + facet), "line 9: the file ends here; expected facet or endsolid");
  expectError(readStl("solid\n  facet normal 0 0 x\n"),
              "line 2: 'x' is not what STL has here; expected a number");
  expectError(readStl("solid\n  facet normal 0 0 0\n  outer hoop\n"), "line 3: 'hoop'");
  expectError(readStl("solid\n" + facet + "endsolid\nrubbish\n"), "line 10: 'rubbish'");
}

TEST(StlReader, EndsWhenCancelled) {
  test::expectEndsWhenCancelled(readStl,
                                "solid x\n" + asciiFacet(kFour[0], kFour[1], kFour[2]) + "endsolid x\n");
}

TEST(StlReader, DamagedFiles) {
  test::expectNoCrashOnDamage(readStl,
                              "solid x\n" + asciiFacet(kFour[0], kFour[1], kFour[2]) + "endsolid x\n");
  test::expectNoCrashOnDamage(readStl, binary(kFour));
}

}  // namespace
}  // namespace sherd
