// Meshes as they come from the world. They are no part of the project; where they are absent the tests are
// skipped.
#include <gtest/gtest.h>

#include <filesystem>

#include "geometry/inspect_surface.h"
#include "geometry/solid.h"
#include "load_mesh/load_mesh.h"
#include "support/said.h"

namespace sherd {
namespace {

struct Expected {
  const char* file;
  std::size_t triangles;  ///< 0: refused
  const char* message;    ///< part of what is said, or of the error; may be empty
};

class RealMeshes : public ::testing::TestWithParam<Expected> {};

TEST_P(RealMeshes, LoadOrAreRefusedByName) {
  const std::string file = std::string(SHERD_SOURCE_DIR "/../shared/meshes/") + GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  Said said;
  const auto mesh = loadMesh({.file = file, .repair = RepairMode::Strict}, said.exec);
  if (GetParam().triangles == 0) {
    ASSERT_FALSE(mesh.ok());
    EXPECT_NE(mesh.error().what.find(GetParam().file), std::string::npos);
    EXPECT_NE(mesh.error().text().find(GetParam().message), std::string::npos) << mesh.error().text();
    return;
  }
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_EQ(mesh->triangles.size(), GetParam().triangles);
  EXPECT_GT(solidVolume(mesh->positions, mesh->triangles), 0);
  EXPECT_TRUE(inspectSurface(*mesh).sound());
  if (*GetParam().message) {
    EXPECT_TRUE(said.warning(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealMeshes,
    ::testing::Values(Expected{"horse.obj", 38014, ""}, Expected{"bunny.obj", 163582, ""},
                      Expected{"bunny_7k.obj", 6966, ""}, Expected{"armadillo.obj", 86482, ""},
                      Expected{"spot.obj", 5856, ""}, Expected{"fertility.obj", 9000, ""},
                      Expected{"three_holes.obj", 7200, ""}, Expected{"knight.obj", 1000, ""},
                      Expected{"bumpy_cube.obj", 39936, ""}, Expected{"screwdriver.obj", 6786, ""},
                      Expected{"cheese.obj", 17786, ""}, Expected{"beam_inverted.obj", 0, "inside out"},
                      Expected{"camel_self_intersecting.obj", 0, "intersecting triangles"},
                      Expected{"cow_self_intersecting.obj", 0, "intersecting triangles"},
                      Expected{"bones_26_parts.obj", 0, "intersecting triangles"},
                      Expected{"suzanne_open.obj", 0, "open edges"},
                      Expected{"teapot_open_soup.obj", 0, "open edges"},
                      Expected{"bunny_scan_open.obj", 0, "open edges"}),
    [](const auto& info) { return std::filesystem::path(info.param.file).stem().string(); });

}  // namespace
}  // namespace sherd
