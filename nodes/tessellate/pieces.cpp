#include "tessellate/pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "geometry/solid.h"
#include "tessellate/coincident.h"
#include "tessellate/first_numbers.h"
#include "tessellate/flat_triangles.h"
#include "tessellate/solid_merger.h"
#include "tessellate/solids.h"

namespace sherd {
namespace {

/// Below this share of the body's volume a piece is integrated about a point of its own: sums about the
/// body's centre would cost it digits.
constexpr double kSmall = 1e-6;
/// Skin triangles from which a piece is worth two threads.
constexpr std::size_t kLarge = 1 << 15;

class Assembler {
 public:
  Assembler(const TetMesh& tets, const Sheets& sheets, Arrangement&& a, ClippedMeshes&& m,
            const AssembleParams& params, const Exec& exec)
      : tets_(tets), sheets_(sheets), a_(std::move(a)), m_(std::move(m)), params_(params), exec_(exec) {}

  Fragments run() {
    std::vector<unsigned char> isCut(a_.surface.size(), 0);
    for (const Index s : a_.cutTriangles) isCut[at(s)] = 1;
    out_.counts.cutSurfaceTriangles = a_.cutTriangles.size();
    removeThinLayers(a_, m_, isCut);
    const std::size_t absorbed = absorbFlatTriangles(tets_, a_, m_, isCut);
    out_.counts.forcedTriangles = m_.forced - std::min(m_.forced, absorbed);
    parts_.emplace(tets_, sheets_, a_, m_, isCut, exec_);
    if (exec_.cancelled()) return {};
    TaskGroup summing, others;  // beside what is one thread's work
    summing.run([&] { parts_->sumUp(isCut); });
    others.run([this] { weighCorners(); });
    others.run([this] { findAllUsed(); });
    parts_->join(isCut);
    summing.wait();
    if (exec_.cancelled()) return {};
    findPieces();
    const bool allSheets = numberSheets();
    others.wait();
    numberVertices(forgetLeftOut() && allSheets);
    takePositions();
    fillPieces();
    if (exec_.cancelled()) return {};
    return std::move(out_);
  }

 private:
  /// Solids, merged, in the order of their names.
  void findPieces() {
    Solids solids = findSolids(*parts_, a_.positions);
    out_.counts.detachedParts = solids.detached;
    std::vector<unsigned char> holds(params_.sites, 0);
    for (const Solid& s : solids.list) holds[at(s.cell)] = 1;
    out_.counts.emptyCells = static_cast<std::size_t>(std::count(holds.begin(), holds.end(), 0));
    SolidMerger merger(*parts_, a_.positions, solids);
    out_.counts.mergedParts = merger.mergeBelow(params_.minVolume);
    namePieces(solids, merger);
    listParts();
  }

  void namePieces(const Solids& solids, const SolidMerger& merger) {
    std::vector<Index> order;
    for (Index s = 0; at(s) < solids.list.size(); ++s)
      if (merger.ownerOf(s) == s) order.push_back(s);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      const Solid &x = solids.list[at(a)], &y = solids.list[at(b)];
      return std::tuple(-x.sums.volume, x.cell, a) < std::tuple(-y.sums.volume, y.cell, b);
    });
    std::vector<Index> number(solids.list.size(), -1);
    out_.pieces.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      number[at(order[i])] = static_cast<Index>(i);
      out_.pieces[i].name = fmt::format("piece_{:04}", i + 1);
      out_.pieces[i].cell = solids.list[at(order[i])].cell;
      sums_.push_back(solids.list[at(order[i])].sums);
    }
    for (std::size_t s = 0; s < number.size(); ++s)
      if (const Index owner = merger.ownerOf(static_cast<Index>(s)); owner >= 0)
        number[s] = number[at(owner)];
    pieceOf_.resize(parts_->size());
    for (std::size_t p = 0; p < pieceOf_.size(); ++p) pieceOf_[p] = number[at(solids.ofPart[p])];
  }

  /// The parts of each piece, ascending.
  void listParts() {
    partBegin_.assign(out_.pieces.size() + 1, 0);
    for (const Index piece : pieceOf_)
      if (piece >= 0) ++partBegin_[at(piece) + 1];
    std::partial_sum(partBegin_.begin(), partBegin_.end(), partBegin_.begin());
    partsOfPieces_.resize(at(partBegin_.back()));
    std::vector<Index> fill(partBegin_.begin(), partBegin_.end() - 1);
    for (std::size_t p = 0; p < pieceOf_.size(); ++p)
      if (pieceOf_[p] >= 0) partsOfPieces_[at(fill[at(pieceOf_[p])]++)] = static_cast<Index>(p);
  }

  std::span<const Index> partsOf(std::size_t piece) const {
    return std::span(partsOfPieces_)
        .subspan(at(partBegin_[piece]), at(partBegin_[piece + 1] - partBegin_[piece]));
  }

  /// Sheets within one merged solid are no cracks.
  bool isCrack(std::size_t sheetPart) const {
    return pieceOf_[sheetPart] != pieceOf_[parts_->twin(sheetPart)];
  }

  /// Sheets are numbered as they come. False where some are no cracks.
  bool numberSheets() {
    FirstNumbers<std::array<Index, 2>> numbers(m_.sheet.parts());
    sheetNumbers_.assign(m_.sheet.parts(), -1);
    bool all = true;
    for (std::size_t k = 0; k < sheetNumbers_.size(); ++k) {
      const std::size_t back = parts_->firstSheet() + 2 * k;
      all = all && isCrack(back);
      if (!isCrack(back)) continue;
      const Index one = parts_->cell(back), other = parts_->cell(back + 1);
      const std::array<Index, 2> cells{std::min(one, other), std::max(one, other)};
      sheetNumbers_[k] = numbers.numberOf(cells, hashOfIndices(cells));
    }
    return all;
  }

  /// Finds the new vertices of parts of the skin and of the sheets, given by number.
  template <class Skin, class Sheet>
  void findUsed(Skin isSkinKept, Sheet isSheetKept) {
    number_.assign(a_.positions.size() - at(a_.firstCrack), -1);
    const auto use = [&](const auto& triangles) {
      for (const auto& t : triangles)
        for (const Index v : t.corners)
          if (v >= a_.firstCrack) number_[at(v - a_.firstCrack)] = 0;
    };
    for (std::size_t k = 0; k < m_.skin.parts(); ++k)
      if (isSkinKept(k)) use(m_.skin.of(k));
    for (std::size_t k = 0; k < m_.sheet.parts(); ++k)
      if (isSheetKept(k)) use(m_.sheet.of(k));
  }

  /// Before it is known what is left out.
  void findAllUsed() {
    const auto all = [](std::size_t) { return true; };
    findUsed(all, all);
  }

  /// New vertices that no piece uses are left out; the source's own stay, in their order.
  void numberVertices(bool allKept) {
    if (!allKept)
      findUsed([this](std::size_t k) { return pieceOf_[parts_->firstSkin() + k] >= 0; },
               [this](std::size_t k) { return sheetNumbers_[k] >= 0; });
    Index next = a_.firstCrack;
    for (Index& n : number_)
      if (n == 0) n = next++;
    vertexCount_ = at(next);
  }

  Index renumbered(Index v) const { return v < a_.firstCrack ? v : number_[at(v - a_.firstCrack)]; }
  Triangle renumbered(const Triangle& t) const {
    return {renumbered(t[0]), renumbered(t[1]), renumbered(t[2])};
  }

  /// Before takePositions().
  const Vec3& position(Index vertex) const { return a_.positions[at(vertex)]; }

  /// Weights of the corners of `source` at a vertex in it.
  CornerWeights weights(const Triangle& source, Index vertex) const {
    const auto cornerOf = [&](Index v) {
      return std::find(source.begin(), source.end(), v) - source.begin();
    };
    if (vertex < a_.firstCrack) {
      if (const auto corner = cornerOf(vertex); corner < 3) return CornerWeights::Unit(corner);
    } else if (const Index edge = cutEdgeOf_[at(vertex - a_.firstCrack)]; edge >= 0) {
      const auto [from, to] = a_.cutEdges[at(edge)];
      const auto p = cornerOf(from), q = cornerOf(to);
      if (p < 3 && q < 3) return onSide(position(from), position(to), p, q, position(vertex));
    }
    return barycentric(position(source[0]), position(source[1]), position(source[2]), position(vertex));
  }

  void weighCorners() {
    cutEdgeOf_.assign(a_.positions.size() - at(a_.firstCrack), -1);
    for (const Crossing& x : a_.surfaceCrossings.list) cutEdgeOf_[at(x.vertex - a_.firstCrack)] = x.edge;
    out_.cutCorners.resize(m_.skin.triangles.size());
    parallelFor(exec_, m_.skin.triangles.size(), 256, [&](std::size_t begin, std::size_t end) {
      std::vector<std::pair<Index, CornerWeights>> known;  // in the triangle's source
      for (std::size_t t = begin; t < end; ++t) {
        const SkinTriangle& skin = m_.skin.triangles[t];
        if (t == begin || skin.source != m_.skin.triangles[t - 1].source) known.clear();
        for (std::size_t c = 0; c < 3; ++c) {
          const Index v = skin.corners[c];
          auto found = std::ranges::find(known, v, [](const auto& k) { return k.first; });
          if (found == known.end()) found = known.insert(found, {v, weights(a_.surface[at(skin.source)], v)});
          out_.cutCorners[t][c] = found->second;
        }
      }
    });
  }

  /// Skin that no piece has keeps no weights. False where there is some.
  bool forgetLeftOut() {
    bool none = true;
    for (std::size_t k = 0; k < m_.skin.parts(); ++k) {
      if (pieceOf_[parts_->firstSkin() + k] >= 0) continue;
      none = false;
      for (std::size_t t = m_.skin.begin(k); t < m_.skin.end(k); ++t)
        out_.cutCorners[t].fill(CornerWeights::Zero());
    }
    return none;
  }

  void fillPieces() {
    const double body = std::accumulate(sums_.begin(), sums_.end(), 0.0,
                                        [](double sum, const SolidSums& s) { return sum + s.volume; });
    parallelFor(exec_, out_.pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        fill(i);
        integrate(out_.pieces[i], sums_[i], sums_[i].volume < kSmall * body);
      }
    });
  }

  void fill(std::size_t i) {
    reserve(i);
    Piece& piece = out_.pieces[i];
    if (piece.surface.capacity() < kLarge) {
      for (const Index part : partsOf(i)) addCorners(at(part), piece), addOthers(at(part), piece);
      return;
    }
    TaskGroup tasks;  // about as much to write each
    tasks.run([&] {
      for (const Index part : partsOf(i)) addCorners(at(part), piece);
    });
    for (const Index part : partsOf(i)) addOthers(at(part), piece);
    tasks.wait();
  }

  void reserve(std::size_t i) {
    std::size_t surface = 0, crack = 0;
    for (const Index part : partsOf(i))
      if (!parts_->isSheet(at(part)))
        surface += parts_->triangleCount(at(part));
      else if (isCrack(at(part)))
        crack += parts_->triangleCount(at(part));
    Piece& piece = out_.pieces[i];
    piece.surface.reserve(surface);
    piece.surfaceSource.reserve(surface);
    piece.surfaceCut.reserve(surface);
    piece.crack.reserve(crack);
    piece.crackNeighbour.reserve(crack);
    piece.crackSheet.reserve(crack);
  }

  void addCorners(std::size_t part, Piece& piece) const {
    if (parts_->isUncut(part))
      for (const Index t : parts_->uncutTriangles(part)) piece.surface.push_back(a_.surface[at(t)]);
    else if (parts_->isSkin(part))
      for (const SkinTriangle& skin : m_.skin.of(parts_->skinNumber(part)))
        piece.surface.push_back(renumbered(skin.corners));
  }

  /// All but the skin's corners.
  void addOthers(std::size_t part, Piece& piece) const {
    if (parts_->isUncut(part)) {
      const auto triangles = parts_->uncutTriangles(part);
      piece.surfaceSource.insert(piece.surfaceSource.end(), triangles.begin(), triangles.end());
      piece.surfaceCut.resize(piece.surfaceSource.size(), -1);
    } else if (parts_->isSkin(part)) {
      const std::size_t k = parts_->skinNumber(part);
      for (std::size_t t = m_.skin.begin(k); t < m_.skin.end(k); ++t) {
        piece.surfaceSource.push_back(m_.skin.triangles[t].source);
        piece.surfaceCut.push_back(static_cast<Index>(t));
      }
    } else if (isCrack(part)) {
      parts_->forTriangles(part, [&](const Triangle& t) { piece.crack.push_back(renumbered(t)); });
      piece.crackNeighbour.resize(piece.crack.size(), pieceOf_[parts_->twin(part)]);
      piece.crackSheet.resize(piece.crack.size(), sheetNumbers_[parts_->sheetNumber(part)]);
    }
  }

  void integrate(Piece& piece, const SolidSums& sums, bool isSmall) const {
    const std::span<const Triangle> lists[] = {piece.surface, piece.crack};
    const SolidIntegrals integrals =
        isSmall ? integrateSolid(out_.positions, lists) : integralsOf(sums, tets_.patches.origin);
    piece.volume = integrals.volume;
    piece.centreOfMass = integrals.centroid;
    piece.inertia = integrals.inertia(params_.density);
  }

  void takePositions() {
    for (std::size_t v = 0; v < number_.size(); ++v)
      if (number_[v] >= 0) a_.positions[at(number_[v])] = a_.positions[at(a_.firstCrack) + v];
    a_.positions.resize(vertexCount_);
    out_.positions = std::move(a_.positions);
  }

  const TetMesh& tets_;
  const Sheets& sheets_;
  Arrangement a_;
  ClippedMeshes m_;
  AssembleParams params_;
  const Exec& exec_;
  std::optional<CellParts> parts_;
  std::vector<Index> pieceOf_;                    ///< per part; −1 for what is left out
  std::vector<Index> partBegin_, partsOfPieces_;  ///< per piece
  std::vector<SolidSums> sums_;                   ///< per piece
  std::vector<Index> sheetNumbers_;               ///< per part of the sheets; −1 within a merged solid
  std::vector<Index> cutEdgeOf_;                  ///< per new vertex: the cut edge that it lies on, or −1
  std::vector<Index> number_;                     ///< per new vertex: its number in the result, or −1
  std::size_t vertexCount_ = 0;
  Fragments out_;
};

}  // namespace

Fragments assemblePieces(const TetMesh& tets, const Sheets& sheets, Arrangement arrangement,
                         ClippedMeshes meshes, const AssembleParams& params, const Exec& exec) {
  return Assembler(tets, sheets, std::move(arrangement), std::move(meshes), params, exec).run();
}

}  // namespace sherd
