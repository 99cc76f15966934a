#include "tessellate/pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "geometry/copy_points.h"
#include "geometry/solid.h"
#include "tessellate/coincident.h"
#include "tessellate/solids.h"

namespace sherd {
namespace {

double triangleArea(std::span<const Vec3> positions, const Triangle& t) {
  const Vec3& a = positions[at(t[0])];
  return 0.5 * (positions[at(t[1])] - a).cross(positions[at(t[2])] - a).norm();
}

/// Lets small solids join their neighbours.
class SolidMerger {
 public:
  SolidMerger(const CellFaces& faces, std::span<const Vec3> positions, Solids& solids)
      : faces_(faces), positions_(positions), solids_(solids), joined_(solids.list.size()) {
    for (std::size_t s = 0; s < joined_.size(); ++s) joined_[s] = static_cast<Index>(s);
  }

  /// Smallest first. Returns how many joined.
  std::size_t mergeBelow(double minVolume) {
    std::vector<Index> small;
    for (std::size_t s = 0; s < solids_.list.size(); ++s)
      if (!isLargeEnough(static_cast<Index>(s), minVolume)) small.push_back(static_cast<Index>(s));
    if (small.empty()) return 0;
    sumContacts();
    std::sort(small.begin(), small.end(), [&](Index a, Index b) {
      return std::pair(solids_.list[at(a)].volume, a) < std::pair(solids_.list[at(b)].volume, b);
    });
    std::size_t merged = 0;
    for (const Index s : small) {
      if (isLargeEnough(s, minVolume)) continue;
      const bool joins = joinLargestNeighbour(s);
      merged += joins;
      if (!joins && isFlatSkin(s)) joined_[at(s)] = kNone;
    }
    return merged;
  }

  /// −1 for one that is nothing.
  Index ownerOf(Index solid) const {
    while (solid != kNone && joined_[at(solid)] != solid) solid = joined_[at(solid)];
    return solid;
  }

 private:
  bool isLargeEnough(Index s, double minVolume) const {
    return solids_.list[at(s)].volume > 0 && solids_.list[at(s)].volume >= minVolume;
  }

  void sumContacts() {
    contacts_.resize(solids_.list.size());
    for (std::size_t f = faces_.firstSheet(); f < faces_.size(); f += 2) {
      const Index a = solids_.ofFace[f], b = solids_.ofFace[f + 1];
      if (a == b) continue;
      const double area = triangleArea(positions_, faces_.corners(f));
      contacts_[at(a)][b] += area;
      contacts_[at(b)][a] += area;
    }
  }

  bool joinLargestNeighbour(Index small) {
    Index best = -1;
    double largest = 0;
    for (const auto& [solid, area] : contacts_[at(small)])
      if (best < 0 || area > largest) best = solid, largest = area;
    if (best < 0) return false;  // stands alone: nothing to join
    joined_[at(small)] = best;
    solids_.list[at(best)].volume += solids_.list[at(small)].volume;
    for (const auto& [solid, area] : contacts_[at(small)]) {
      auto& others = contacts_[at(solid)];
      others.erase(small);
      if (solid == best) continue;
      others[best] += area;
      contacts_[at(best)][solid] += area;
    }
    contacts_[at(small)].clear();
    return true;
  }

  static constexpr Index kNone = -1;

  /// A pocket that rounding laid flat into the skin: cut faces that cover each other, and nothing between
  /// them.
  bool isFlatSkin(Index solid) const {
    double area = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (solids_.ofFace[f] != solid) continue;
      if (f < faces_.firstSkin() || faces_.isSheet(f)) return false;
      area += triangleArea(positions_, faces_.corners(f));
    }
    return std::abs(solids_.list[at(solid)].volume) <= 1e-9 * area * std::sqrt(area);
  }

  const CellFaces& faces_;
  std::span<const Vec3> positions_;
  Solids& solids_;
  std::vector<Index> joined_;                      ///< per solid: the one that it joined, itself, or none
  std::vector<std::map<Index, double>> contacts_;  ///< m², per solid that still stands
};

class Assembler {
 public:
  Assembler(const Arrangement& a, ClippedMeshes&& m, std::span<const Triangle> neighbours, double minVolume,
            double density, const Exec& exec)
      : a_(a),
        m_(std::move(m)),
        neighbours_(neighbours),
        minVolume_(minVolume),
        density_(density),
        exec_(exec) {}

  Fragments run() {
    std::vector<unsigned char> isCut(a_.surface.size(), 0);
    for (const Index s : a_.cutTriangles) isCut[at(s)] = 1;
    out_.counts.cutSurfaceTriangles = a_.cutTriangles.size();
    removeThinLayers(a_, m_, isCut);
    const CellFaces faces(a_, m_, isCut);
    Solids solids = findSolids(faces, a_.positions, neighbours_, exec_);
    if (exec_.cancelled()) return {};
    out_.counts.detachedParts = solids.detached;
    SolidMerger merger(faces, a_.positions, solids);
    out_.counts.mergedParts = merger.mergeBelow(minVolume_);
    namePieces(solids, merger);
    fillPieces(faces, solids);
    if (exec_.cancelled()) return {};
    compactPositions();
    parallelFor(exec_, out_.pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) integrate(out_.pieces[p]);
    });
    return std::move(out_);
  }

 private:
  void namePieces(const Solids& solids, const SolidMerger& merger) {
    std::vector<Index> order;
    for (std::size_t s = 0; s < solids.list.size(); ++s)
      if (merger.ownerOf(static_cast<Index>(s)) == static_cast<Index>(s))
        order.push_back(static_cast<Index>(s));
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      const Solid &x = solids.list[at(a)], &y = solids.list[at(b)];
      return std::tuple(-x.volume, x.cell, a) < std::tuple(-y.volume, y.cell, b);
    });
    std::vector<Index> number(solids.list.size(), -1);
    out_.pieces.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      number[at(order[i])] = static_cast<Index>(i);
      out_.pieces[i].name = fmt::format("piece_{:04}", i + 1);
      out_.pieces[i].cell = solids.list[at(order[i])].cell;
    }
    pieceOf_.resize(solids.list.size());
    for (std::size_t s = 0; s < pieceOf_.size(); ++s) {
      const Index owner = merger.ownerOf(static_cast<Index>(s));
      pieceOf_[s] = owner < 0 ? -1 : number[at(owner)];
    }
  }

  /// −1 for faces that don't exist.
  Index pieceOfFace(const Solids& solids, std::size_t f) const {
    return solids.ofFace[f] < 0 ? -1 : pieceOf_[at(solids.ofFace[f])];
  }

  void reserve(const CellFaces& faces, const Solids& solids) {
    std::vector<std::array<std::size_t, 2>> counts(out_.pieces.size(), {0, 0});
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (const Index p = pieceOfFace(solids, f); p >= 0) ++counts[at(p)][faces.isSheet(f)];
    for (std::size_t p = 0; p < counts.size(); ++p) {
      Piece& piece = out_.pieces[p];
      piece.surface.reserve(counts[p][0]);
      piece.surfaceSource.reserve(counts[p][0]);
      piece.surfaceCut.reserve(counts[p][0]);
      piece.crack.reserve(counts[p][1]);
      piece.crackNeighbour.reserve(counts[p][1]);
      piece.crackSheet.reserve(counts[p][1]);
    }
  }

  void fillPieces(const CellFaces& faces, const Solids& solids) {
    reserve(faces, solids);
    for (std::size_t f = 0; f < faces.firstSheet(); ++f) {
      const Index p = pieceOfFace(solids, f);
      if (p < 0) continue;
      Piece& piece = out_.pieces[at(p)];
      piece.surface.push_back(faces.corners(f));
      piece.surfaceSource.push_back(faces.source(f));
      piece.surfaceCut.push_back(f < faces.firstSkin() ? -1 : static_cast<Index>(f - faces.firstSkin()));
    }
    out_.cutCorners.resize(m_.skin.size());
    parallelFor(exec_, m_.skin.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) weigh(m_.skin[i], out_.cutCorners[i]);
    });
    for (std::size_t f = faces.firstSheet(); f < faces.size(); ++f) {
      const Index own = pieceOfFace(solids, f), other = pieceOfFace(solids, faces.twin(f));
      if (own == other) continue;  // within one merged solid
      out_.pieces[at(own)].crack.push_back(faces.corners(f));
      out_.pieces[at(own)].crackNeighbour.push_back(other);
      out_.pieces[at(own)].crackSheet.push_back(sheetNumber(faces.cell(f), faces.cell(faces.twin(f))));
    }
  }

  /// Sheets are numbered as they come; a sheet's triangles mostly follow one another.
  Index sheetNumber(Index cell, Index other) {
    const std::pair<Index, Index> cells = std::minmax(cell, other);
    if (cells != lastCells_) {
      lastCells_ = cells;
      lastNumber_ = sheetNumbers_.try_emplace(cells, static_cast<Index>(sheetNumbers_.size())).first->second;
    }
    return lastNumber_;
  }

  void weigh(const SkinTriangle& skin, std::array<CornerWeights, 3>& weights) const {
    const Triangle& source = a_.surface[at(skin.source)];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto corner = std::find(source.begin(), source.end(), skin.corners[c]);
      if (corner != source.end())
        weights[c] = CornerWeights::Unit(corner - source.begin());
      else
        weights[c] = barycentric(a_.positions[at(source[0])], a_.positions[at(source[1])],
                                 a_.positions[at(source[2])], a_.positions[at(skin.corners[c])]);
    }
  }

  void integrate(Piece& piece) const {
    const std::span<const Triangle> lists[] = {piece.surface, piece.crack};
    const SolidIntegrals integrals = integrateSolid(out_.positions, lists);
    piece.volume = integrals.volume;
    piece.centreOfMass = integrals.centroid;
    piece.inertia = integrals.inertia(density_);
  }

  /// Drops new vertices that no piece uses; the source's own stay, in their order.
  void compactPositions() {
    const std::size_t first = at(a_.firstCrack), all = a_.positions.size();
    std::vector<Index> number(all - first, -1);
    const auto use = [&](const Triangle& t) {
      for (const Index v : t)
        if (v >= a_.firstCrack) number[at(v) - first] = 0;
    };
    for (const Piece& p : out_.pieces) {
      for (std::size_t t = 0; t < p.surface.size(); ++t)
        if (p.surfaceCut[t] >= 0) use(p.surface[t]);
      for (const Triangle& t : p.crack) use(t);
    }
    std::size_t count = first;
    for (Index& n : number)
      if (n == 0) n = static_cast<Index>(count++);
    out_.positions.resize(count);
    copyPoints(std::span(a_.positions).first(first), out_.positions.data());
    for (std::size_t v = first; v < all; ++v)
      if (number[v - first] >= 0) out_.positions[at(number[v - first])] = a_.positions[v];
    const auto renumber = [&](Triangle& t) {
      for (Index& v : t)
        if (v >= a_.firstCrack) v = number[at(v) - first];
    };
    for (Piece& p : out_.pieces) {
      for (std::size_t t = 0; t < p.surface.size(); ++t)
        if (p.surfaceCut[t] >= 0) renumber(p.surface[t]);
      for (Triangle& t : p.crack) renumber(t);
    }
  }

  const Arrangement& a_;
  ClippedMeshes m_;
  std::span<const Triangle> neighbours_;
  double minVolume_, density_;
  const Exec& exec_;
  std::vector<Index> pieceOf_;                             ///< per solid
  std::map<std::pair<Index, Index>, Index> sheetNumbers_;  ///< by the two cells
  std::pair<Index, Index> lastCells_{-1, -1};
  Index lastNumber_ = -1;
  Fragments out_;
};

}  // namespace

Fragments assemblePieces(const Arrangement& arrangement, ClippedMeshes meshes,
                         std::span<const Triangle> neighbours, double minVolume, double density,
                         const Exec& exec) {
  return Assembler(arrangement, std::move(meshes), neighbours, minVolume, density, exec).run();
}

}  // namespace sherd
