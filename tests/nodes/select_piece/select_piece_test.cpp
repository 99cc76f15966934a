#include "select_piece/select_piece.h"

#include <gtest/gtest.h>

#include "geometry/solid.h"
#include "support/fragment_families.h"

namespace sherd {
namespace {

/// A box in three slices, with everything that a source can carry.
Fragments slicedSource() {
  TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(3, 1, 1));
  box.colorSets.resize(1);
  box.colorSets[0].name = "tint";
  for (std::size_t c = 0; c < box.cornerCount(); ++c) {
    const Vec3& p = box.positions[at(box.triangles[c / 3][c % 3])];
    box.uvSets[0].uv[c] = Vec2(p.x(), p.y() - p.z());
    box.colorSets[0].rgba.push_back(Vec4(p.x() / 3, p.y(), p.z(), 0.5));
  }
  box.frame = {0.01, FileFrame::Up::Z};
  box.source = "box.obj";
  return test::slices(std::move(box), {0.5, 2.25});
}

TriMesh selected(const Fragments& f, const SelectPieceParams& params) {
  const auto piece = selectPiece(f, params, Exec{});
  EXPECT_TRUE(piece.ok()) << (piece.ok() ? "" : piece.error().text());
  return piece.ok() ? piece->mesh : TriMesh{};
}

TEST(SelectPiece, ByNameAndBySize) {
  const Fragments f = slicedSource();
  EXPECT_EQ(selected(f, {.piece = "piece_0001"}).piece, "piece_0001");
  EXPECT_EQ(selected(f, {}).piece, "piece_0002");  // from 0.5 to 2.25
  EXPECT_EQ(selected(f, {.number = 2}).piece, "piece_0003");
  EXPECT_EQ(selected(f, {.number = 3}).piece, "piece_0001");
}

TEST(SelectPiece, IsAClosedSurfaceOfWhatThePieceUses) {
  const Fragments f = slicedSource();
  for (const Piece& p : f.pieces) {
    const TriMesh mesh = selected(f, {.piece = p.name});
    EXPECT_EQ(mesh.triangles.size(), p.surface.size() + p.crack.size());
    EXPECT_NEAR(solidVolume(mesh.positions, mesh.triangles), p.volume, 1e-15);
    std::vector<bool> used(mesh.positions.size(), false);
    for (const Triangle& t : mesh.triangles)
      for (const Index v : t) used[at(v)] = true;
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
    EXPECT_EQ(mesh.source, "box.obj");
    EXPECT_EQ(mesh.frame.metresPerUnit, 0.01);
    EXPECT_EQ(mesh.frame.up, FileFrame::Up::Z);
  }
}

TEST(SelectPiece, OutsideAttributesAreAsTheyCameAndTheCrackIsInside) {
  const Fragments f = slicedSource();
  const Piece& piece = f.pieces[1];
  const TriMesh mesh = selected(f, {});
  ASSERT_EQ(mesh.materials, (std::vector<std::string>{"paint", "base", "inside"}));
  ASSERT_EQ(mesh.normals.size(), mesh.cornerCount());
  ASSERT_EQ(mesh.uvSets.size(), 1u);
  EXPECT_EQ(mesh.uvSets[0].name, "map1");
  EXPECT_EQ(mesh.colorSets[0].name, "tint");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool isCrack = t >= piece.surface.size();
    EXPECT_EQ(mesh.materialOf[t] == 2, isCrack);
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      const Vec3& p = mesh.positions[at(mesh.triangles[t][c - 3 * t])];
      EXPECT_NEAR(mesh.normals[c].norm(), 1, 1e-12);
      if (isCrack) {
        EXPECT_NEAR(std::abs(mesh.normals[c].x()), 1, 1e-12);
        EXPECT_EQ(mesh.colorSets[0].rgba[c], Vec4::Ones());
        EXPECT_TRUE(mesh.uvSets[0].uv[c].allFinite());
        continue;
      }
      EXPECT_LT((mesh.uvSets[0].uv[c] - Vec2(p.x(), p.y() - p.z())).norm(), 1e-12);
      EXPECT_LT((mesh.colorSets[0].rgba[c] - Vec4(p.x() / 3, p.y(), p.z(), 0.5)).norm(), 1e-12);
      EXPECT_EQ(mesh.normals[c].x(), 0);
    }
  }
}

TEST(SelectPiece, ABodyWithoutAttributesGivesMaterialsOnly) {
  TriMesh plain;
  const TriMesh box = test::boxMesh(Vec3::Zero(), Vec3(3, 1, 1));
  plain.positions = box.positions;
  plain.triangles = box.triangles;
  const TriMesh mesh = selected(test::slices(plain, {1.1}), {});
  EXPECT_EQ(mesh.materials, (std::vector<std::string>{"outside", "inside"}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvSets.empty());
}

TEST(SelectPiece, PartsThatTouchGetVerticesOfTheirOwn) {
  // Two boxes that meet in a point, as one piece.
  TriMesh mesh = test::boxMesh(Vec3::Zero(), Vec3::Ones());
  const TriMesh other = test::boxMesh(Vec3::Ones(), Vec3(2, 2, 2));
  for (const Triangle& t : other.triangles) {
    Triangle own;
    for (std::size_t c = 0; c < 3; ++c) own[c] = t[c] == 0 ? 7 : t[c] + 7;
    mesh.triangles.push_back(own);
  }
  mesh.positions.insert(mesh.positions.end(), other.positions.begin() + 1, other.positions.end());
  TriMesh plain;
  plain.positions = mesh.positions;
  plain.triangles = mesh.triangles;
  const auto piece = selectPiece(test::slices(plain, {}), {}, Exec{});
  ASSERT_TRUE(piece.ok()) << piece.error().text();
  EXPECT_EQ(piece->touching, 1u);
  EXPECT_EQ(piece->mesh.positions.size(), 16u);
  EXPECT_NEAR(solidVolume(piece->mesh.positions, piece->mesh.triangles), 2, 1e-15);
}

TEST(SelectPiece, SaysWhichPiecesThereAre) {
  const Fragments f = slicedSource();
  const auto noName = selectPiece(f, {.piece = "piece_0009"}, Exec{});
  ASSERT_FALSE(noName.ok());
  EXPECT_EQ(noName.error().port, "piece");
  EXPECT_NE(noName.error().text().find("piece_0001 to piece_0003"), std::string::npos);
  const auto noNumber = selectPiece(f, {.number = 4}, Exec{});
  ASSERT_FALSE(noNumber.ok());
  EXPECT_EQ(noNumber.error().port, "number");
  EXPECT_NE(noNumber.error().text().find("3 pieces"), std::string::npos);
  EXPECT_FALSE(selectPiece(Fragments{}, {}, Exec{}).ok());
}

}  // namespace
}  // namespace sherd
