#include "beta/read_vdb.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "nodes/beta/fields.h"
#include "support/sanitizers.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;
using test::digestOf;
using test::sampleAt;

template <class Grid = openvdb::FloatGrid>
typename Grid::Ptr makeGrid(const char* name, double background, double voxel = 0.1) {
  auto grid = Grid::create(static_cast<typename Grid::ValueType>(background));
  grid->setName(name);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  return grid;
}

/// Without a voxel, of a type that OpenVDB registers.
template <class Grid>
openvdb::GridBase::Ptr emptyGrid(const char* name) {
  auto grid = openvdb::GridBase::createGrid(Grid::gridType());
  grid->setName(name);
  return grid;
}

/// Values x + 2 y + 3 z (of the voxels' world positions) for indices in [0, n]³.
template <class Grid>
void fillLinear(Grid& grid, int n) {
  auto accessor = grid.getAccessor();
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        const openvdb::Vec3d p = grid.indexToWorld(openvdb::Coord(i, j, k));
        accessor.setValue({i, j, k}, static_cast<typename Grid::ValueType>(p.x() + 2 * p.y() + 3 * p.z()));
      }
}

class ReadVdb : public testing::Test {
 protected:
  void SetUp() override {
    openvdb::initialize();
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    root = fs::temp_directory_path() / ("sherd_vdb_" + std::to_string(::getpid()) + "_" + info->name());
    fs::create_directories(root);
    params.file = (root / "field.vdb").string();
    exec.onMessage = [this](LogLevel, const std::string& line) { messages.push_back(line); };
  }
  void TearDown() override { fs::remove_all(root); }

  void write(const openvdb::GridCPtrVec& grids) const { openvdb::io::File(params.file).write(grids); }
  Result<ScalarGrid> read() const { return readVdb(params, exec); }
  /// The text of the error that reading gives; empty where it succeeds.
  std::string errorText() const {
    const auto result = read();
    return result.ok() ? "" : result.error().text();
  }

  fs::path root;
  ReadVdbParams params;
  Exec exec;
  std::vector<std::string> messages;
};

TEST_F(ReadVdb, MissingFileDirectoryAndGarbage) {
  EXPECT_NE(errorText().find("there is no file"), std::string::npos);
  params.file = root.string();
  EXPECT_NE(errorText().find("is a directory"), std::string::npos);
  params.file = (root / "garbage.vdb").string();
  for (const std::string& text : {std::string(), std::string("v 0 0 0\n"), std::string(5000, '\xa5')}) {
    std::ofstream(params.file, std::ios::binary) << text;
    EXPECT_NE(errorText().find("cannot be read as OpenVDB"), std::string::npos) << errorText();
  }
}

TEST_F(ReadVdb, TruncatedFilesAreErrors) {
  if (test::kAddressSanitizer || test::kThreadSanitizer)
    GTEST_SKIP() << "OpenVDB asks for terabytes, which ends a program with sanitizers";
  const auto grid = makeGrid("beta", 1);
  fillLinear(*grid, 20);
  write({grid});
  std::ifstream in(params.file, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  in.close();
  for (std::size_t eighths = 0; eighths < 8; ++eighths) {
    std::ofstream(params.file, std::ios::binary | std::ios::trunc)
        << whole.substr(0, whole.size() * eighths / 8);
    EXPECT_NE(errorText(), "") << eighths;
  }
}

TEST_F(ReadVdb, ListsGridsWhereNoneFits) {
  write({emptyGrid<openvdb::Vec3SGrid>("velocity"), emptyGrid<openvdb::Int32Grid>("ids")});
  const std::string text = errorText();
  EXPECT_NE(text.find("no grid of floats"), std::string::npos) << text;
  EXPECT_NE(text.find("'ids' (int32)"), std::string::npos) << text;
  EXPECT_NE(text.find("'velocity' (vec3s)"), std::string::npos) << text;
  params.grid = "beta";
  EXPECT_NE(errorText().find("no grid named 'beta'"), std::string::npos);
  params.grid = "ids";
  EXPECT_NE(errorText().find("values of type int32"), std::string::npos);
}

TEST_F(ReadVdb, NotANumber) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const auto grid = makeGrid("beta", 1);
    grid->tree().setValue({3, -4, 5}, bad);
    grid->tree().setValue({9, 9, 9}, bad);
    write({grid});
    const std::string text = errorText();
    EXPECT_NE(text.find(std::isnan(bad) ? "NaN at voxel" : "an infinite value at voxel"), std::string::npos)
        << text;
    EXPECT_NE(text.find("(3, -4, 5) and 1 more"), std::string::npos) << text;
  }
  write({makeGrid("beta", std::nan(""))});
  EXPECT_NE(errorText().find("NaN as its background"), std::string::npos);
  const auto tooLarge = makeGrid<openvdb::DoubleGrid>("beta", 1);
  tooLarge->tree().setValue({0, 0, 0}, 1e300);
  write({tooLarge});
  EXPECT_NE(errorText().find("an infinite value"), std::string::npos);
}

TEST_F(ReadVdb, UnitHasToBeALength) {
  write({makeGrid("beta", 1)});
  params.unit = 0;
  EXPECT_NE(errorText().find("length above zero"), std::string::npos);
}

TEST_F(ReadVdb, NothingPaintedIsConstant) {
  const auto grid = makeGrid("beta", 2.5);
  grid->tree().setValue({1, 2, 3}, 2.5f);
  write({grid});
  const auto result = read();
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result->isConstant());
  EXPECT_EQ(sampleAt(*result, Vec3(0.1, 0.2, 0.3)), 2.5);
  EXPECT_EQ(result->name(), "beta");
  const auto other = makeGrid("beta", 2.5);
  EXPECT_EQ(digestOf(*result), digestOf(scalarGridOf(other, "beta", FileFrame{})));
  EXPECT_NE(digestOf(*result), digestOf(scalarGridOf(other, "toughness", FileFrame{})));
  EXPECT_NE(digestOf(*result), digestOf(scalarGridOf(makeGrid("beta", 2), "beta", FileFrame{})));
}

TEST_F(ReadVdb, TakesTheFirstFloatGridAndSaysSo) {
  const auto first = makeGrid("a", 1), second = makeGrid("b", 2);
  second->tree().setValue({0, 0, 0}, 7);
  write({second, emptyGrid<openvdb::Int32Grid>("0"), first});
  auto result = read();
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->name(), "a");
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("taking grid 'a'"), std::string::npos);
  params.grid = "b";
  result = read();
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(sampleAt(*result, Vec3::Zero()), 7);
  EXPECT_EQ(messages.size(), 1u);
}

TEST_F(ReadVdb, LinearFieldsAreSampledExactly) {
  const Rng rng(5);
  const auto floats = makeGrid("beta", 9), halves = makeGrid("beta", 9);
  const auto doubles = makeGrid<openvdb::DoubleGrid>("beta", 9);
  fillLinear(*floats, 20);
  fillLinear(*halves, 20);
  fillLinear(*doubles, 20);
  halves->setSaveFloatAsHalf(true);
  const std::pair<openvdb::GridBase::Ptr, double> cases[] = {{floats, 2e-6}, {doubles, 2e-6}, {halves, 8e-3}};
  for (const auto& [grid, tolerance] : cases) {
    write({grid});
    const auto result = read();
    ASSERT_TRUE(result.ok());
    EXPECT_FALSE(result->isConstant());
    for (std::uint64_t i = 0; i < 300; i += 3) {
      const Vec3 p = 2 * Vec3(rng.uniformAt(i), rng.uniformAt(i + 1), rng.uniformAt(i + 2));
      EXPECT_NEAR(sampleAt(*result, p), p.x() + 2 * p.y() + 3 * p.z(), tolerance);
    }
    EXPECT_EQ(sampleAt(*result, Vec3(-0.5, 1, 1)), 9);
    EXPECT_EQ(sampleAt(*result, Vec3(1e300, 0, 0)), 9);
  }
}

TEST_F(ReadVdb, InactiveVoxelsCountAsBackground) {
  const auto grid = makeGrid("beta", 1);
  grid->tree().setValue({0, 0, 0}, 4);
  grid->tree().setValue({5, 5, 5}, 8);
  grid->tree().setValueOff({5, 5, 5}, 8);
  write({grid});
  const auto result = read();
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(sampleAt(*result, Vec3::Constant(0.5)), 1);
  EXPECT_EQ(sampleAt(*result, Vec3::Zero()), 4);
}

TEST_F(ReadVdb, UnitAndAxesMatchTheMesh) {
  const auto grid = makeGrid("beta", 0);
  fillLinear(*grid, 20);
  write({grid});
  params.unit = 0.01;
  params.up = FileFrame::Up::Z;
  const auto result = read();
  ASSERT_TRUE(result.ok());
  const Vec3 inFile(0.3, 0.7, 1.1);
  EXPECT_NEAR(sampleAt(*result, FileFrame{0.01, FileFrame::Up::Z}.toMetres(inFile)), 0.3 + 1.4 + 3.3, 2e-6);
}

TEST_F(ReadVdb, DigestFollowsValuesTransformAndFrame) {
  std::vector<Digest> digests;
  const auto add = [&](double background, double voxel, float value, double unit) {
    const auto grid = makeGrid("beta", background, voxel);
    grid->tree().setValue({1, 2, 3}, value);
    write({grid});
    params.unit = unit;
    const auto result = read();
    ASSERT_TRUE(result.ok());
    digests.push_back(digestOf(*result));
  };
  add(1, 0.1, 2, 1);
  add(1, 0.1, 2, 1);
  EXPECT_EQ(digests[0], digests[1]);
  digests.pop_back();
  add(2, 0.1, 3, 1);
  add(1, 0.2, 2, 1);
  add(1, 0.1, 3, 1);
  add(1, 0.1, 2, 0.5);
  std::sort(digests.begin(), digests.end());
  EXPECT_EQ(std::unique(digests.begin(), digests.end()), digests.end());
}

TEST_F(ReadVdb, SameSamplesForAnyNumberOfThreads) {
  const auto grid = makeGrid("beta", 1);
  fillLinear(*grid, 12);
  write({grid});
  const auto result = read();
  ASSERT_TRUE(result.ok());
  const Rng rng(9);
  std::vector<Vec3> points(10000);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = 1.5 * Vec3(rng.uniformAt(3 * i), rng.uniformAt(3 * i + 1), rng.uniformAt(3 * i + 2));
  std::vector<double> one(points.size()), two(points.size());
  setThreadLimit(1);
  result->sample(points, one);
  setThreadLimit(2);
  result->sample(points, two);
  setThreadLimit(0);
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace sherd
