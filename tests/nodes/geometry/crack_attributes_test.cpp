#include "geometry/crack_attributes.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "base/parallel.h"
#include "base/rng.h"
#include "geometry/shelf_packing.h"
#include "geometry/surface_charts.h"
#include "support/fragment_families.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

/// Two pieces that touch in the given triangles, which face outward from the first; sheet by triangle.
Fragments touching(std::vector<Vec3> positions, const std::vector<Triangle>& triangles,
                   const std::function<Index(std::size_t)>& sheetOf) {
  Fragments f;
  f.positions = std::move(positions);
  f.pieces.resize(2);
  for (std::size_t p = 0; p < 2; ++p) f.pieces[p].name = "piece_000" + std::to_string(p + 1);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    // The twins come in another order and begin at another corner.
    const std::size_t j = triangles.size() - 1 - i;
    const Triangle& u = triangles[j];
    f.pieces[0].crack.push_back(t);
    f.pieces[1].crack.push_back({u[1], u[0], u[2]});
    f.pieces[0].crackNeighbour.push_back(1);
    f.pieces[1].crackNeighbour.push_back(0);
    f.pieces[0].crackSheet.push_back(sheetOf(i));
    f.pieces[1].crackSheet.push_back(sheetOf(j));
  }
  return f;
}

Fragments touching(const TriMesh& mesh) {
  return touching(mesh.positions, mesh.triangles, [](std::size_t) { return 0; });
}

/// A grid of (n + 1)² points over the unit square, lifted by `place`.
Fragments grid(int n, const std::function<Vec3(double, double)>& place) {
  TriMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      mesh.positions.push_back(place(static_cast<double>(i) / n, static_cast<double>(j) / n));
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const Index a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return touching(mesh);
}

CrackAttributes mustMake(const Fragments& f) {
  auto made = crackAttributes(f, Exec{});
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().text());
  return made.ok() ? *made : CrackAttributes{};
}

/// Far enough from a line for its plane to mean something.
bool isFirm(const Fragments& f, const Triangle& t) {
  const Vec3 x = f.positions[at(t[1])] - f.positions[at(t[0])],
             y = f.positions[at(t[2])] - f.positions[at(t[0])];
  return x.cross(y).norm() > 1e-8 * std::max({x.norm(), y.norm(), (x - y).norm()});
}

struct Stretch {
  double least = 1e300, most = 0;  ///< singular values of the maps from triangles to the texture
};

Stretch stretchOf(const Fragments& f, const CrackAttributes& a) {
  Stretch stretch;
  for (std::size_t p = 0; p < f.pieces.size(); ++p)
    for (std::size_t t = 0; t < f.pieces[p].crack.size(); ++t) {
      const Triangle& c = f.pieces[p].crack[t];
      if (!isFirm(f, c)) continue;
      const Vec3 x = f.positions[at(c[1])] - f.positions[at(c[0])],
                 y = f.positions[at(c[2])] - f.positions[at(c[0])];
      const double length = x.norm(), along = x.dot(y) / length;
      Eigen::Matrix2d plane, texture;
      plane << length, along, 0, std::sqrt(y.squaredNorm() - along * along);
      texture.col(0) = a.pieces[p].uvs[3 * t + 1] - a.pieces[p].uvs[3 * t];
      texture.col(1) = a.pieces[p].uvs[3 * t + 2] - a.pieces[p].uvs[3 * t];
      const Eigen::Matrix2d map = texture * plane.inverse(), square = map.transpose() * map;
      const double middle = square.trace() / 2,
                   spread = std::sqrt(std::max(0.0, middle * middle - square.determinant()));
      stretch.least = std::min(stretch.least, std::sqrt(std::max(0.0, middle - spread)));
      stretch.most = std::max(stretch.most, std::sqrt(middle + spread));
    }
  return stretch;
}

/// Within the bound that is promised, with twins alike and islands apart.
void expectSound(const Fragments& f, const CrackAttributes& a) {
  const Stretch stretch = stretchOf(f, a);
  EXPECT_GE(stretch.least, kLeastChartScale - 1e-6);
  EXPECT_LE(stretch.most, 1 + 1e-6);
  std::map<std::pair<Triangle, Index>, std::pair<Vec3, Vec2>> corners;
  std::vector<Eigen::AlignedBox2d> boxes(a.islands);
  for (std::size_t p = 0; p < f.pieces.size(); ++p)
    for (std::size_t t = 0; t < f.pieces[p].crack.size(); ++t) {
      Triangle key = f.pieces[p].crack[t];
      std::sort(key.begin(), key.end());
      const Vec3 face =
          (f.positions[at(f.pieces[p].crack[t][1])] - f.positions[at(f.pieces[p].crack[t][0])])
              .cross(f.positions[at(f.pieces[p].crack[t][2])] - f.positions[at(f.pieces[p].crack[t][0])]);
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& normal = a.pieces[p].normals[3 * t + c];
        const Vec2& uv = a.pieces[p].uvs[3 * t + c];
        EXPECT_NEAR(normal.norm(), 1, 1e-14);
        EXPECT_TRUE(normal.dot(face) > 0 || !isFirm(f, f.pieces[p].crack[t]));
        EXPECT_TRUE((uv.array() >= 0).all() && (uv.array() <= a.extent.array()).all());
        boxes.at(at(a.pieces[p].island[t])).extend(uv);
        const auto [known, isNew] = corners.try_emplace({key, f.pieces[p].crack[t][c]}, normal, uv);
        if (isNew) continue;
        EXPECT_EQ(known->second.first, Vec3(-normal));
        EXPECT_EQ(known->second.second, uv);
      }
    }
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(boxes[i].intersects(boxes[j]));
}

TEST(CrackAttributes, NothingBroke) {
  const Fragments f = test::slicedBox(1);
  const CrackAttributes a = mustMake(f);
  ASSERT_EQ(a.pieces.size(), 1u);
  EXPECT_TRUE(a.pieces[0].normals.empty());
  EXPECT_EQ(a.islands, 0u);
}

TEST(CrackAttributes, ALonelyCrackTriangleIsAnError) {
  for (const int what : {0, 1, 2}) {
    Fragments f = test::slicedBox(2);
    Piece& piece = f.pieces[1];
    if (what == 0) {
      piece.crack.pop_back(), piece.crackNeighbour.pop_back(), piece.crackSheet.pop_back();
    } else if (what == 1) {
      std::swap(piece.crack[0][0], piece.crack[0][1]);
    } else {
      piece.crackSheet[0] = 7;
    }
    const auto made = crackAttributes(f, Exec{});
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().port, "pieces");
    EXPECT_NE(made.error().what.find("has no twin in"), std::string::npos) << made.error().what;
  }
}

TEST(CrackAttributes, FlatSheetsAreLaidOutWithoutStretch) {
  for (const double away : {0.0, 1e6}) {
    const Vec3 low(away + 0.1, -away + 0.2, 0.3);
    const Fragments f =
        test::slices(test::boxMesh(low, low + Vec3(4.7, 1.3, 1.9)), {low.x() + 1, low.x() + 3});
    const CrackAttributes a = mustMake(f);
    expectSound(f, a);
    EXPECT_EQ(a.islands, 2u);
    const double tolerance = 1e-12 + 1e-14 * away;
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t t = 0; t < f.pieces[p].crack.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t d = (c + 1) % 3;
          const Triangle& corners = f.pieces[p].crack[t];
          const double length = (f.positions[at(corners[c])] - f.positions[at(corners[d])]).norm();
          EXPECT_NEAR((a.pieces[p].uvs[3 * t + c] - a.pieces[p].uvs[3 * t + d]).norm(), length, tolerance);
          EXPECT_NEAR(std::abs(a.pieces[p].normals[3 * t + c].x()), 1, 1e-12);
        }
  }
}

TEST(CrackAttributes, TexturesStandUprightOnSteepFacesAndPointAwayOnFlatOnes) {
  for (const bool isFlat : {false, true}) {
    const Fragments f =
        grid(3, [&](double s, double t) { return isFlat ? Vec3(t, 0.3 * s, s) : Vec3(t, s, 0.3 * s); });
    const CrackAttributes a = mustMake(f);
    for (std::size_t i = 0; i < f.pieces[0].crack.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& here = f.positions[at(f.pieces[0].crack[i][c])];
        const Vec3& there = f.positions[at(f.pieces[0].crack[i][(c + 1) % 3])];
        const Vec2 way = a.pieces[0].uvs[3 * i + (c + 1) % 3] - a.pieces[0].uvs[3 * i + c];
        EXPECT_NEAR(way.y(), (isFlat ? here.z() - there.z() : there.y() - here.y()) * std::sqrt(1.09), 1e-12);
      }
  }
}

TEST(CrackAttributes, ACylinderIsSmoothAndFallsIntoFewIslands) {
  constexpr int kSides = 36;
  const Fragments f = grid(kSides, [](double s, double t) {
    return Vec3(std::cos(std::numbers::pi * s), 2 * t, std::sin(std::numbers::pi * s));
  });
  const CrackAttributes a = mustMake(f);
  expectSound(f, a);
  EXPECT_GE(a.islands, 4u);  // 180° in pieces of 50°
  EXPECT_LE(a.islands, 6u);
  for (std::size_t t = 0; t < f.pieces[0].crack.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& x = f.positions[at(f.pieces[0].crack[t][c])];
      const Vec3 radial(x.x(), 0, x.z());
      const bool isRim = std::abs(x.z()) < 1e-9;
      EXPECT_GT(std::abs(radial.dot(a.pieces[0].normals[3 * t + c])),
                std::cos((isRim ? 2.6 : 1e-6) / kSides));
    }
}

TEST(CrackAttributes, AClosedContactIsCoveredToo) {
  const Fragments f = touching(families::sphereSurface(Vec3(3, 2, 1), 0.5, 48, 24));
  const CrackAttributes a = mustMake(f);
  expectSound(f, a);
  EXPECT_LE(a.islands, 60u);
  for (std::size_t t = 0; t < f.pieces[0].crack.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 radial = (f.positions[at(f.pieces[0].crack[t][c])] - Vec3(3, 2, 1)).normalized();
      EXPECT_GT(radial.dot(a.pieces[0].normals[3 * t + c]), std::cos(0.02));
    }
}

TEST(CrackAttributes, SheetsMeetInACrease) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}};
  const std::vector<Triangle> triangles{{0, 2, 1}, {0, 3, 2}, {0, 4, 5}, {0, 5, 3}};
  const Fragments two =
      touching(positions, triangles, [](std::size_t i) { return static_cast<Index>(i / 2); });
  CrackAttributes a = mustMake(two);
  EXPECT_EQ(a.islands, 2u);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(a.pieces[0].normals[i].cwiseAbs(), i < 6 ? Vec3(0, 1, 0) : Vec3(1, 0, 0));
  // As one sheet it is smooth at the edge between them.
  const Fragments one = touching(positions, triangles, [](std::size_t) { return 0; });
  a = mustMake(one);
  expectSound(one, a);
  EXPECT_NEAR(std::abs(a.pieces[0].normals[0].x()), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(a.pieces[0].normals[2].cwiseAbs(), Vec3(0, 1, 0));
}

TEST(CrackAttributes, ThinTrianglesDoNotTurnNormals) {
  // A fan around the origin with one sliver whose plane is upright.
  std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1e-13, 1e-16}, {-1, 1, 0}, {0, -1, 0}};
  const Fragments f =
      touching(positions, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}, [](std::size_t) { return 0; });
  const CrackAttributes a = mustMake(f);
  EXPECT_EQ(a.islands, 1u);
  for (const Vec3& normal : a.pieces[0].normals) EXPECT_GT(normal.z(), 1 - 1e-12);
}

TEST(CrackAttributes, RandomReliefsKeepTheBound) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    Rng rng(seed);
    std::vector<double> heights(17 * 17);
    for (double& height : heights) height = 0.02 * static_cast<double>(seed) * rng.uniform();
    const Fragments f = grid(16, [&](double s, double t) {
      return Vec3(s, heights[static_cast<std::size_t>(16 * s) * 17 + static_cast<std::size_t>(16 * t)], t);
    });
    expectSound(f, mustMake(f));
  }
}

TEST(CrackAttributes, SameForAnyNumberOfThreads) {
  const Fragments f = test::slices(families::torusSurface(2, 0.7, 60, 30), {-0.91, -0.32, 0.41, 0.83});
  CrackAttributes made[2];
  for (int run = 0; run < 2; ++run) {
    setThreadLimit(run + 1);
    inArena([&] { made[run] = mustMake(f); });
  }
  setThreadLimit(0);
  expectSound(f, made[0]);
  ASSERT_EQ(made[0].pieces.size(), made[1].pieces.size());
  for (std::size_t p = 0; p < made[0].pieces.size(); ++p) {
    EXPECT_EQ(made[0].pieces[p].normals, made[1].pieces[p].normals);
    EXPECT_EQ(made[0].pieces[p].uvs, made[1].pieces[p].uvs);
    EXPECT_EQ(made[0].pieces[p].island, made[1].pieces[p].island);
  }
}

TEST(CrackAttributes, EndsWhenCancelled) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  EXPECT_EQ(crackAttributes(test::slicedBox(3), exec).error().kind, Error::Kind::Cancelled);
  EXPECT_EQ(crackNormals(test::slicedBox(3), exec).error().kind, Error::Kind::Cancelled);
}

TEST(ShelfPacking, NothingOverlapsAndLittleIsWasted) {
  EXPECT_TRUE(packShelves({}).empty());
  EXPECT_EQ(packShelves({Vec2(2, 0)})[0], Vec2(0, 0));
  Rng rng(5);
  std::vector<Vec2> sizes;
  double area = 0;
  for (int i = 0; i < 200; ++i) {
    sizes.emplace_back(rng.uniform(), rng.uniform());
    area += sizes.back().prod();
  }
  const std::vector<Vec2> places = packShelves(sizes);
  Eigen::AlignedBox2d all;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Eigen::AlignedBox2d box(places[i], places[i] + sizes[i]);
    all.extend(box);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(box.intersects(Eigen::AlignedBox2d(places[j], places[j] + sizes[j])));
  }
  EXPECT_LT(all.volume(), 1.5 * area);
}

}  // namespace
}  // namespace sherd
