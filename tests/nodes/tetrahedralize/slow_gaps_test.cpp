// Gaps narrower than two offsets of the edge length, which take many tetrahedra.
#include <gtest/gtest.h>

#include "surfaces.h"

namespace sherd::test {
namespace {

TEST(SlowTetrahedralizeGaps, KeepsCloseComponentsApart) {
  expectGood(cageOf(joined(sphere(Vec3::Zero(), 1), sphere(Vec3(2.2, 0, 0), 1)), 600), 2, 4);
}

TEST(SlowTetrahedralizeGaps, KeepsANarrowSlitOpen) {
  const auto cage = cageOf(slitBlock(0.15), 400);
  expectGood(cage, 1, 2);
  EXPECT_FALSE(holds(*cage, Vec3(0.5, 0.7, 0.25)));
}

}  // namespace
}  // namespace sherd::test
