// A piece of a piece of a piece: every promise at every level.
#include <gtest/gtest.h>

#include "geometry/solid.h"
#include "select_piece/select_piece.h"
#include "support/broken_again.h"
#include "support/fragment_families.h"
#include "support/promises.h"
#include "support/surface_families.h"

namespace sherd {
namespace {

/// Attributes that are affine functions of the position, so that they can be told anywhere.
Vec2 uvAt(const Vec3& p) { return {p.x() + 2 * p.y(), 3 * p.z() - p.y()}; }
Vec4 colorAt(const Vec3& p) { return {p.x(), p.y(), p.z(), 1}; }

TriMesh withAttributes(TriMesh mesh) {
  mesh.materials = {"glaze"};
  mesh.materialOf.assign(mesh.triangles.size(), 0);
  mesh.uvSets.resize(2);
  mesh.uvSets[0].name = "map1";
  mesh.uvSets[1].name = "dirt";
  mesh.colorSets.resize(1);
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) {
      const Vec3& p = mesh.positions[at(v)];
      mesh.normals.push_back(p.normalized());
      mesh.uvSets[0].uv.push_back(uvAt(p));
      mesh.uvSets[1].uv.push_back(-uvAt(p));
      mesh.colorSets[0].rgba.push_back(colorAt(p));
    }
  mesh.source = "ball.obj";
  return mesh;
}

void expectAttributes(const TriMesh& mesh, double outerArea) {
  const auto inside =
      std::find(mesh.materials.begin(), mesh.materials.end(), "inside") - mesh.materials.begin();
  ASSERT_EQ(mesh.materials, (std::vector<std::string>{"glaze", "inside"}));
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.materialOf[t] == inside) continue;
    const Vec3 corner[3] = {mesh.positions[at(mesh.triangles[t][0])],
                            mesh.positions[at(mesh.triangles[t][1])],
                            mesh.positions[at(mesh.triangles[t][2])]};
    area += (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm() / 2;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT((mesh.uvSets[0].uv[3 * t + c] - uvAt(corner[c])).norm(), 1e-12);
      EXPECT_LT((mesh.uvSets[1].uv[3 * t + c] + uvAt(corner[c])).norm(), 1e-12);
      EXPECT_LT((mesh.colorSets[0].rgba[3 * t + c] - colorAt(corner[c])).norm(), 1e-12);
      EXPECT_LT((mesh.normals[3 * t + c] - corner[c].normalized()).norm(), 0.02);
    }
  }
  EXPECT_NEAR(area, outerArea, 1e-12 * outerArea);
}

/// Breaks `body`, checks the fracture and every piece of it, and returns the largest piece.
Result<TriMesh> level(const TriMesh& body, const test::BreakParams& params) {
  SHERD_ASSIGN(const Fragments f, test::breakBody(std::make_shared<const TriMesh>(body), params));
  EXPECT_GE(f.pieces.size(), static_cast<std::size_t>(params.degree));
  expectPromises(f);
  const double whole = solidVolume(body.positions, body.triangles);
  double sum = 0;
  for (const Piece& p : f.pieces) {
    EXPECT_TRUE(p.name.starts_with(body.piece.empty() ? "piece_" : body.piece + "_")) << p.name;
    SHERD_ASSIGN(const SelectedPiece piece, selectPiece(f, {.piece = p.name}, Exec{}));
    sum += solidVolume(piece.mesh.positions, piece.mesh.triangles);
    double outerArea = 0;
    for (std::size_t t = 0; t < p.surface.size(); ++t)
      if (body.piece.empty() || body.materialOf[at(p.surfaceSource[t])] == 0)
        outerArea += detail::area(f.positions, {p.surface[t]});
    expectAttributes(piece.mesh, outerArea);
  }
  EXPECT_NEAR(sum / whole, 1, 1e-9);
  SHERD_ASSIGN(SelectedPiece largest, selectPiece(f, {}, Exec{}));
  return std::move(largest.mesh);
}

TEST(ThreeLevels, EveryPromiseHoldsAtEachOfThem) {
  TriMesh body = withAttributes(families::sphereSurface(Vec3::Zero(), 0.1, 32, 16));
  const char* names[] = {"piece_0001", "piece_0001_0001", "piece_0001_0001_0001"};
  for (const char* name : names) {
    auto next = level(body, {.tets = 300, .degree = 4, .seed = 3});
    ASSERT_TRUE(next.ok()) << name << ": " << next.error().text();
    body = std::move(next).value();
    EXPECT_EQ(body.piece, name);
    EXPECT_EQ(body.source, "ball.obj");
  }
}

}  // namespace
}  // namespace sherd
