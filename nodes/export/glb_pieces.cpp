#include "export/glb_pieces.h"

#include <atomic>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "export/float_rounding.h"
#include "export/piece_files.h"
#include "export/pieces_json.h"
#include "export/row_table.h"

namespace sherd {
namespace {

constexpr Floats3 kOutsideColour{0.8f, 0.8f, 0.8f}, kInsideColour{0.55f, 0.5f, 0.45f};

/// Materials in use and their numbers in the file: the artist's, −1 for `outside`, −2 for `inside`, which is
/// the same as that of the older crack faces of a piece.
struct Palette {
  static constexpr Index outside = -1, inside = -2;
  std::vector<GlbMaterial> materials;
  std::map<Index, std::size_t> number;

  explicit Palette(const Fragments& f) {
    const TriMesh& source = *f.tets->surface;
    std::vector<char> used(source.materials.size(), 0);
    bool usesOutside = false, usesInside = false;
    for (const Piece& piece : f.pieces) {
      usesInside |= !piece.crack.empty();
      for (std::size_t t = 0; t < piece.surface.size(); ++t) {
        const Index material = outerMaterial(source, piece, t);
        if (material >= 0) used[at(material)] = 1;
        usesOutside |= material < 0;
      }
    }
    for (std::size_t m = 0; m < used.size(); ++m) {
      const bool isOurs = !source.piece.empty() && source.materials[m] == kInside;
      if (!used[m] && !(isOurs && usesInside)) continue;
      add(static_cast<Index>(m), source.materials[m], isOurs ? kInsideColour : kOutsideColour);
      if (isOurs) number.try_emplace(inside, materials.size() - 1);
    }
    if (usesOutside) add(outside, kOutside, kOutsideColour);
    if (usesInside && !number.contains(inside)) add(inside, kInside, kInsideColour);
  }

 private:
  void add(Index material, const std::string& name, const Floats3& colour) {
    number[material] = materials.size();
    materials.push_back({name, colour});
  }
};

/// Vertices of one primitive: distinct rows of floats (kept as doubles), split into glTF's arrays at the end.
class Vertices {
 public:
  Vertices(bool hasNormals, std::size_t uvSets, std::size_t colourSets, std::size_t expected)
      : hasNormals_(hasNormals),
        uvSets_(uvSets),
        colourSets_(colourSets),
        rows_(3 + (hasNormals ? 3 : 0) + 2 * uvSets + 4 * colourSets, expected) {}

  template <class V>
  Vertices& put(const V& values) {
    for (int i = 0; i < values.size(); ++i) {
      const double number = roundedToFloat(values[i]);
      isFinite_ &= std::isfinite(number);
      row_.push_back(number);
    }
    return *this;
  }
  Vertices& putUv(const Vec2& uv) { return put(Vec2(uv.x(), 1 - uv.y())); }
  void close() {
    indices_.push_back(static_cast<std::uint32_t>(rows_.add(row_.data())));
    row_.clear();
  }
  bool isFinite() const { return isFinite_; }
  bool empty() const { return indices_.empty(); }

  GlbPrimitive take(std::size_t material) {
    GlbPrimitive primitive;
    primitive.material = material;
    primitive.uvs.resize(uvSets_);
    primitive.colours.resize(colourSets_);
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      const double* from = rows_.row(v).data();
      primitive.positions.push_back(next<3>(from));
      if (hasNormals_) primitive.normals.push_back(next<3>(from));
      for (auto& set : primitive.uvs) set.push_back(next<2>(from));
      for (auto& set : primitive.colours) set.push_back(next<4>(from));
    }
    primitive.indices = std::move(indices_);
    return primitive;
  }

 private:
  template <std::size_t N>
  static std::array<float, N> next(const double*& from) {
    std::array<float, N> values;
    for (float& value : values) value = static_cast<float>(*from++);
    return values;
  }

  bool hasNormals_, isFinite_ = true;
  std::size_t uvSets_, colourSets_;
  RowTable rows_;
  std::vector<double> row_;
  std::vector<std::uint32_t> indices_;
};

/// One piece on its way into a node.
struct PieceBuilder {
  const Fragments& f;
  const Piece& piece;
  const TriMesh& source;
  Vec3 pivot;

  PieceBuilder(const Fragments& fragments, const Piece& which)
      : f(fragments), piece(which), source(*f.tets->surface), pivot(roundedToFloat(piece.centreOfMass)) {}

  /// The outer triangles of one material. False where something is too large for a float.
  bool addSurface(const std::vector<std::size_t>& triangles, const std::vector<Vec3>& normals,
                  std::size_t material, GlbNode& node) const {
    Vertices vertices(!normals.empty(), source.uvSets.size(), source.colorSets.size(), triangles.size());
    for (const std::size_t t : triangles)
      for (std::size_t c = 0; c < 3; ++c) {
        vertices.put(Vec3(f.positions[at(piece.surface[t][c])] - pivot));
        if (!normals.empty()) vertices.put(normals[3 * t + c]);
        for (const auto& set : source.uvSets) vertices.putUv(cornerAttribute(f, piece, t, c, set.uv));
        for (const auto& set : source.colorSets)
          vertices.put(Vec4(cornerAttribute(f, piece, t, c, set.rgba).cwiseMax(0.0).cwiseMin(1.0)));
        vertices.close();
      }
    if (!vertices.empty()) node.primitives.push_back(vertices.take(material));
    return vertices.isFinite();
  }

  bool addCrack(const CrackCorners& corners, std::size_t material, GlbNode& node) const {
    const std::size_t sets = std::max<std::size_t>(1, source.uvSets.size());
    Vertices vertices(true, sets, 0, piece.crack.size());
    for (const std::size_t t : crackOrder(piece))
      for (std::size_t c = 0; c < 3; ++c) {
        vertices.put(Vec3(f.positions[at(piece.crack[t][c])] - pivot)).put(corners.normals[3 * t + c]);
        for (std::size_t set = 0; set < sets; ++set) vertices.putUv(corners.uvs[3 * t + c]);
        vertices.close();
      }
    if (!vertices.empty()) node.primitives.push_back(vertices.take(material));
    return vertices.isFinite();
  }

  bool build(const Palette& palette, const CrackCorners& corners, GlbNode& node) const {
    node.name = piece.name;
    for (std::size_t i = 0; i < 3; ++i)
      node.translation[i] = static_cast<float>(pivot[static_cast<Eigen::Index>(i)]);
    std::map<std::size_t, std::vector<std::size_t>> byMaterial;
    for (std::size_t t = 0; t < piece.surface.size(); ++t)
      byMaterial[palette.number.at(outerMaterial(source, piece, t))].push_back(t);
    const std::vector<Vec3> normals = surfaceNormals(f, piece);
    bool isFinite = pivot.allFinite();
    for (const auto& [material, triangles] : byMaterial)
      isFinite &= addSurface(triangles, normals, material, node);
    if (!piece.crack.empty()) isFinite &= addCrack(corners, palette.number.at(Palette::inside), node);
    return isFinite;
  }
};

void warnOfColours(const TriMesh& source, const Exec& exec) {
  for (const auto& set : source.colorSets)
    for (const Vec4& rgba : set.rgba)
      if (!(rgba.minCoeff() >= 0 && rgba.maxCoeff() <= 1)) {
        exec.warn("colours in '" + set.name +
                  "' leave [0, 1], which GLB cannot hold; they are cut off there");
        break;
      }
}

}  // namespace

Result<GlbScene> glbScene(const Fragments& f, const CrackAttributes& cracks, const std::vector<Bond>& bonds,
                          const Exec& exec) {
  warnOfColours(*f.tets->surface, exec);
  Palette palette(f);
  GlbScene scene;
  scene.name = "pieces";
  scene.nodes.resize(f.pieces.size());
  const std::vector<std::vector<Bond>> own = bondsByPiece(bonds, f.pieces.size());
  std::vector<char> isFinite(f.pieces.size(), 0);
  std::atomic<std::size_t> done{0};
  parallelFor(exec, f.pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      isFinite[p] = PieceBuilder(f, f.pieces[p]).build(palette, cracks.pieces[p], scene.nodes[p]);
      scene.nodes[p].extras = pieceProperties(f, p, own[p]);
      exec.progress(static_cast<double>(++done) / static_cast<double>(f.pieces.size()));
    }
  });
  if (exec.cancelled()) return cancelledError();
  for (std::size_t p = 0; p < isFinite.size(); ++p)
    if (!isFinite[p])
      return failure("coordinates or attributes of " + f.pieces[p].name + " are too large for GLB's floats",
                     "scale the mesh, or export by ExportCrackSurface, which writes doubles", "pieces");
  scene.materials = std::move(palette.materials);
  return scene;
}

}  // namespace sherd
