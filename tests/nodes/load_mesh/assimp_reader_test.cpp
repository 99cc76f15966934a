#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "reader_checks.h"

namespace sherd {
namespace {

using test::expectError;

/// A file of its own in the directory for temporary files, gone at the end.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& extension, const std::string& content) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("sherd_" + std::string(test->name()) + std::to_string(getpid()) + extension);
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

Result<FileMesh> readAs(const std::string& extension, const std::string& content) {
  return readWithAssimp(TemporaryFile(extension, content).path());
}

std::string base64(const std::string& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      value = value << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[value >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// Positions, normals (+z), texture coordinates and colours of one triangle, in that order.
std::string triangleBuffer() {
  const float values[] = {0, 0, 0, 1, 0, 0,     0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1,
                          0, 0, 1, 0, 0, 0.25f, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0.5f};
  return std::string(reinterpret_cast<const char*>(values), sizeof values);
}

/// The triangle under the node properties `node`, inside a node that is moved by (10, 0, 0).
std::string gltf(const std::string& node, const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"translation":[10,0,0],"children":[1]},{"mesh":0)" +
         node + R"(}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3},"material":0}]}],
"materials":[{"name":"clay"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":3,"componentType":5126,"count":3,"type":"VEC4"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},
{"buffer":0,"byteOffset":72,"byteLength":24},{"buffer":0,"byteOffset":96,"byteLength":48}],
"buffers":[{"byteLength":144)" +
         uri + "}]}";
}

std::string gltf(const std::string& node) {
  return gltf(node, ",\"uri\":\"data:application/octet-stream;base64," + base64(triangleBuffer()) + "\"");
}

std::string glb(const std::string& node) {
  const auto word = [](std::size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 255);
    return bytes;
  };
  std::string json = gltf(node, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = triangleBuffer();
  const std::string chunks =
      word(json.size()) + "JSON" + json + word(buffer.size()) + std::string("BIN\0", 4) + buffer;
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

void expectNear(const Vec3& a, const Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-6) << a.transpose() << " / " << b.transpose();
}

TEST(AssimpReader, GltfWithAttributes) {
  const auto file = readAs(".gltf", gltf(""));
  ASSERT_TRUE(file.ok()) << file.error().text();
  test::expectConsistent(*file);
  const TriMesh& m = file->mesh;
  ASSERT_EQ(m.triangles.size(), 1u);
  expectNear(m.positions[at(m.triangles[0][1])], {11, 0, 0});
  EXPECT_EQ(m.uvSets.at(0).uv[0], Vec2(0, 1));  // glTF's v runs downwards: 0 there is 1 here
  EXPECT_EQ(m.uvSets.at(0).uv[2], Vec2(0, 0.75));
  EXPECT_EQ(m.colorSets.at(0).rgba[2], Vec4(0, 0, 1, 0.5));
  EXPECT_EQ(m.materials, (std::vector<std::string>{"clay"}));
  EXPECT_EQ(file->metresPerUnit, 1);
  EXPECT_EQ(file->up, FileFrame::Up::Y);
}

TEST(AssimpReader, Glb) {
  const auto file = readAs(".glb", glb(",\"scale\":[2,2,2]"));
  ASSERT_TRUE(file.ok()) << file.error().text();
  expectNear(file->mesh.positions[at(file->mesh.triangles[0][1])], {12, 0, 0});
  EXPECT_EQ(file->metresPerUnit, 1);
}

TEST(AssimpReader, NodeTransformsAccumulate) {
  // Scaled, turned by 90 degrees around x, then moved.
  const auto file = readAs(
      ".gltf", gltf(R"(,"translation":[0,5,0],"rotation":[0.70710678,0,0,0.70710678],"scale":[2,3,4])"));
  ASSERT_TRUE(file.ok()) << file.error().text();
  const TriMesh& m = file->mesh;
  expectNear(m.positions[at(m.triangles[0][0])], {10, 5, 0});
  expectNear(m.positions[at(m.triangles[0][1])], {12, 5, 0});
  expectNear(m.positions[at(m.triangles[0][2])], {10, 5, 3});
  expectNear(m.normals[0], {0, -1, 0});
}

TEST(AssimpReader, MirrorsKeepTheOutsideOut) {
  const auto file = readAs(".gltf", gltf(R"(,"scale":[-1,1,1])"));
  ASSERT_TRUE(file.ok()) << file.error().text();
  const TriMesh& m = file->mesh;
  const Triangle& t = m.triangles[0];
  const Vec3& a = m.positions[at(t[0])];
  const Vec3 normal = (m.positions[at(t[1])] - a).cross(m.positions[at(t[2])] - a);
  expectNear(normal, {0, 0, 1});
  for (const Vec3& n : m.normals) expectNear(n, {0, 0, 1});
  // Attributes went with their corners: the blue one is still at y = 1.
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(m.colorSets[0].rgba[k][2] == 1, m.positions[at(t[k])].y() == 1);
}

std::string fbx(int up, double unit, int upSign = 1) {
  return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n"
         "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n\t\tP: \"UpAxis\", \"int\", \"Integer\", "
         "\"\"," +
         std::to_string(up) + "\n\t\tP: \"UpAxisSign\", \"int\", \"Integer\", \"\"," +
         std::to_string(upSign) + "\n\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," +
         test::exactly(unit) + R"(
	}
}
Definitions:  {
	Version: 100
	Count: 2
	ObjectType: "Geometry" {
		Count: 1
	}
	ObjectType: "Model" {
		Count: 1
	}
}
Objects:  {
	Geometry: 1000, "Geometry::quad", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,2,0,0,0.5,0.5,0,0,2,0
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
	}
	Model: 2000, "Model::quad", "Mesh" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",10,20,30
		}
	}
}
Connections:  {
	C: "OO",2000,0
	C: "OO",1000,2000
}
)";
}

TEST(AssimpReader, FbxUnitAxisAndConcaveQuad) {
  const auto file = readAs(".fbx", fbx(2, 2.54));
  ASSERT_TRUE(file.ok()) << file.error().text();
  test::expectConsistent(*file);
  EXPECT_NEAR(*file->metresPerUnit, 0.0254, 1e-17);
  EXPECT_EQ(file->up, FileFrame::Up::Z);
  EXPECT_EQ(file->mesh.triangles.size(), 2u);
  EXPECT_NEAR(test::areaOf(file->mesh), 1, 1e-12);
  expectNear(boxOf(file->mesh.positions).low, {10, 20, 30});
  EXPECT_TRUE(file->mesh.materials.empty());
  const auto centimetres = readAs(".fbx", fbx(1, 1));
  ASSERT_TRUE(centimetres.ok());
  EXPECT_EQ(centimetres->metresPerUnit, 0.01);
  EXPECT_EQ(centimetres->up, FileFrame::Up::Y);
}

TEST(AssimpReader, FbxWithAnotherUpAxisIsRefused) {
  expectError(readAs(".fbx", fbx(0, 1)), "up axis is neither y nor z");
  expectError(readAs(".fbx", fbx(1, 1, -1)), "up axis is neither y nor z");
  expectError(readAs(".fbx", fbx(1, -1)), "UnitScaleFactor");
}

TEST(AssimpReader, ColladaArrivesInMetresWithYUp) {
  const auto file = readAs(".dae", R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 100 0 0 0 0 100</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  ASSERT_TRUE(file.ok()) << file.error().text();
  const Box box = boxOf(file->mesh.positions);
  expectNear(box.low, {0, 0, 0});
  expectNear(box.high, {1, 1, 0});
  EXPECT_EQ(file->metresPerUnit, 1);
  EXPECT_EQ(file->up, FileFrame::Up::Y);
}

TEST(AssimpReader, Errors) {
  expectError(readWithAssimp("/nowhere/at/all.glb"), "can't be read");
  expectError(readAs(".glb", "rubbish"), "can't be read");
  expectError(readAs(".gltf", "{\"asset\":{\"version\":\"2.0\"}}"), "");
  expectError(readAs(".fbx", ""), "can't be read");
  expectError(readAs(".xyzzy", "rubbish"), "can't be read");
}

TEST(AssimpReader, TruncatedFiles) {
  const std::string text = gltf(""), binary = glb("");
  for (std::size_t size = 0; size < binary.size(); size += 37) {
    EXPECT_FALSE(readAs(".glb", binary.substr(0, size)).ok()) << size;
  }
  for (std::size_t size = 0; size < text.size(); size += 41)
    EXPECT_FALSE(readAs(".gltf", text.substr(0, size)).ok());
}

}  // namespace
}  // namespace sherd
