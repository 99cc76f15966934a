// Fields for the tests of this folder, and ways to look at them.
#pragma once

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "types/scalar_grid_vdb.h"

// OpenVDB's library has what the virtual functions of its own types of grids call.
extern template class openvdb::tree::Tree<openvdb::DoubleTree::RootNodeType>;
extern template class openvdb::Grid<openvdb::DoubleTree>;

namespace sherd::test {

inline double sampleAt(const ScalarGrid& grid, const Vec3& p) {
  double value = 0;
  grid.sample({&p, 1}, {&value, 1});
  return value;
}

inline Digest digestOf(const ScalarGrid& grid) {
  Hasher hasher;
  hashValue(hasher, grid);
  return hasher.digest();
}

inline openvdb::FloatGrid::Ptr gridOf(float background, double voxel = 0.1) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(background);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  return grid;
}

/// Random values in a cube of n³ voxels, three quarters of them active.
inline void scatter(openvdb::FloatGrid& grid, int n, std::uint64_t seed, double scale = 1) {
  const Rng rng(seed);
  std::uint64_t next = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k, next += 2)
        if (rng.uniformAt(next) < 0.75)
          grid.tree().setValue({i, j, k}, static_cast<float>(scale * (rng.uniformAt(next + 1) - 0.25)));
}

/// Any affine transform, far from singular.
inline openvdb::math::Transform::Ptr affineTransform(std::uint64_t seed) {
  const Rng rng(seed, 7);
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      matrix(row, column) = (row == column ? 0.1 : 0) +
                            0.06 * (rng.uniformAt(static_cast<std::uint64_t>(3 * row + column)) - 0.5);
  return openvdb::math::Transform::createLinearTransform(matrix);
}

/// Same voxels, values, background and transform.
inline void expectSame(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
  EXPECT_EQ(a.background(), b.background());
  EXPECT_EQ(a.transform(), b.transform());
  EXPECT_EQ(a.activeVoxelCount(), b.activeVoxelCount());
  EXPECT_TRUE(a.tree().hasSameTopology(b.tree()));
  std::size_t differing = 0;
  for (auto value = a.cbeginValueAll(); value; ++value)
    differing += b.tree().getValue(value.getCoord()) != *value;
  EXPECT_EQ(differing, 0u);
}

inline const openvdb::FloatGrid& voxelsOf(const ScalarGrid& grid) { return *grid.impl().grid; }

/// The text of a failed result's error; empty where it succeeded.
template <class T>
std::string errorOf(const Result<T>& result) {
  return result.ok() ? std::string() : result.error().port + ": " + result.error().text();
}

inline testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << text << "' does not say '" << part << "'";
}

/// Sets the limit on threads, and sets it back.
struct Threads {
  explicit Threads(int limit) { setThreadLimit(limit); }
  ~Threads() { setThreadLimit(0); }
};

}  // namespace sherd::test
