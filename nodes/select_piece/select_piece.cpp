#include "select_piece/select_piece.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "geometry/crack_attributes.h"
#include "select_piece/touching.h"

namespace sherd {
namespace {

constexpr const char *kInside = "inside", *kOutside = "outside";

/// The piece's place in `f.pieces`.
Result<std::size_t> choose(const Fragments& f, const SelectPieceParams& params) {
  if (!params.piece.empty()) {
    for (std::size_t p = 0; p < f.pieces.size(); ++p)
      if (f.pieces[p].name == params.piece) return p;
    return failure("there is no piece '" + params.piece + "'",
                   fmt::format("they are {} to {}", f.pieces.front().name, f.pieces.back().name), "piece");
  }
  if (params.number < 1 || static_cast<std::size_t>(params.number) > f.pieces.size())
    return failure(
        fmt::format("there is no piece number {}: the body broke into {}", params.number,
                    f.pieces.size() == 1 ? "one piece" : fmt::format("{} pieces", f.pieces.size())),
        "1 is the largest piece", "number");
  std::vector<std::size_t> order(f.pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return f.pieces[a].volume > f.pieces[b].volume; });
  return order[static_cast<std::size_t>(params.number) - 1];
}

/// Unit vector along `v`, safe from underflow for the tiny faces that cutting makes; z where v is 0.
Vec3 unit(const Vec3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  return largest > 0 ? Vec3((v / largest).normalized()) : Vec3::UnitZ();
}

/// Builds the surface of one piece.
class Maker {
 public:
  Maker(const Fragments& f, const Piece& piece, const CrackCorners& crack)
      : f_(f), source_(*f.tets->surface), piece_(piece), crack_(crack) {}

  Result<SelectedPiece> run() {
    gatherTriangles();
    SHERD_ASSIGN(ManifoldSurface surface,
                 separateTouching(std::move(mesh_.positions), std::move(mesh_.triangles)));
    mesh_.positions = std::move(surface.positions);
    mesh_.triangles = std::move(surface.triangles);
    setMaterials();
    setNormals();
    for (const auto& set : source_.uvSets) mesh_.uvSets.push_back({set.name, corners(set.uv, crack_.uvs)});
    for (const auto& set : source_.colorSets)
      mesh_.colorSets.push_back(
          {set.name, corners(set.rgba, std::vector<Vec4>(3 * piece_.crack.size(), Vec4::Ones()))});
    mesh_.frame = source_.frame;
    mesh_.source = source_.source;
    mesh_.piece = piece_.name;
    return SelectedPiece{std::move(mesh_), surface.doubledVertices};
  }

 private:
  void gatherTriangles() {
    std::vector<Index> number(f_.positions.size(), -1);
    for (const auto* list : {&piece_.surface, &piece_.crack})
      for (const Triangle& t : *list)
        for (const Index v : t) number[at(v)] = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<Index>(mesh_.positions.size());
      mesh_.positions.push_back(f_.positions[v]);
    }
    for (const auto* list : {&piece_.surface, &piece_.crack})
      for (const Triangle& t : *list)
        mesh_.triangles.push_back({number[at(t[0])], number[at(t[1])], number[at(t[2])]});
  }

  void setMaterials() {
    mesh_.materials = source_.materials;
    if (source_.materialOf.empty())
      mesh_.materials = {kOutside};
    else
      mesh_.looks = source_.looks;
    const auto found = std::find(mesh_.materials.begin(), mesh_.materials.end(), kInside);
    const auto inside = static_cast<Index>(found - mesh_.materials.begin());
    if (found == mesh_.materials.end()) mesh_.materials.push_back(kInside);
    for (const Index s : piece_.surfaceSource)
      mesh_.materialOf.push_back(source_.materialOf.empty() ? 0 : source_.materialOf[at(s)]);
    mesh_.materialOf.insert(mesh_.materialOf.end(), piece_.crack.size(), inside);
  }

  /// Per corner: the skin's as it came, then the crack's.
  template <class V>
  std::vector<V> corners(const std::vector<V>& perCorner, const std::vector<V>& crack) const {
    std::vector<V> out;
    out.reserve(3 * piece_.surface.size() + crack.size());
    for (std::size_t t = 0; t < piece_.surface.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) out.push_back(cornerAttribute(f_, piece_, t, c, perCorner));
    out.insert(out.end(), crack.begin(), crack.end());
    return out;
  }

  Vec3 areaVector(const Triangle& t) const {
    const Vec3& a = f_.positions[at(t[0])];
    return (f_.positions[at(t[1])] - a).cross(f_.positions[at(t[2])] - a);
  }

  void setNormals() {
    if (source_.normals.empty()) return;
    mesh_.normals = corners(source_.normals, crack_.normals);
    for (std::size_t t = 0; t < piece_.surface.size(); ++t) {
      if (piece_.surfaceCut[t] < 0) continue;
      for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
        Vec3& normal = mesh_.normals[c];
        normal = unit(normal.isZero(0) ? areaVector(piece_.surface[t]) : normal);
      }
    }
  }

  const Fragments& f_;
  const TriMesh& source_;
  const Piece& piece_;
  const CrackCorners& crack_;
  TriMesh mesh_;
};

}  // namespace

Result<SelectedPiece> selectPiece(const Fragments& f, const SelectPieceParams& params, const Exec& exec) {
  if (!f.tets || !f.tets->surface || f.pieces.empty())
    return failure("there are no pieces to choose from", "wire Tessellate's `pieces`", "pieces");
  SHERD_ASSIGN(const std::size_t p, choose(f, params));
  if (exec.cancelled()) return cancelledError();
  const bool wanted = !f.tets->surface->normals.empty() || !f.tets->surface->uvSets.empty();
  CrackCorners crack;
  if (wanted) {
    SHERD_ASSIGN(CrackAttributes all, crackAttributes(f, exec));
    crack = std::move(all.pieces[p]);
  }
  return Maker(f, f.pieces[p], crack).run();
}

}  // namespace sherd
