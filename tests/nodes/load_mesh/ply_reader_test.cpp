#include <algorithm>
#include <bit>
#include <cstring>

#include "reader_checks.h"

namespace sherd {
namespace {

using test::expectError;

/// A PLY file in any of the three formats, value by value.
class PlyWriter {
 public:
  PlyWriter(const std::string& format, const std::string& header)
      : ascii_(format == "ascii"),
        big_(format == "binary_big_endian"),
        text_("ply\nformat " + format + " 1.0\ncomment by hand\n" + header + "end_header\n") {}

  template <class T>
  PlyWriter& add(T value) {
    if (ascii_) {
      text_ += test::exactly(static_cast<double>(value)) + "\n";
      return *this;
    }
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big_ != (std::endian::native == std::endian::big)) std::reverse(bytes, bytes + sizeof value);
    text_.append(bytes, sizeof value);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  bool ascii_, big_;
  std::string text_;
};

const char* const kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

/// A square with everything: attributes, an element and properties that nobody knows, faces of four and three
/// corners.
std::string everything(const std::string& format) {
  PlyWriter ply(format,
                "element vertex 4\nproperty double x\nproperty float64 y\nproperty int z\nproperty float nx\n"
                "property float ny\nproperty float nz\nproperty list uchar short tags\nproperty float "
                "s\nproperty float t\n"
                "property uchar red\nproperty uint8 green\nproperty uchar blue\nproperty ushort alpha\n"
                "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
                "element face 2\nproperty char flag\nproperty list uchar uint vertex_indices\n"
                "element nothing 4000000000\n");
  for (int i = 0; i < 4; ++i) {
    const double x = i == 1 || i == 2 ? 1000000.1234567 : 0, y = i >= 2 ? 1 / 3.0 : 0;
    ply.add(x).add(y).add(std::int32_t{-7}).add(0.f).add(0.f).add(2.f);
    ply.add(std::uint8_t{1}).add(std::int16_t{-3}).add(0.25f * static_cast<float>(i)).add(0.5f);
    ply.add(std::uint8_t{255}).add(std::uint8_t{0}).add(std::uint8_t{51}).add(std::uint16_t{65535});
  }
  ply.add(std::int32_t{0}).add(std::int32_t{1});
  ply.add(std::int8_t{1}).add(std::uint8_t{4});
  for (std::uint32_t v : {0u, 1u, 2u, 3u}) ply.add(v);
  ply.add(std::int8_t{-1}).add(std::uint8_t{3});
  for (std::uint32_t v : {2u, 1u, 0u}) ply.add(v);
  return ply.text();
}

TEST(PlyReader, Everything) {
  for (const char* format : kFormats) {
    const auto file = readPly(everything(format));
    ASSERT_TRUE(file.ok()) << format << ": " << file.error().text();
    test::expectConsistent(*file);
    const TriMesh& m = file->mesh;
    EXPECT_EQ(m.positions[2], Vec3(1000000.1234567, 1 / 3.0, -7));
    EXPECT_EQ(m.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}}));
    EXPECT_EQ(m.normals[4], Vec3(0, 0, 1));
    EXPECT_EQ(m.uvSets[0].uv[5], Vec2(0.75, 0.5));
    EXPECT_EQ(m.colorSets[0].rgba[3], Vec4(1, 0, 0.2, 1));
  }
}

TEST(PlyReader, KeepsDoubles) {
  const auto points = test::awkwardPoints();
  for (const char* format : kFormats) {
    // Faces first: the order of elements is free.
    PlyWriter ply(
        format,
        "element face 1\nproperty list int int vertex_index\nelement vertex 300\nproperty double x\n"
        "property double y\nproperty double z\n");
    ply.add(std::int32_t{3}).add(std::int32_t{0}).add(std::int32_t{1}).add(std::int32_t{299});
    for (const Vec3& p : points) ply.add(p.x()).add(p.y()).add(p.z());
    const auto file = readPly(ply.text());
    ASSERT_TRUE(file.ok()) << format << ": " << file.error().text();
    EXPECT_EQ(file->mesh.positions, points) << format;
    EXPECT_EQ(file->mesh.triangles[0], (Triangle{0, 1, 299}));
  }
}

TEST(PlyReader, TextureCoordinatesPerCorner) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float "
      "z\r\n"
      "element face 2\r\nproperty list uchar int vertex_indices\r\nproperty list uchar float "
      "texcoord\r\nend_header\r\n"
      "0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2 6 0 0.5 1 0.25 0 1\r\n3 2 1 0 0\r\n";
  const auto file = readPly(text);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->mesh.uvSets[0].uv[1], Vec2(1, 0.25));
  EXPECT_EQ(file->mesh.uvSets[0].uv[4], Vec2(0, 0));
  std::string wrong = text;
  wrong.replace(wrong.find("6 0 0.5 1 0.25"), 14, "4 0 0.5 1 0.25");
  expectError(readPly(wrong), "more or fewer texture coordinates than corners");
}

TEST(PlyReader, HeaderErrors) {
  const std::string start = "ply\nformat ascii 1.0\n", end = "end_header\n";
  const std::string xyz = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  expectError(readPly(""), "line 1: this is no PLY file");
  expectError(readPly("plywood\n"), "line 1: this is no PLY file; the first line of one is 'ply';");
  expectError(readPly(start), "the header has no end_header");
  expectError(readPly("ply\nend_header\n"), "line 2: the header has no format");
  expectError(readPly("ply\nformat binary 1.0\n"), "line 2: unknown PLY format 'binary'");
  expectError(readPly("ply\nformat ascii 2.0\n"), "unknown PLY version '2.0'");
  expectError(readPly(start + "rubbish\n"), "line 3: 'rubbish' is no PLY header line");
  expectError(readPly(start + "element vertex -1\n"), "line 3: an element without a name or a count");
  expectError(readPly(start + "property float x\n"), "line 3: a property before the first element");
  expectError(readPly(start + "element vertex 3\nproperty quad x\n"), "line 4: unknown PLY type 'quad'");
  expectError(readPly(start + "element vertex 3\nproperty float\n"), "line 4: a property without a name");
  expectError(readPly(start + "element face 3\nproperty list float int i\n"),
              "line 4: a list counted by real numbers");
  expectError(readPly(start + faces + end), "no element 'vertex'");
  expectError(readPly(start + xyz + end), "no element 'face'");
  expectError(readPly(start + "element vertex 3\nproperty float x\n" + faces + end), "lack x, y or z");
  expectError(readPly(start + xyz + "element face 1\nproperty int i\n" + end),
              "lack the list vertex_indices");
}

TEST(PlyReader, BodyErrors) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_TRUE(readPly(header + points + "3 0 1 2").ok());
  expectError(readPly(header + "0 0 0\n1 x 0\n"), "line 11: 'x' is not a number; a number such as 1.5");
  expectError(readPly(header + points), "the file ends too early");
  expectError(readPly(header + points + "3 0 1"), "line 13: the file ends too early");
  expectError(readPly(header + points + "3 0 1 3"), "line 13: a face names a vertex that does not exist");
  expectError(readPly(header + points + "3 0 1 -1"), "does not exist");
  expectError(readPly(header + points + "3 0 1 1.5"), "does not exist");
  expectError(readPly(header + points + "2 0 1"), "line 13: a face with 2 corners");
  expectError(readPly(header + points + "-3 0 1 2"), "cannot have that many entries");
  PlyWriter cut("binary_little_endian",
                "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uint int vertex_indices\n");
  const std::size_t size = cut.text().size() + 8;
  expectError(readPly(cut.add(1.f).add(2.f).text()),
              "byte " + std::to_string(size) + ": the file ends too early");
}

TEST(PlyReader, EndsWhenCancelled) {
  for (const char* format : kFormats) test::expectEndsWhenCancelled(readPly, everything(format));
}

TEST(PlyReader, DamagedFiles) {
  for (const char* format : kFormats) test::expectNoCrashOnDamage(readPly, everything(format));
}

}  // namespace
}  // namespace sherd
