#include "tessellate/pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "geometry/disjoint_sets.h"
#include "geometry/solid.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

double triangleArea(std::span<const Vec3> positions, const Triangle& t) {
  const Vec3& a = positions[at(t[0])];
  return 0.5 * (positions[at(t[1])] - a).cross(positions[at(t[2])] - a).norm();
}

/// One side of a triangle as a cell sees it: all of the skin, and each sheet triangle twice.
struct Face {
  Triangle corners;  ///< counter-clockwise from outside the cell
  Index cell;
  Index skin, sheet;  ///< which triangle it is of; −1 for the other kind
};

class Assembler {
 public:
  Assembler(const Arrangement& a, const ClippedMeshes& m, double minVolume, double density, const Exec& exec)
      : a_(a), m_(m), minVolume_(minVolume), density_(density), exec_(exec), positions_(a.positions) {}

  Fragments run() {
    gatherFaces();
    if (!exec_.cancelled()) splitIntoSolids();
    if (!exec_.cancelled()) mergeSmallSolids();
    if (!exec_.cancelled()) writePieces();
    return std::move(out_);
  }

 private:
  /// Vertices that rounding placed on one spot are one: triangles that lose a corner vanish, on both sides of
  /// a sheet alike, and what is left closes as before.
  std::optional<Triangle> merged(const Triangle& t) const {
    const Triangle r{a_.same[at(t[0])], a_.same[at(t[1])], a_.same[at(t[2])]};
    if (r[0] == r[1] || r[1] == r[2] || r[2] == r[0]) return std::nullopt;
    return r;
  }

  void gatherFaces() {
    faces_.reserve(m_.skin.size() + 2 * m_.sheet.size());
    for (std::size_t i = 0; i < m_.skin.size(); ++i)
      if (const auto t = merged(m_.skin[i].corners))
        faces_.push_back({*t, m_.skin[i].cell, static_cast<Index>(i), -1});
    for (std::size_t i = 0; i < m_.sheet.size(); ++i) {
      const auto t = merged(m_.sheet[i].corners);
      if (!t) continue;
      // The sheet's front is outside of the cell at its back.
      faces_.push_back({*t, m_.sheet[i].back, -1, static_cast<Index>(i)});
      faces_.push_back({{(*t)[0], (*t)[2], (*t)[1]}, m_.sheet[i].front, -1, static_cast<Index>(i)});
    }
  }

  /// Joins a cell's faces over their edges into shells.
  DisjointSets joinShells() const {
    struct Side {
      Index cell, low, high, face;
    };
    std::vector<Side> sides;
    sides.reserve(3 * faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [low, high] = std::minmax(faces_[f].corners[c], faces_[f].corners[(c + 1) % 3]);
        sides.push_back({faces_[f].cell, low, high, static_cast<Index>(f)});
      }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.low, a.high, a.cell, a.face) < std::tie(b.low, b.high, b.cell, b.face);
    });
    DisjointSets sets(faces_.size());
    for (std::size_t i = 0; i + 1 < sides.size(); ++i)
      if (sides[i].cell == sides[i + 1].cell && sides[i].low == sides[i + 1].low &&
          sides[i].high == sides[i + 1].high)
        sets.join(at(sides[i].face), at(sides[i + 1].face));
    return sets;
  }

  struct Solid {
    Index cell;
    double volume = 0;
    std::vector<Index> faces;
  };

  void splitIntoSolids() {
    DisjointSets sets = joinShells();
    if (exec_.cancelled()) return;
    std::map<std::pair<Index, std::size_t>, Solid> shells;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      Solid& shell = shells[{faces_[f].cell, sets.find(f)}];
      shell.cell = faces_[f].cell;
      shell.faces.push_back(static_cast<Index>(f));
    }
    std::map<Index, std::vector<Solid>> voids;
    std::map<Index, std::vector<std::size_t>> solidsOf;
    for (auto& [key, shell] : shells) {
      shell.volume = solidVolume(positions_, trianglesOf(shell));
      if (shell.volume > 0) {
        solidsOf[shell.cell].push_back(solids_.size());
        solids_.push_back(std::move(shell));
      } else {
        voids[shell.cell].push_back(std::move(shell));
      }
    }
    for (auto& [cell, list] : voids)
      for (Solid& hole : list) giveVoid(hole, solidsOf[cell]);
    for (const auto& [cell, list] : solidsOf) out_.counts.detachedParts += list.size() - 1;
  }

  std::vector<Triangle> trianglesOf(const Solid& solid) const {
    std::vector<Triangle> triangles;
    triangles.reserve(solid.faces.size());
    for (const Index f : solid.faces) triangles.push_back(faces_[at(f)].corners);
    return triangles;
  }

  /// A shell of negative volume is a void of the smallest solid of its cell that holds it. One that nothing
  /// holds is a part that rounding left flat: a solid of its own, which then joins a neighbour.
  void giveVoid(Solid& hole, const std::vector<std::size_t>& candidates) {
    const Vec3& probe = positions_[at(faces_[at(hole.faces.front())].corners[0])];
    std::optional<std::size_t> owner;
    for (const std::size_t s : candidates)
      if (SurfaceTree(positions_, trianglesOf(solids_[s])).contains(probe) &&
          (!owner || solids_[s].volume < solids_[*owner].volume))
        owner = s;
    if (!owner) {
      solids_.push_back(std::move(hole));
      return;
    }
    solids_[*owner].faces.insert(solids_[*owner].faces.end(), hole.faces.begin(), hole.faces.end());
    solids_[*owner].volume += hole.volume;
  }

  void mergeSmallSolids() {
    solidOfFace_.assign(faces_.size(), -1);
    for (std::size_t s = 0; s < solids_.size(); ++s)
      for (const Index f : solids_[s].faces) solidOfFace_[at(f)] = static_cast<Index>(s);
    sheetSides_.assign(m_.sheet.size(), {-1, -1});
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (const Index sheet = faces_[f].sheet; sheet >= 0) {
        auto& sides = sheetSides_[at(sheet)];
        (sides[0] < 0 ? sides[0] : sides[1]) = static_cast<Index>(f);
      }
    joined_.resize(solids_.size());
    for (std::size_t s = 0; s < solids_.size(); ++s) joined_[s] = static_cast<Index>(s);
    std::vector<std::size_t> order(solids_.size());
    for (std::size_t s = 0; s < order.size(); ++s) order[s] = s;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple(solids_[a].volume, a) < std::tuple(solids_[b].volume, b);
    });
    for (const std::size_t s : order) {
      if (solids_[s].volume > 0 && solids_[s].volume >= minVolume_) continue;
      joinLargestNeighbour(s);
    }
  }

  Index ownerOf(Index face) const {
    Index s = solidOfFace_[at(face)];
    while (joined_[at(s)] != s) s = joined_[at(s)];
    return s;
  }

  void joinLargestNeighbour(std::size_t small) {
    std::map<Index, double> contact;
    const Index own = static_cast<Index>(small);
    for (const auto& [back, front] : sheetSides_) {
      if (back < 0) continue;  // lost a corner to rounding
      const Index a = ownerOf(back), b = ownerOf(front);
      if (a == b || (a != own && b != own)) continue;
      contact[a == own ? b : a] += triangleArea(positions_, faces_[at(back)].corners);
    }
    Index best = -1;
    for (const auto& [solid, area] : contact)
      if (best < 0 || area > contact[best]) best = solid;
    if (best < 0) return;  // stands alone: nothing to join
    joined_[small] = best;
    solids_[at(best)].volume += solids_[small].volume;
    ++out_.counts.mergedParts;
  }

  void writePieces() {
    std::map<Index, Index> pieceOf;
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < solids_.size(); ++s)
      if (joined_[s] == static_cast<Index>(s)) order.push_back(s);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple(-solids_[a].volume, solids_[a].cell, a) <
             std::tuple(-solids_[b].volume, solids_[b].cell, b);
    });
    out_.pieces.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      pieceOf[static_cast<Index>(order[i])] = static_cast<Index>(i);
      out_.pieces[i].name = fmt::format("piece_{:04}", i + 1);
      out_.pieces[i].cell = solids_[order[i]].cell;
    }
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const Index face = static_cast<Index>(f);
      if (f % 4096 == 0 && exec_.cancelled()) return;
      writeFace(face, out_.pieces[at(pieceOf.at(ownerOf(face)))], pieceOf);
    }
    for (Piece& piece : out_.pieces) integrate(piece);
    compactPositions();
  }

  void writeFace(Index f, Piece& piece, const std::map<Index, Index>& pieceOf) {
    const Face& face = faces_[at(f)];
    if (face.sheet >= 0) {
      const auto& sides = sheetSides_[at(face.sheet)];
      const Index other = ownerOf(sides[0] == f ? sides[1] : sides[0]);
      if (other == ownerOf(f)) return;  // within one merged solid
      piece.crack.push_back(face.corners);
      piece.crackNeighbour.push_back(pieceOf.at(other));
      const auto& [corners, front, back] = m_.sheet[at(face.sheet)];
      const auto next = static_cast<Index>(sheetNumber_.size());
      piece.crackSheet.push_back(sheetNumber_.try_emplace(std::minmax(front, back), next).first->second);
      return;
    }
    const SkinTriangle& skin = m_.skin[at(face.skin)];
    piece.surface.push_back(face.corners);
    piece.surfaceSource.push_back(skin.source);
    piece.surfaceCut.push_back(skin.cut ? static_cast<Index>(out_.cutCorners.size()) : -1);
    if (!skin.cut) return;
    const Triangle& source = a_.surface[at(skin.source)];
    auto& weights = out_.cutCorners.emplace_back();
    for (std::size_t c = 0; c < 3; ++c)
      weights[c] = barycentric(positions_[at(source[0])], positions_[at(source[1])],
                               positions_[at(source[2])], positions_[at(face.corners[c])]);
  }

  void integrate(Piece& piece) const {
    const std::span<const Triangle> lists[] = {piece.surface, piece.crack};
    const SolidIntegrals integrals = integrateSolid(positions_, lists);
    piece.volume = integrals.volume;
    piece.centreOfMass = integrals.centroid;
    piece.inertia = integrals.inertia(density_);
  }

  /// Drops new vertices that no piece uses; the source's own stay, in their order.
  void compactPositions() {
    std::vector<Index> number(positions_.size(), -1);
    for (Index v = 0; v < a_.firstCrack; ++v) number[at(v)] = v;
    auto use = [&](const std::vector<Triangle>& list) {
      for (const Triangle& t : list)
        for (const Index v : t)
          if (number[at(v)] < 0) number[at(v)] = -2;
    };
    for (const Piece& p : out_.pieces) use(p.surface), use(p.crack);
    out_.positions.assign(positions_.begin(), positions_.begin() + a_.firstCrack);
    for (std::size_t v = at(a_.firstCrack); v < positions_.size(); ++v) {
      if (number[v] != -2) continue;
      number[v] = static_cast<Index>(out_.positions.size());
      out_.positions.push_back(positions_[v]);
    }
    auto renumber = [&](std::vector<Triangle>& list) {
      for (Triangle& t : list)
        for (Index& v : t) v = number[at(v)];
    };
    for (Piece& p : out_.pieces) renumber(p.surface), renumber(p.crack);
  }

  const Arrangement& a_;
  const ClippedMeshes& m_;
  double minVolume_, density_;
  const Exec& exec_;
  std::span<const Vec3> positions_;
  std::vector<Face> faces_;
  std::vector<Solid> solids_;
  std::vector<Index> solidOfFace_;
  std::vector<std::array<Index, 2>> sheetSides_;          ///< per sheet triangle: its two faces
  std::vector<Index> joined_;                             ///< per solid: the one that it joined, or itself
  std::map<std::pair<Index, Index>, Index> sheetNumber_;  ///< by the two cells
  Fragments out_;
};

}  // namespace

Fragments assemblePieces(const Arrangement& arrangement, const ClippedMeshes& meshes, double minVolume,
                         double density, const Exec& exec) {
  return Assembler(arrangement, meshes, minVolume, density, exec).run();
}

}  // namespace sherd
