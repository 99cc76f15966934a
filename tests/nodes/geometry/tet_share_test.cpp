#include "geometry/tet_share.h"

#include <gtest/gtest.h>

#include <numeric>

#include "base/rng.h"
#include "support/elastic_loads.h"

using namespace sherd;

namespace {

using Corners = std::array<Vec3, 4>;
using Barycentric = Eigen::Matrix4d;  // of four points, by columns

double determinant(const Corners& x) { return (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])); }

/// Of a part with four corners, as shares of the whole.
ShareProducts productsOf(const Barycentric& part) {
  const Vec4 sum = part.rowwise().sum();
  return std::abs(part.determinant()) / 20 * (part * part.transpose() + sum * sum.transpose());
}

std::vector<Index> allOf(const TriMesh& surface) {
  std::vector<Index> held(surface.triangles.size());
  std::iota(held.begin(), held.end(), 0);
  return held;
}

/// A box, moved.
TriMesh boxAt(const Vec3& low, const Vec3& high) {
  TriMesh surface = *families::box(1, 1, 1, high - low).surface;
  for (Vec3& p : surface.positions) p += low;
  return surface;
}

Corners someTet() { return {Vec3(0.1, 0.2, 0), Vec3(1.3, 0, 0.1), Vec3(0.2, 1.1, -0.1), Vec3(0, 0.3, 1.2)}; }

/// Even, so that orientation stays.
constexpr std::size_t kTurns[4][4] = {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 3, 0, 1}, {3, 0, 2, 1}};

TEST(TetShare, WholeAndNothing) {
  const TriMesh around = boxAt(Vec3::Constant(-9), Vec3::Constant(9));
  const TetShare share(someTet(), around.positions, around.triangles);
  EXPECT_TRUE(share.products({}, true).isApprox(wholeProducts(), 1e-15));
  EXPECT_NEAR(wholeProducts().sum(), 1, 1e-15);
  EXPECT_EQ(share.products(allOf(around), false).norm(), 0);
}

/// A box that holds all above a height cuts off a corner, or leaves one.
TEST(TetShare, ACornerCutOff) {
  for (const auto& turn : kTurns) {
    Corners x;
    for (std::size_t c = 0; c < 4; ++c) x[c] = someTet()[turn[c]];
    std::size_t top = 0;
    for (std::size_t c = 1; c < 4; ++c)
      if (x[c].z() > x[top].z()) top = c;
    const double height = 0.4;
    Barycentric part = Barycentric::Identity();
    for (std::size_t c = 0; c < 4; ++c) {
      if (c == top) continue;
      const double s = (height - x[c].z()) / (x[top].z() - x[c].z());
      part(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(c)) = 1 - s;
      part(static_cast<Eigen::Index>(top), static_cast<Eigen::Index>(c)) = s;
    }
    const TriMesh above = boxAt(Vec3(-9, -9, height), Vec3::Constant(9));
    const TriMesh below = boxAt(Vec3::Constant(-9), Vec3(9, 9, height));
    const TetShare corner(x, above.positions, above.triangles), rest(x, below.positions, below.triangles);
    const ShareProducts found = corner.products(allOf(above), top == 3);
    EXPECT_LT((found - productsOf(part)).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((rest.products(allOf(below), top != 3) + found - wholeProducts()).cwiseAbs().maxCoeff(), 1e-15);
  }
}

/// Halves add up to the whole, and everything to the volume, where a round surface goes through.
TEST(TetShare, PartsAddUp) {
  const TriMesh ball = *families::ball(6, 1).surface;
  const std::vector<Index> held = allOf(ball);
  const auto inside = [](const Vec3& p) { return p.norm() < 0.97; };
  Rng rng(7);
  int cut = 0;
  for (int i = 0; i < 600; ++i) {
    Corners x;
    for (Vec3& p : x) p = 2 * Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
    if (determinant(x) < 0) std::swap(x[0], x[1]);
    const Vec3 middle = 0.5 * (x[0] + x[1]);
    const auto unclear = [](const Vec3& p) { return p.norm() > 0.93 && p.norm() < 1.01; };
    if (determinant(x) < 0.01 || unclear(x[3])) continue;
    const TetShare whole(x, ball.positions, ball.triangles);
    const ShareProducts products = whole.products(held, inside(x[3]));
    EXPECT_NEAR(products.sum(), whole.volume(held, inside(x[3])) / (determinant(x) / 6), 1e-12);
    cut += products.sum() > 1e-3 && products.sum() < 1 - 1e-3 ? 1 : 0;
    ShareProducts sum = ShareProducts::Zero();
    for (std::size_t half = 0; half < 2; ++half) {
      Corners y = x;
      y[half] = middle;
      Barycentric to = Barycentric::Identity();  // from the half's coordinates to those of the whole
      to.col(static_cast<Eigen::Index>(half)) = Vec4(0.5, 0.5, 0, 0);
      const TetShare share(y, ball.positions, ball.triangles);
      sum += 0.5 * to * share.products(held, inside(x[3])) * to.transpose();
    }
    EXPECT_LT((sum - products).cwiseAbs().maxCoeff(), 1e-13);
  }
  EXPECT_GT(cut, 50);
}

}  // namespace
