#include "beta/write_vdb.h"

#include <openvdb/io/Stream.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/LevelSetUtil.h>

#include "beta/read_vdb.h"
#include "nodes/beta/fields.h"
#include "support/program.h"

namespace sherd {
namespace {

using namespace test;
using Params = WriteVdbParams;

ScalarGrid fieldOf(const openvdb::FloatGrid::Ptr& grid, const std::string& name = "beta",
                   const FileFrame& frame = {}) {
  grid->setName(name);
  return scalarGridOf(grid->deepCopy(), name, frame);
}

class WriteVdb : public testing::Test {
 protected:
  void SetUp() override {
    openvdb::initialize();
    params.file = scratch.file("field.vdb");
  }
  Result<void> write(const std::vector<ScalarGrid>& grids) const { return writeVdb(grids, params, {}); }
  ScalarGrid read(const std::string& name = {}, double unit = 1, FileFrame::Up up = FileFrame::Up::Y) const {
    const auto result = readVdb({params.file, name, unit, up}, {});
    EXPECT_TRUE(result.ok()) << errorOf(result);
    return result.ok() ? *result : ScalarGrid::constant(-999);
  }
  /// As OpenVDB itself reads it.
  openvdb::FloatGrid::Ptr readPlain(const std::string& name = "beta") const {
    openvdb::io::File file(params.file);
    file.open(false);
    return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
  }

  ScratchDirectory scratch;
  Params params;
};

TEST_F(WriteVdb, NothingToWriteBadUnitAndPlacesThatCannotBeWritten) {
  EXPECT_TRUE(says(errorOf(write({})), "grid: there is no grid to write"));
  const ScalarGrid one = ScalarGrid::constant(1);
  params.unit = -1;
  EXPECT_TRUE(says(errorOf(write({one})), "unit: a unit has to be a length"));
  params.unit = 0;
  params.file = "/proc/none/field.vdb";
  EXPECT_TRUE(says(errorOf(write({one})), "file: "));
  params.file = scratch.file("");
  EXPECT_TRUE(says(errorOf(write({one})), "file: "));
}

TEST_F(WriteVdb, CreatesTheDirectory) {
  params.file = scratch.file("a/b/field.vdb");
  ASSERT_TRUE(write({ScalarGrid::constant(2)}).ok());
  EXPECT_EQ(sampleAt(read(), Vec3::Zero()), 2);
}

TEST_F(WriteVdb, ConstantsComeBackAsConstants) {
  for (const auto precision : {Params::Precision::Float, Params::Precision::Half}) {
    params.precision = precision;
    ASSERT_TRUE(write({ScalarGrid::constant(2.5)}).ok());
    const ScalarGrid grid = read();
    EXPECT_TRUE(grid.isConstant());
    EXPECT_EQ(grid.name(), "beta");
    EXPECT_EQ(sampleAt(grid, Vec3(1, 2, 3)), 2.5);
  }
}

TEST_F(WriteVdb, AnyAffineTransformComesBack) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto grid = gridOf(static_cast<float>(seed) - 3);
    scatter(*grid, 12, seed);
    grid->setTransform(affineTransform(seed));
    const ScalarGrid field = fieldOf(grid);
    ASSERT_TRUE(write({field}).ok());
    expectSame(voxelsOf(read()), voxelsOf(field));
    expectSame(*readPlain(), voxelsOf(field));
  }
}

TEST_F(WriteVdb, AFrustumComesBackAndCannotBeTurned) {
  const auto grid = gridOf(1);
  scatter(*grid, 12, 3);
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(12)), 0.5, 2.0, 0.1));
  const ScalarGrid field = fieldOf(grid);
  ASSERT_TRUE(write({field}).ok());
  expectSame(voxelsOf(read()), voxelsOf(field));
  params.up = Params::Up::Z;
  EXPECT_TRUE(says(errorOf(write({field})), "up: grid 'beta' follows a camera's frustum"));
}

TEST_F(WriteVdb, HalvesKeepElevenBits) {
  params.precision = Params::Precision::Half;
  for (const double scale : {1e-6, 1e-3, 1.0, 3e4}) {
    const auto grid = gridOf(static_cast<float>(0.3 * scale));
    scatter(*grid, 10, 5, scale);
    const ScalarGrid field = fieldOf(grid);
    ASSERT_TRUE(write({field}).ok());
    const ScalarGrid back = read();
    const auto bound = [](double v) { return std::max(std::ldexp(std::abs(v), -11), std::ldexp(1, -25)); };
    EXPECT_EQ(voxelsOf(back).activeVoxelCount(), voxelsOf(field).activeVoxelCount());
    for (auto v = voxelsOf(field).cbeginValueOn(); v; ++v)
      EXPECT_NEAR(voxelsOf(back).tree().getValue(v.getCoord()), *v, bound(*v));
    EXPECT_NEAR(sampleAt(back, Vec3::Constant(50)), 0.3 * scale, bound(0.3 * scale));
  }
  EXPECT_TRUE(readPlain()->saveFloatAsHalf());
}

TEST_F(WriteVdb, HalvesThatWouldOverflowAreRefused) {
  params.precision = Params::Precision::Half;
  const auto grid = gridOf(1);
  grid->tree().setValue({1, -2, 3}, 65504);
  EXPECT_TRUE(write({fieldOf(grid)}).ok());
  grid->tree().setValue({1, -2, 3}, -7e4f);
  EXPECT_TRUE(
      says(errorOf(write({fieldOf(grid)})), "precision: grid 'beta' holds -70000 at voxel (1, -2, 3)"));
  EXPECT_TRUE(says(errorOf(write({fieldOf(gridOf(1e6f))})), "as its background"));
  params.precision = Params::Precision::Float;
  EXPECT_TRUE(write({fieldOf(grid)}).ok());
}

TEST_F(WriteVdb, SeveralGridsUnderTheirNames) {
  const auto a = gridOf(1), b = gridOf(2, 0.2);
  scatter(*a, 9, 1);
  scatter(*b, 9, 2);
  params.name = "first";
  const std::vector<ScalarGrid> fields{fieldOf(a), fieldOf(b), ScalarGrid(fieldOf(gridOf(7), "seven"))};
  ASSERT_TRUE(write(fields).ok());
  expectSame(voxelsOf(read("first")), voxelsOf(fields[0]));
  expectSame(voxelsOf(read("beta")), voxelsOf(fields[1]));
  EXPECT_EQ(sampleAt(read("seven"), Vec3::Zero()), 7);
  params.name.clear();
  EXPECT_TRUE(says(errorOf(write(fields)), "name: two of the grids are named 'beta'"));
}

TEST_F(WriteVdb, ALevelSetStaysOne) {
  const auto sphere =
      openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(2.0f, openvdb::Vec3f(0.3f), 0.1f);
  sphere->setName("beta");
  openvdb::io::File(params.file).write({sphere});
  const ScalarGrid field = read();
  const double width = static_cast<double>(sphere->background());
  EXPECT_EQ(sampleAt(field, Vec3::Constant(0.3)), -width)
      << "its middle is inside, though inactive in the file";
  EXPECT_EQ(sampleAt(field, Vec3::Constant(5)), width);
  EXPECT_LT(byteSize(field), sphere->memUsage() * 3 / 2) << "the inside stays tiles";
  ASSERT_TRUE(write({field}).ok());
  const auto back = readPlain();
  EXPECT_EQ(back->getGridClass(), openvdb::GRID_LEVEL_SET);
  expectSame(*back, *sphere);
}

TEST_F(WriteVdb, AFogKeepsItsTilesAndClass) {
  const auto fog = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(3.0f, openvdb::Vec3f(0), 0.1f);
  openvdb::tools::sdfToFogVolume(*fog);
  fog->setName("beta");
  openvdb::io::File(params.file).write({fog});
  ASSERT_GT(fog->tree().activeTileCount(), 0u);
  const ScalarGrid field = read();
  ASSERT_TRUE(write({field}).ok());
  EXPECT_EQ(readPlain()->getGridClass(), openvdb::GRID_FOG_VOLUME);
  expectSame(*readPlain(), *fog);
}

TEST_F(WriteVdb, ClassesAreGivenAndALevelSetNeedsABand) {
  const auto grid = gridOf(0);
  grid->tree().setValue({0, 0, 0}, 1);
  params.gridClass = Params::GridClass::Fog;
  ASSERT_TRUE(write({fieldOf(grid)}).ok());
  EXPECT_EQ(readPlain()->getGridClass(), openvdb::GRID_FOG_VOLUME);
  params.gridClass = Params::GridClass::LevelSet;
  EXPECT_TRUE(says(errorOf(write({fieldOf(grid)})), "grid_class: grid 'beta' is no level set"));
  ASSERT_TRUE(write({fieldOf(gridOf(0.3f))}).ok());
  EXPECT_EQ(readPlain()->getGridClass(), openvdb::GRID_LEVEL_SET);
}

TEST_F(WriteVdb, OtherUnitsAndAxesMoveNoPoint) {
  const auto grid = gridOf(9);
  scatter(*grid, 10, 4);
  grid->setTransform(affineTransform(4));
  const ScalarGrid field = fieldOf(grid, "beta", {0.1, FileFrame::Up::Y});
  params.up = Params::Up::Z;
  params.unit = 0.01;
  ASSERT_TRUE(write({field}).ok());
  const ScalarGrid back = read({}, 0.01, FileFrame::Up::Z);
  EXPECT_TRUE(back.impl().grid->tree().hasSameTopology(field.impl().grid->tree()));
  const Rng rng(8);
  for (std::uint64_t i = 0; i < 300; i += 3) {
    const Vec3 p = 0.1 * Vec3(rng.uniformAt(i), rng.uniformAt(i + 1), rng.uniformAt(i + 2));
    EXPECT_NEAR(sampleAt(back, p), sampleAt(field, p), 1e-5);
  }
}

TEST_F(WriteVdb, SameBytesWheneverAndForAnyNumberOfThreads) {
  const auto grid = gridOf(1);
  scatter(*grid, 40, 6);
  const std::vector<ScalarGrid> fields{fieldOf(grid), fieldOf(gridOf(3), "other")};
  std::string first;
  for (const int limit : {1, 2, 4}) {
    const Threads threads(limit);
    std::filesystem::remove(params.file);
    ASSERT_TRUE(write(fields).ok());
    if (first.empty()) first = contentOf(params.file);
    EXPECT_TRUE(contentOf(params.file) == first);
  }
  const auto time = std::filesystem::last_write_time(params.file);
  ASSERT_TRUE(write(fields).ok());
  EXPECT_EQ(std::filesystem::last_write_time(params.file), time) << "the same content is left alone";
  grid->tree().setValue({0, 0, 0}, 5);
  ASSERT_TRUE(write({fieldOf(grid), fields[1]}).ok());
  const std::string other = contentOf(params.file);
  EXPECT_NE(other.substr(21, 36), first.substr(21, 36)) << "the tag tells files apart";
  EXPECT_EQ(other[21 + 8], '-');
}

TEST_F(WriteVdb, NothingIsWrittenOnceCancelled) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const std::vector<ScalarGrid> fields{ScalarGrid::constant(1)};
  const auto result = writeVdb(fields, params, exec);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, Error::Kind::Cancelled);
  EXPECT_FALSE(std::filesystem::exists(params.file));
}

/// Files that programs of OpenVDB's own made.
TEST_F(WriteVdb, ReadsWhatOpenVdbWrites) {
  const auto half = gridOf(0.25f),
             level = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, openvdb::Vec3f(0), 0.1f);
  scatter(*half, 8, 9);
  half->setName("half");
  half->setSaveFloatAsHalf(true);
  half->setTransform(affineTransform(9));
  level->setName("level");
  const auto fog = level->deepCopy();
  openvdb::tools::sdfToFogVolume(*fog);
  fog->setName("fog");
  const auto doubles = std::make_shared<openvdb::DoubleGrid>(*fog);
  doubles->setName("doubles");
  for (const bool streamed : {false, true}) {  // a stream has no index of grids
    if (streamed) {
      std::ofstream out(params.file, std::ios::binary);
      openvdb::io::Stream(out).write(openvdb::GridCPtrVec{half, level, fog, doubles});
    } else {
      openvdb::io::File(params.file).write({half, level, fog, doubles});
    }
    EXPECT_EQ(voxelsOf(read("half")).transform(), half->transform());
    EXPECT_NEAR(sampleAt(read("half"), Vec3::Constant(99)), 0.25, 1e-4);
    EXPECT_NEAR(sampleAt(read("level"), Vec3(0.95, 0, 0)), -0.05, 1e-3);
    EXPECT_LT(sampleAt(read("level"), Vec3::Zero()), -0.1);
    EXPECT_EQ(sampleAt(read("fog"), Vec3::Zero()), 1);
    EXPECT_EQ(sampleAt(read("doubles"), Vec3::Zero()), 1);
    EXPECT_EQ(sampleAt(read("doubles"), Vec3::Constant(3)), 0);
  }
}

}  // namespace
}  // namespace sherd
