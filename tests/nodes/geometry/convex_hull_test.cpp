#include "geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/rng.h"
#include "geometry/solid.h"

namespace sherd {
namespace {

HullMesh hullOf(const std::vector<Vec3>& points) {
  const auto hull = convexHull(points);
  EXPECT_TRUE(hull.ok()) << (hull.ok() ? "" : hull.error().text());
  return hull.ok() ? *hull : HullMesh{};
}

TEST(ConvexHull, FewPointsAndPointsOfOneLineMakeNoTriangle) {
  EXPECT_TRUE(hullOf({}).triangles.empty());
  EXPECT_TRUE(hullOf({Vec3(1, 2, 3)}).triangles.empty());
  EXPECT_TRUE(hullOf({Vec3(1, 2, 3), Vec3(1, 2, 3)}).triangles.empty());
  const HullMesh line = hullOf({Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(3, 3, 3), Vec3(2, 2, 2)});
  EXPECT_TRUE(line.triangles.empty());
  EXPECT_TRUE(line.flat);
}

TEST(ConvexHull, PointsOfOnePlaneMakeTheirPolygonFromBothSides) {
  const HullMesh hull =
      hullOf({Vec3(0, 0, 5), Vec3(2, 0, 5), Vec3(2, 2, 5), Vec3(0, 2, 5), Vec3(1, 1, 5), Vec3(1, 0, 5)});
  EXPECT_TRUE(hull.flat);
  EXPECT_EQ(hull.positions.size(), 4u);
  EXPECT_EQ(hull.triangles.size(), 4u);
  EXPECT_EQ(hull.volume, 0);
  Vec3 areas = Vec3::Zero();
  for (const Triangle& t : hull.triangles)
    areas += (hull.positions[at(t[1])] - hull.positions[at(t[0])])
                 .cross(hull.positions[at(t[2])] - hull.positions[at(t[0])]);
  EXPECT_EQ(areas, Vec3::Zero());
}

TEST(ConvexHull, OfATetrahedronAndOfACube) {
  const HullMesh tet = hullOf({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
  EXPECT_EQ(tet.triangles.size(), 4u);
  EXPECT_DOUBLE_EQ(tet.volume, 1.0 / 6);
  EXPECT_FALSE(tet.flat);
  std::vector<Vec3> points;
  for (int i = 0; i < 27; ++i) points.emplace_back(i % 3, i / 3 % 3, i / 9);
  const HullMesh cube = hullOf(points);
  EXPECT_EQ(cube.positions.size(), 8u);
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(cube.volume, 8);
}

TEST(ConvexHull, APointAHairOffThePlaneIsNotFlat) {
  const double hair = std::numeric_limits<double>::denorm_min();
  const HullMesh hull = hullOf({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.3, 0.3, hair)});
  EXPECT_FALSE(hull.flat);
  EXPECT_EQ(hull.triangles.size(), 4u);
}

TEST(ConvexHull, NotFiniteIsAnError) {
  const std::vector<Vec3> points{Vec3(0, 0, 0), Vec3(1, std::numeric_limits<double>::quiet_NaN(), 0)};
  EXPECT_FALSE(convexHull(points).ok());
}

}  // namespace
}  // namespace sherd
