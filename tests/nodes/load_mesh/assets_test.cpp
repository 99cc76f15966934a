// The project's own models: what they promise, and that their generator still makes these very bytes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "geometry/edge_table.h"
#include "load_mesh/load_mesh.h"
#include "support/said.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Asset {
  const char* name;
  std::size_t triangles;
  int euler;  ///< vertices − edges + triangles: 2 for a ball, 0 with one handle
  Vec3 size;  ///< m
};

class Assets : public ::testing::TestWithParam<Asset> {};

TEST_P(Assets, AreSoundSolidsOfTheSizeTheyPromise) {
  Said said;
  const std::string file = std::string(SHERD_SOURCE_DIR "/assets/") + GetParam().name + ".obj";
  const auto mesh = loadMesh({.file = file, .up = UpAxis::Y, .unit = 1}, said.exec);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_TRUE(said.lines.empty()) << "nothing to be welded, left out or turned: " << said.lines[0].second;
  EXPECT_EQ(mesh->triangles.size(), GetParam().triangles);
  const auto vertices = static_cast<long>(mesh->positions.size());
  const auto edges = static_cast<long>(buildEdgeTable(mesh->triangles, mesh->positions.size()).ends.size());
  EXPECT_EQ(vertices - edges + static_cast<long>(mesh->triangles.size()), GetParam().euler);
  const Box box = boxOf(mesh->positions);
  EXPECT_NEAR(box.low.y(), 0, 1e-4) << "stands on the ground";
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR((box.high - box.low)[axis], GetParam().size[axis], 1e-3);
  EXPECT_EQ(mesh->normals.size(), mesh->cornerCount());
  ASSERT_EQ(mesh->uvSets.size(), 1u);
  EXPECT_EQ(mesh->uvSets[0].uv.size(), mesh->cornerCount());
  EXPECT_FALSE(mesh->materials.empty());
}

INSTANTIATE_TEST_SUITE_P(Models, Assets,
                         ::testing::Values(Asset{"vase", 11092, 0, Vec3(0.2518, 0.3011, 0.19)},
                                           Asset{"mushroom", 768, 2, Vec3(0.107, 0.120, 0.107)},
                                           Asset{"sphere", 2208, 2, Vec3(0.2, 0.2, 0.2)},
                                           Asset{"wall", 4800, 2, Vec3(1.02, 0.84, 0.12)},
                                           Asset{"table", 5732, 2, Vec3(1.20, 0.72, 0.75)}),
                         [](const auto& info) { return info.param.name; });

TEST(AssetGenerator, MakesTheCommittedBytes) {
  if (std::system("python3 --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "python3 is missing";
  const fs::path folder = fs::temp_directory_path() / ("sherd_assets_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const std::string command =
      "python3 '" SHERD_SOURCE_DIR "/assets/generate.py' '" + folder.string() + "' > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* name : {"vase.obj", "mushroom.obj", "sphere.obj", "wall.obj", "table.obj"}) {
    const std::string made = contentOf(folder / name);
    EXPECT_FALSE(made.empty());
    EXPECT_TRUE(made == contentOf(fs::path(SHERD_SOURCE_DIR "/assets") / name)) << name;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace sherd
