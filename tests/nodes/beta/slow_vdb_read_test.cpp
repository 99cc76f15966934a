// Files that other programs write, as ReadVDB reads them: Debian's vdb_tool and vdb_lod (libopenvdb-tools)
// and Blender. tests/run --all installs them; where they are missing the tests fail.
//
// What these can't write: vdb_tool and Blender have no grids of double, so that vdb_lod makes one of ours
// coarser for that. Blender's volumes lie in the space of their object, z up: neither the object's place nor
// that of a fluid's domain is in the file, and its transforms hold a scale only; vdb_tool turns and moves
// grids.
#include <sys/wait.h>

#include <cstdio>

#include "beta/paint_beta.h"
#include "beta/read_vdb.h"
#include "beta/write_vdb.h"
#include "blender/blender_process.h"
#include "nodes/beta/fields.h"
#include "support/program.h"
#include "support/said.h"

namespace sherd {
namespace {

using namespace test;

void mustRun(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string text;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  const int status = pclose(pipe);
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
      << command << ": " << text << "(libopenvdb-tools is installed by tests/run --all)";
}

ScalarGrid mustRead(const ReadVdbParams& params, const Exec& exec = {}) {
  const auto grid = readVdb(params, exec);
  EXPECT_TRUE(grid.ok()) << (grid.ok() ? "" : grid.error().text());
  return grid.ok() ? *grid : ScalarGrid::constant(NAN);
}

/// Places about `centre`, on all sides of a ball and within.
std::vector<Vec3> placesAround(const Vec3& centre, double reach) {
  const Rng rng(17);
  std::vector<Vec3> places{centre};
  for (std::uint64_t i = 0; i < 1500; i += 3)
    places.push_back(
        centre +
        reach * (2 * Vec3(rng.uniformAt(i), rng.uniformAt(i + 1), rng.uniformAt(i + 2)) - Vec3::Ones()));
  return places;
}

/// The middle of the voxel that a place lies in.
Vec3 snapped(const Vec3& place, double voxel) { return voxel * (place / voxel).array().round().matrix(); }

TEST(SlowVdbRead, BallsOfVdbToolInFloatAndHalf) {
  const ScratchDirectory scratch;
  for (const int bits : {32, 16}) {
    const std::string file = scratch.file("balls.vdb");
    mustRun("vdb_tool -sphere name=ball voxel=0.05 radius=0.5 'center=(1,2,3)' " +
            std::string("-sphere name=other voxel=0.04 radius=0.4 -ls2fog name=fog vdb=0 -write bits=") +
            std::to_string(bits) + " '" + file + "'");
    const double rounding = bits == 32 ? 1e-6 : 1.0 / 2048;
    Said said;
    const ScalarGrid ball = mustRead({.file = file, .grid = {}}, said.exec);
    EXPECT_TRUE(said.info("taking grid 'ball'"));
    EXPECT_TRUE(said.info("it holds 'ball' (float), 'fog' (float)"));
    for (const Vec3& place : placesAround(Vec3(1, 2, 3), 1)) {
      const Vec3 p = snapped(place, 0.05);
      const double distance = std::clamp((p - Vec3(1, 2, 3)).norm() - 0.5, -0.15, 0.15);
      EXPECT_NEAR(sampleAt(ball, p), distance, 0.15 * rounding + 1e-6) << p.transpose();
    }
    const ScalarGrid fog = mustRead({.file = file, .grid = "fog"});
    EXPECT_EQ(fog.background(), 0);
    for (const Vec3& place : placesAround(Vec3::Zero(), 0.8)) {
      const Vec3 p = snapped(place, 0.04);
      EXPECT_NEAR(sampleAt(fog, p), std::clamp((0.4 - p.norm()) / 0.12, 0.0, 1.0), rounding + 1e-5)
          << p.transpose();
    }
    const auto none = readVdb({.file = file, .grid = "beta"}, {});
    ASSERT_FALSE(none.ok());
    EXPECT_TRUE(says(none.error().text(), "it holds 'ball' (float), 'fog' (float)"));
  }
}

/// vdb_tool turns the space of the grid and leaves its values alone.
TEST(SlowVdbRead, ATurnedScaledAndMovedGridOfVdbTool) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("turned.vdb");
  mustRun(
      "vdb_tool -sphere name=ball voxel=0.05 radius=0.5 'center=(0.6,0.1,0)' -transform vdb=0 "
      "'rotate=(0,0,0.5)' scale=2 'translate=(1,2,3)' -write '" +
      file + "'");
  const Mat3 turn = Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix();
  const Vec3 centre = turn * Vec3(1.2, 0.2, 0) + Vec3(1, 2, 3);
  for (const FileFrame& frame :
       {FileFrame{}, FileFrame{0.01, FileFrame::Up::Y}, FileFrame{1, FileFrame::Up::Z}}) {
    const ScalarGrid ball = mustRead({.file = file, .grid = {}, .unit = frame.metresPerUnit, .up = frame.up});
    double worst = 0;
    for (const Vec3& p : placesAround(centre, 1.6)) {
      const double distance = std::clamp((p - centre).norm() / 2 - 0.5, -0.15, 0.15);
      worst = std::max(worst, std::abs(sampleAt(ball, frame.toMetres(p)) - distance));
    }
    EXPECT_LT(worst, 0.012);  // where the band ends it has a kink, which voxels of 0.05 round off
  }
}

TEST(SlowVdbRead, CoarserLevelsOfOursByVdbLod) {
  const ScratchDirectory scratch;
  PaintBetaParams paint;
  paint.voxel = 0.05;
  paint.background = 0.5;
  paint.strokes = {{{{0, 0, 0}}, 1, 0.5, 3, Blend::Replace}};
  const auto dab = paintBeta({}, paint, {});
  ASSERT_TRUE(dab.ok());
  WriteVdbParams write;
  write.file = scratch.file("dab.vdb");
  ASSERT_TRUE(writeVdb({&*dab, 1}, write, {}).ok());
  const std::string levels = scratch.file("levels.vdb");
  mustRun("vdb_lod '" + write.file + "' '" + levels + "' -range 0-2");
  expectSame(voxelsOf(mustRead({.file = levels, .grid = "beta_level_0"})), voxelsOf(*dab));
  // It smooths as it goes: values fall by up to 2.5 within 0.5 m, and half a coarse voxel off is three times
  // this.
  for (const auto& [name, tolerance] : {std::pair("beta_level_1", 0.12), std::pair("beta_level_2", 0.4)}) {
    const ScalarGrid coarse = mustRead({.file = levels, .grid = name});
    EXPECT_EQ(coarse.background(), 0.5);
    for (const Vec3& p : placesAround(Vec3::Zero(), 0.7))
      EXPECT_NEAR(sampleAt(coarse, p), sampleAt(*dab, p), tolerance) << name << ' ' << p.transpose();
  }
}

TEST(SlowVdbRead, DoublesThroughVdbLod) {
  const ScratchDirectory scratch;
  openvdb::initialize();
  const auto grid = openvdb::DoubleGrid::create(1.5);
  grid->setName("beta");
  grid->setTransform(affineTransform(5));
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 20; ++k) grid->tree().setValue({i, j, k}, 0.1 * i + 0.2 * j - 0.3 * k);
  const std::string ours = scratch.file("doubles.vdb"), theirs = scratch.file("theirs.vdb");
  openvdb::io::File(ours).write({grid});
  mustRun("vdb_lod '" + ours + "' '" + theirs + "' -range 0 -preserve");
  const ScalarGrid read = mustRead({.file = theirs, .grid = "beta"});
  const Rng rng(3);
  for (std::uint64_t i = 0; i < 600; i += 3) {
    const openvdb::Vec3d index(18 * rng.uniformAt(i), 18 * rng.uniformAt(i + 1), 18 * rng.uniformAt(i + 2));
    const openvdb::Vec3d p = grid->indexToWorld(index);
    EXPECT_NEAR(sampleAt(read, Vec3(p.x(), p.y(), p.z())),
                0.1 * index.x() + 0.2 * index.y() - 0.3 * index.z(), 2e-6);
  }
}

/// Every cell of a fluid's density, against what Blender holds for it.
void expectDensity(const std::string& directory) {
  const ScalarGrid density =
      mustRead({.file = directory + "smoke/data/fluid_data_0002.vdb", .grid = "density"});
  EXPECT_EQ(density.background(), 0);
  std::ifstream held(directory + "density.txt");
  int size[3] = {};
  held >> size[0] >> size[1] >> size[2];
  ASSERT_EQ(size[0] * size[1] * size[2], 24 * 24 * 24);
  std::vector<Vec3> places;
  std::vector<double> wanted;
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i) {
        places.push_back(2.0 / 24 * Vec3(i, j, k));
        held >> wanted.emplace_back();
      }
  ASSERT_TRUE(held.good());
  std::vector<double> found(places.size());
  density.sample(places, found);
  std::size_t dense = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(found[i], wanted[i], 1e-3) << places[i].transpose();
    dense += wanted[i] > 0.5;
  }
  EXPECT_GT(dense, 100u);
}

TEST(SlowVdbRead, VolumesOfBlender) {
  const ScratchDirectory scratch;
  blenderSays(SHERD_SOURCE_DIR "/tests/blender/write_volumes_in_blender.py", {scratch.file("")},
              scratch.file("home"));
  const ScalarGrid cube = mustRead({.file = scratch.file("cube.vdb"), .grid = {}, .up = FileFrame::Up::Z});
  EXPECT_EQ(cube.name(), "density");
  const Vec3 centre(1, 2, -0.5);  // of (1, 0.5, 2) with z up
  std::size_t within = 0, outside = 0;
  for (const Vec3& p : placesAround(centre, 1)) {
    const double off = (p - centre).cwiseAbs().maxCoeff() - 0.5;
    if (off >= -0.05 && off <= 0.2) continue;  // the modifier's band, and what is between voxels
    EXPECT_EQ(sampleAt(cube, p), off < 0 ? 2.5 : 0) << p.transpose();
    ++(off < 0 ? within : outside);
  }
  EXPECT_GT(within, 20u);
  EXPECT_GT(outside, 100u);
  expectDensity(scratch.file(""));
  // A fluid's other grids: of vectors, which are no field, and of nothing.
  const std::string smoke = scratch.file("smoke/data/fluid_data_0002.vdb");
  EXPECT_TRUE(says(errorOf(readVdb({.file = smoke, .grid = "velocity"}, {})), "values of type vec3s"));
  EXPECT_TRUE(mustRead({.file = smoke, .grid = "flame"}).isConstant());
}

}  // namespace
}  // namespace sherd
