// Painted fields saved and loaded: nothing of the grid may change.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <limits>

#include "base/rng.h"
#include "nodes/types/memory_store.h"
#include "types/scalar_grid_vdb.h"

namespace sherd {
namespace {

openvdb::FloatGrid::Ptr painted() {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(1.5f);
  grid->setName("beta");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(
      openvdb::Mat4d(0.1, 0.02, 0., 0., 0., 0.2, 0., 0., 0.03, 0., 0.3, 0., 1., 2., 3., 1.)));
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setSaveFloatAsHalf(true);  // asks for a loss that a saved value must not have
  grid->insertMeta("artist", openvdb::StringMetadata("Zoë"));
  grid->insertMeta("pass", openvdb::Int32Metadata(3));
  grid->fill(openvdb::CoordBBox(openvdb::Coord(-8, 0, 0), openvdb::Coord(23, 15, 7)), 1.0f / 3);
  const Rng rng(3);
  auto accessor = grid->getAccessor();
  for (std::uint64_t i = 0; i < 400; ++i)
    accessor.setValue(openvdb::Coord(static_cast<int>(60 * rng.uniformAt(4 * i)) - 30,
                                     static_cast<int>(60 * rng.uniformAt(4 * i + 1)) - 30,
                                     static_cast<int>(60 * rng.uniformAt(4 * i + 2)) - 30),
                      static_cast<float>(rng.uniformAt(4 * i + 3)));
  accessor.setValue(openvdb::Coord(1000, -5000, 7), -0.0f);
  accessor.setValue(openvdb::Coord(2, 2, 2), std::numeric_limits<float>::denorm_min());
  return grid;
}

/// The same bits, values and activity of every voxel and tile, and the same transform and metadata.
void expectSameGrid(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
  EXPECT_TRUE(a.tree().hasSameTopology(b.tree()));
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a.background()), std::bit_cast<std::uint32_t>(b.background()));
  EXPECT_EQ(a.transform(), b.transform());
  EXPECT_EQ(a.type(), b.type());
  EXPECT_TRUE(static_cast<const openvdb::MetaMap&>(a) == static_cast<const openvdb::MetaMap&>(b));
  auto x = a.cbeginValueAll(), y = b.cbeginValueAll();
  std::size_t different = 0;
  for (; x && y; ++x, ++y) {
    const float u = *x, v = *y;
    different += x.getCoord() != y.getCoord() || x.isValueOn() != y.isValueOn() ||
                 std::bit_cast<std::uint32_t>(u) != std::bit_cast<std::uint32_t>(v);
  }
  EXPECT_EQ(different, 0u);
  EXPECT_FALSE(x);
  EXPECT_FALSE(y);
}

std::shared_ptr<const ScalarGrid> roundTrip(const ScalarGrid& grid) {
  MemoryStore store;
  return store.load<ScalarGrid>(store.keep(std::make_shared<const ScalarGrid>(grid)));
}

std::string savedBytes(const ScalarGrid& grid) {
  ArchiveWriter to;
  saveValue(to, grid);
  return to.bytes();
}

bool loads(const std::string& bytes) {
  ArchiveReader from(bytes, nullptr);
  return valueType<ScalarGrid>().load(from) != nullptr;
}

TEST(ScalarGridArchive, ConstantsComeBack) {
  for (const double value : {2.5, -0.0, std::numeric_limits<double>::denorm_min()}) {
    const auto loaded = roundTrip(ScalarGrid::constant(value));
    ASSERT_NE(loaded, nullptr);
    EXPECT_TRUE(loaded->isConstant());
    EXPECT_EQ(std::bit_cast<std::uint64_t>(loaded->impl().constant), std::bit_cast<std::uint64_t>(value));
  }
  initializeOpenVdb();
  const FileFrame frame{0.01, FileFrame::Up::Z};
  const auto named = roundTrip(scalarGridOf(openvdb::FloatGrid::create(3.0f), "beta", frame));
  ASSERT_NE(named, nullptr);
  EXPECT_EQ(named->name(), "beta");
  EXPECT_EQ(named->impl().frame.metresPerUnit, 0.01);
  EXPECT_EQ(named->impl().frame.up, FileFrame::Up::Z);
  EXPECT_EQ(named->impl().constant, 3.0);
}

TEST(ScalarGridArchive, PaintedGridsComeBackBitForBit) {
  const ScalarGrid given = scalarGridOf(painted(), "beta", FileFrame{0.01, FileFrame::Up::Z});
  ASSERT_FALSE(given.isConstant());
  const auto loaded = roundTrip(given);
  ASSERT_NE(loaded, nullptr);
  ASSERT_FALSE(loaded->isConstant());
  EXPECT_EQ(loaded->name(), "beta");
  EXPECT_EQ(loaded->impl().frame.up, FileFrame::Up::Z);
  EXPECT_EQ(loaded->impl().content, given.impl().content);
  expectSameGrid(*loaded->impl().grid, *given.impl().grid);
  EXPECT_EQ(savedBytes(*loaded), savedBytes(given));
}

TEST(ScalarGridArchive, SamplesAreTheSameBits) {
  const ScalarGrid given = scalarGridOf(painted(), "beta", FileFrame{});
  const auto loaded = roundTrip(given);
  ASSERT_NE(loaded, nullptr);
  const Rng rng(4);
  std::vector<Vec3> points(5000);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Vec3(1, 2, 3) + 6 * Vec3(rng.uniformAt(3 * i) - 0.5, rng.uniformAt(3 * i + 1) - 0.5,
                                         rng.uniformAt(3 * i + 2) - 0.5);
  std::vector<double> before(points.size()), after(points.size());
  given.sample(points, before);
  loaded->sample(points, after);
  EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size() * sizeof(double)), 0);
  EXPECT_GT(std::count_if(before.begin(), before.end(), [](double v) { return v != 1.5; }), 100);
}

TEST(ScalarGridArchive, NonLinearTransformsComeBack) {
  initializeOpenVdb();
  const auto grid = painted();
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), 0.5, 10, 0.2));
  const ScalarGrid given = scalarGridOf(grid, "camera", FileFrame{});
  const auto loaded = roundTrip(given);
  ASSERT_NE(loaded, nullptr);
  expectSameGrid(*loaded->impl().grid, *given.impl().grid);
}

TEST(ScalarGridArchive, TheDigestFollowsEverythingThatCanBeSeen) {
  const FileFrame frame;
  std::vector<Digest> digests{scalarGridOf(painted(), "beta", frame).impl().content};
  EXPECT_EQ(scalarGridOf(painted(), "beta", frame).impl().content, digests[0]);
  digests.push_back(scalarGridOf(painted(), "gamma", frame).impl().content);
  digests.push_back(scalarGridOf(painted(), "beta", {0.5, FileFrame::Up::Y}).impl().content);
  digests.push_back(scalarGridOf(painted(), "beta", {1, FileFrame::Up::Z}).impl().content);
  const auto changed = [&](const std::function<void(openvdb::FloatGrid&)>& change) {
    const auto grid = painted();
    change(*grid);
    digests.push_back(scalarGridOf(grid, "beta", frame).impl().content);
  };
  changed([](auto& g) { g.insertMeta("pass", openvdb::Int32Metadata(4)); });
  changed([](auto& g) { g.transform().preScale(2); });
  changed([](auto& g) { g.tree().setValue({1000, -5000, 7}, 0.0f); });
  changed([](auto& g) { g.tree().setValue({0, 500, 0}, 1.5f); });  // active, though as the background
  changed([](auto& g) { g.fill({openvdb::Coord(4096), openvdb::Coord(4096 + 4095)}, -0.0f); });
  changed([](auto& g) { g.fill({openvdb::Coord(4096), openvdb::Coord(4096 + 4095)}, 0.0f); });
  digests.push_back(ScalarGrid::constant(0.0).impl().content);
  digests.push_back(ScalarGrid::constant(-0.0).impl().content);
  const std::size_t all = digests.size();
  std::sort(digests.begin(), digests.end());
  EXPECT_EQ(std::unique(digests.begin(), digests.end()) - digests.begin(), static_cast<std::ptrdiff_t>(all));
}

TEST(ScalarGridArchive, TruncatedBytesAreRefused) {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(1.0f);
  grid->tree().setValue({1, 2, 3}, 2.0f);
  for (const auto& value : {ScalarGrid::constant(3), scalarGridOf(grid, "b", FileFrame{})}) {
    const std::string whole = savedBytes(value);
    ASSERT_TRUE(loads(whole));
    for (std::size_t size = 0; size < whole.size(); ++size)
      ASSERT_FALSE(loads(whole.substr(0, size))) << size;
    EXPECT_FALSE(loads(whole + '\0'));
  }
}

TEST(ScalarGridArchive, DamageToTheGridIsRefused) {
  const std::string whole = savedBytes(scalarGridOf(painted(), "beta", FileFrame{}));
  const Rng rng(12);
  std::size_t accepted = 0;
  for (std::uint64_t round = 0; round < 2000; ++round) {
    std::string damaged = whole;
    // The last two thirds are OpenVDB's bytes alone.
    const double where = 1 - rng.uniformAt(2 * round) * 2 / 3;
    auto& byte = damaged[static_cast<std::size_t>(where * static_cast<double>(whole.size() - 1))];
    byte =
        static_cast<char>(byte ^ static_cast<char>(1 + static_cast<int>(rng.uniformAt(2 * round + 1) * 255)));
    accepted += loads(damaged);
  }
  EXPECT_EQ(accepted, 0u);
}

TEST(ScalarGridArchive, DamageAnywhereIsSurvived) {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(1.0f);
  grid->tree().setValue({1, 2, 3}, 2.0f);
  const std::string whole = savedBytes(scalarGridOf(grid, "a name", FileFrame{}));
  std::size_t accepted = 0;
  for (std::size_t at = 0; at < std::min<std::size_t>(whole.size(), 120); ++at)
    for (const int flip : {1, 2, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(flip));
      accepted += loads(damaged);
    }
  EXPECT_GT(accepted, 0u);  // another name is a name too
}

}  // namespace
}  // namespace sherd
