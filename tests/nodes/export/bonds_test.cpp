#include "export/bonds.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/fragment_families.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

std::vector<Bond> mustFind(const Fragments& f) {
  const auto bonds = findBonds(f, Exec{});
  EXPECT_TRUE(bonds.ok()) << (bonds.ok() ? "" : bonds.error().text());
  return bonds.ok() ? *bonds : std::vector<Bond>{};
}

TEST(Bonds, OnePieceHasNone) { EXPECT_TRUE(mustFind(test::slicedBox(1)).empty()); }

TEST(Bonds, AreThoseOfThePlanesBetweenSlices) {
  // Far from the origin, where sums about the origin would lose their digits.
  const Vec3 low(1e6, -1e6, 1e6);
  const Fragments f = test::slices(test::boxMesh(low, low + Vec3(3, 2, 1)), {low.x() + 0.9, low.x() + 2.2});
  const std::vector<Bond> bonds = mustFind(f);
  ASSERT_EQ(bonds.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(bonds[k].low, static_cast<Index>(k));
    EXPECT_EQ(bonds[k].high, static_cast<Index>(k) + 1);
    EXPECT_NEAR(bonds[k].area, 2, 1e-9);
    EXPECT_LT((bonds[k].centroid - low - Vec3(k == 0 ? 0.9 : 2.2, 1, 0.5)).norm(), 1e-9);
    EXPECT_LT((bonds[k].normal - Vec3::UnitX()).norm(), 1e-12);
  }
  const auto byPiece = bondsByPiece(bonds, 3);
  EXPECT_EQ(byPiece[0].size(), 1u);
  ASSERT_EQ(byPiece[1].size(), 2u);
  EXPECT_EQ(byPiece[1][0].low, 0);
  EXPECT_EQ(byPiece[1][1].high, 2);
}

TEST(Bonds, SeveralSheetsBetweenTwoPiecesAreOneBond) {
  Fragments f = test::slicedBox(2);
  for (Piece& piece : f.pieces)
    for (std::size_t t = 0; t < piece.crack.size(); ++t) {
      const Triangle& c = piece.crack[t];
      piece.crackSheet[t] = (c[0] + c[1] + c[2]) % 2;  // the same for twins
    }
  const std::vector<Bond> bonds = mustFind(f);
  ASSERT_EQ(bonds.size(), 1u);
  EXPECT_NEAR(bonds[0].area, 1, 1e-12);
}

TEST(Bonds, AContactAllAroundHasNoDirection) {
  const TriMesh sphere = families::sphereSurface(Vec3(3, 2, 1), 0.5, 64, 32);
  Fragments f;
  f.positions = sphere.positions;
  f.pieces.resize(2);
  for (const Triangle& t : sphere.triangles) {
    f.pieces[0].crack.push_back(t);
    f.pieces[1].crack.push_back({t[0], t[2], t[1]});
  }
  for (std::size_t p = 0; p < 2; ++p) {
    f.pieces[p].crackNeighbour.assign(sphere.triangles.size(), static_cast<Index>(1 - p));
    f.pieces[p].crackSheet.assign(sphere.triangles.size(), 0);
  }
  const std::vector<Bond> bonds = mustFind(f);
  ASSERT_EQ(bonds.size(), 1u);
  EXPECT_NEAR(bonds[0].area, std::numbers::pi, 0.01);
  EXPECT_LT((bonds[0].centroid - Vec3(3, 2, 1)).norm(), 1e-12);
  EXPECT_EQ(bonds[0].normal, Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace sherd
