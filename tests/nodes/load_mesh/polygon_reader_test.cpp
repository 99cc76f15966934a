#include "load_mesh/polygon_fan.h"
#include "reader_checks.h"

namespace sherd {
namespace {

std::vector<Triangle> split(const std::vector<Vec3>& corners) {
  std::vector<Triangle> triangles;
  splitPolygon(corners, triangles);
  EXPECT_EQ(triangles.size(), corners.size() - 2);
  return triangles;
}

/// All triangles turn with the polygon, and together have its area.
void expectTiling(const std::vector<Vec3>& corners, const Vec3& normal, double area) {
  double sum = 0;
  for (const Triangle& t : split(corners)) {
    const Vec3& a = corners[at(t[0])];
    const double twice = (corners[at(t[1])] - a).cross(corners[at(t[2])] - a).dot(normal);
    EXPECT_GT(twice, 0);
    sum += 0.5 * twice;
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
}

TEST(PolygonReader, ConvexOnesBecomeFans) {
  EXPECT_EQ(split({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(split({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(PolygonReader, ConcaveOnesAreTiled) {
  const Vec3 z(0, 0, 1);
  expectTiling({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}}, z, 10);
  expectTiling({{2, 1, 5}, {0, 4, 5}, {0, 0, 5}, {4, 0, 5}, {4, 4, 5}}, z, 10);
  expectTiling({{0, 0, 0}, {1, 1, 0}, {0, 3, 0}, {-1, 1, 0}}, z, 3);
  expectTiling({{0, -1, 0}, {-1, 1, 0}, {0, 0.5, 0}, {1, 1, 0}}, Vec3(0, 0, -1),
               1.5);  // clockwise arrow head
}

TEST(PolygonReader, CornersOnASide) {
  expectTiling({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, Vec3(0, 0, 1), 4);
}

TEST(PolygonReader, BridgeToAHole) {
  expectTiling({{0, 0, 0},
                {4, 0, 0},
                {4, 4, 0},
                {0, 4, 0},
                {0, 0, 0},
                {1, 1, 0},
                {1, 3, 0},
                {3, 3, 0},
                {3, 1, 0},
                {1, 1, 0}},
               Vec3(0, 0, 1), 12);
}

TEST(PolygonReader, RandomStarsInAnyPlaneFarFromTheOrigin) {
  Rng rng(11);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Quaterniond turn(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5,
                                  rng.uniform() - 0.5);
    const Mat3 rotation = turn.normalized().toRotationMatrix();
    const std::size_t n = 4 + rng.below(30);
    std::vector<Vec3> corners;
    double area = 0, before = 0, first = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n),
                   r = 0.2 + rng.uniform();
      corners.push_back(rotation * Vec3(r * std::cos(angle), r * std::sin(angle), 0) + Vec3(64, -32, 16));
      area += 0.5 * r * before * std::sin(2 * M_PI / static_cast<double>(n));
      before = r;
      if (i == 0) first = r;
    }
    area += 0.5 * first * before * std::sin(2 * M_PI / static_cast<double>(n));
    double sum = 0;
    for (const Triangle& t : split(corners)) {
      const Vec3& a = corners[at(t[0])];
      const double twice = (corners[at(t[1])] - a).cross(corners[at(t[2])] - a).dot(rotation.col(2));
      EXPECT_GT(twice, -1e-13);
      sum += 0.5 * twice;
    }
    EXPECT_NEAR(sum, area, 1e-11);
  }
}

TEST(PolygonReader, DegenerateOnesStayWhole) {
  split({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  split({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});  // a bow tie
  split({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const double nan = std::nan("");
  split({{0, 0, 0}, {1, 0, 0}, {nan, 1, 0}, {0, 1, 0}});
}

TEST(PolygonReader, ManyCornersAreFast) {
  std::vector<Vec3> comb;  // 1000 corners, half of them reflex
  for (int i = 0; i < 500; ++i) comb.emplace_back(i, i % 2, 0);
  for (int i = 499; i >= 0; --i) comb.emplace_back(i, 2 + i % 2, 0);
  expectTiling(comb, Vec3(0, 0, 1), 2 * 499);
}

}  // namespace
}  // namespace sherd
