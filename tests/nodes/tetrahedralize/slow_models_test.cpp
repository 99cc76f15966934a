// Real models at the paper's resolution; skipped where they are absent.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "surfaces.h"

namespace sherd::test {
namespace {

TriMesh readObj(const std::filesystem::path& path) {
  TriMesh mesh;
  std::ifstream in(path);
  for (std::string line, word; std::getline(in, line);) {
    std::istringstream words(line);
    words >> word;
    if (word == "v") {
      Vec3& p = mesh.positions.emplace_back();
      words >> p.x() >> p.y() >> p.z();
    } else if (word == "f") {
      std::vector<Index> corners;
      while (words >> word) corners.push_back(std::stoi(word) - 1);
      for (std::size_t i = 2; i < corners.size(); ++i)
        mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
  return mesh;
}

int eulerOf(const TriMesh& mesh) {  // of a closed surface that uses all its vertices
  return static_cast<int>(mesh.positions.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

class SlowTetrahedralize : public ::testing::TestWithParam<const char*> {};

TEST_P(SlowTetrahedralize, EnclosesARealModel) {
  const auto path = std::filesystem::path(SHERD_SOURCE_DIR) / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  const auto mesh = shared(readObj(path));
  const auto cage = tetrahedralize(mesh, {.tets = 5000}, {});
  ASSERT_TRUE(cage.ok()) << cage.error().text();
  EXPECT_EQ(defectOf(*cage), "");
  EXPECT_EQ(cageTopology(*cage), std::make_pair(1, eulerOf(*mesh)));
  EXPECT_NEAR(static_cast<double>(cage->tets.size()), 5000, 750);
  EXPECT_GT(cage->quality.minDihedral, 2);
}

INSTANTIATE_TEST_SUITE_P(Models, SlowTetrahedralize,
                         ::testing::Values("assets/vase.obj", "assets/table.obj",
                                           "../shared/meshes/horse.obj", "../shared/meshes/bunny_7k.obj",
                                           "../shared/meshes/spot.obj", "../shared/meshes/fertility.obj",
                                           "../shared/meshes/knight.obj",
                                           "../shared/meshes/three_holes.obj"));

}  // namespace
}  // namespace sherd::test
