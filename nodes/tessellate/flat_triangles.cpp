#include "tessellate/flat_triangles.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

namespace sherd {
namespace {

/// A triangle between two cells, or a cell (`inner`) and the outside.
struct Facet {
  Triangle corners;
  Index inner, outer;  ///< `outer`: the front of a sheet, −1 outside
  Index source;        ///< the surface triangle, −1 for a sheet's

  bool bounds(Index cell) const { return cell >= 0 && (inner == cell || outer == cell); }
};

class FlatAbsorber {
 public:
  FlatAbsorber(const TetMesh& tets, const Arrangement& a, ClippedMeshes& meshes,
               std::vector<unsigned char>& isCut)
      : tets_(tets), a_(a), meshes_(meshes), isCut_(isCut) {}

  std::size_t run() {
    gather();
    std::vector<std::size_t> flat = allFlat();
    std::size_t absorbed = 0;
    for (bool again = !flat.empty(); again;) {
      const std::size_t before = flat.size();
      std::erase_if(flat, [&](std::size_t f) { return gone_[f] || absorb(f); });
      absorbed += before - flat.size();
      again = flat.size() < before;  // what has absorbed one may be what another waits for
    }
    if (absorbed > 0 || facets_.size() > meshes_.skin.triangles.size() + meshes_.sheet.triangles.size())
      putBack();
    return absorbed;
  }

 private:
  /// Facets that others take the place of.
  struct Change {
    std::vector<std::size_t> removed;
    std::vector<Facet> fresh;
  };

  const Vec3& point(Index v) const { return a_.positions[at(v)]; }

  bool isFlat(const Triangle& t) const {
    return sherd::isFlat(point(t[0]), point(t[1]), point(t[2]), a_.spot);
  }

  /// The corner where the longest side begins.
  std::size_t baseOf(const Triangle& t) const {
    const auto length2 = [&](std::size_t c) { return (point(t[(c + 1) % 3]) - point(t[c])).squaredNorm(); };
    std::size_t base = 0;
    for (const std::size_t c : {1u, 2u})
      if (length2(c) > length2(base)) base = c;
    return base;
  }

  void gather() {
    for (const SkinTriangle& t : meshes_.skin.triangles) facets_.push_back({t.corners, t.cell, -1, t.source});
    for (const SheetTriangle& t : meshes_.sheet.triangles)
      facets_.push_back({t.corners, t.back, t.front, -1});
    gone_.assign(facets_.size(), 0);
  }

  /// Also lists the facets around all corners of flat ones.
  std::vector<std::size_t> allFlat() {
    std::vector<std::size_t> flat;
    for (std::size_t f = 0; f < facets_.size(); ++f)
      if (isFlat(facets_[f].corners)) {
        flat.push_back(f);
        for (const Index v : facets_[f].corners) around_[v];
      }
    if (!flat.empty())
      for (std::size_t f = 0; f < facets_.size(); ++f) enlist(f);
    return flat;
  }
  void enlist(std::size_t f) {
    for (const Index v : facets_[f].corners)
      if (const auto found = around_.find(v); found != around_.end()) found->second.push_back(f);
  }

  /// The corner of facet `f` from which it runs to `to`, 3 for none.
  static std::size_t sideFrom(const Facet& f, Index from, Index to) {
    for (std::size_t c = 0; c < 3; ++c)
      if (f.corners[c] == from && f.corners[(c + 1) % 3] == to) return c;
    return 3;
  }

  /// Takes the triangle away and splits what else meets at its longest side at its third corner: the rest of
  /// its sheet, or two sheets that it parts along the line where all three meet. False where that can't be
  /// done.
  bool absorb(std::size_t f) {
    const Triangle t = facets_[f].corners;
    const std::size_t base = baseOf(t);
    const Index p = t[base], q = t[(base + 1) % 3], middle = t[(base + 2) % 3];
    Change change{facetsAt(f, p, q), {}};
    if (change.removed.empty()) return false;
    for (const std::size_t g : change.removed)
      if (!split(facets_[g], p, q, middle, change.fresh)) return false;
    change.removed.push_back(f);
    if (!mergeLayers(middle, change)) return false;
    for (const Facet& fresh : change.fresh)
      if (!fits(fresh, middle, change)) return false;
    carryOut(change);
    return true;
  }

  /// The other facets with the edge, where around it each cell lies in one wedge; else none.
  std::vector<std::size_t> facetsAt(std::size_t f, Index p, Index q) {
    std::vector<std::size_t> others;
    for (const std::size_t g : around_.at(q))
      if (g != f && hasSide(facets_[g], p, q) && !gone_[g] &&
          std::find(others.begin(), others.end(), g) == others.end())
        others.push_back(g);
    if (closes(f, others)) return others;
    const std::optional<std::size_t> uncut = uncutAcross(facets_[f], p, q);
    if (uncut) others.push_back(*uncut);
    if (!uncut || !closes(f, others)) others.clear();
    return others;
  }

  bool closes(std::size_t f, std::span<const std::size_t> others) const {
    std::map<Index, int> sides;
    const auto count = [&](const Facet& o) { ++sides[o.inner], ++sides[o.outer]; };
    count(facets_[f]);
    for (const std::size_t g : others) count(facets_[g]);
    return std::ranges::all_of(sides, [](const auto& side) { return side.second == 2; });
  }

  static bool hasSide(const Facet& f, Index v, Index w) {
    return sideFrom(f, v, w) < 3 || sideFrom(f, w, v) < 3;
  }

  /// Two facets for one that has the edge; false where it is too narrow.
  static bool split(const Facet& f, Index p, Index q, Index middle, std::vector<Facet>& out) {
    std::size_t side = sideFrom(f, q, p);
    if (side == 3) side = sideFrom(f, p, q);
    const Index from = f.corners[side], to = f.corners[(side + 1) % 3], apex = f.corners[(side + 2) % 3];
    if (apex == middle) return false;
    for (const Triangle& half : {Triangle{from, middle, apex}, Triangle{middle, to, apex}})
      out.push_back({half, f.inner, f.outer, f.source});
    return true;
  }

  /// A new facet may cover another, with nothing of one cell between them: both become one, or nothing. False
  /// where a flat one is left.
  bool mergeLayers(Index middle, Change& change) {
    std::vector<Facet> merged;
    for (const Facet& fresh : change.fresh) {
      std::optional<Facet> result = fresh;
      const std::vector<std::size_t>& around = around_.at(middle);
      const auto under = std::ranges::find_if(
          around, [&](std::size_t g) { return isThere(g, change) && isOver(fresh, facets_[g]); });
      if (under != around.end()) {
        change.removed.push_back(*under);
        result = combined(fresh, facets_[*under]);
      } else if (isFlat(fresh.corners)) {
        return false;
      }
      if (result) merged.push_back(*result);
    }
    change.fresh = std::move(merged);
    return true;
  }

  /// What lies below and above a facet, seen so that its corners turn as those of `like` do, the same three.
  static std::array<Index, 2> cellsSeenAs(const Facet& f, const Triangle& like) {
    const std::size_t c = static_cast<std::size_t>(std::ranges::find(f.corners, like[0]) - f.corners.begin());
    if (f.corners[(c + 1) % 3] == like[1]) return {f.inner, f.outer};
    return {f.outer, f.inner};
  }

  static bool isOver(const Facet& f, const Facet& g) {
    if (!std::ranges::is_permutation(f.corners, g.corners)) return false;
    const auto [below, above] = cellsSeenAs(f, g.corners);
    return (below >= 0 && below == g.outer) || (above >= 0 && above == g.inner);
  }

  static std::optional<Facet> combined(const Facet& f, const Facet& g) {
    auto [below, above] = cellsSeenAs(f, g.corners);
    if (below >= 0 && below == g.outer)
      below = g.inner;
    else
      above = g.outer;
    if (below == above) return std::nullopt;
    const Index source = below < 0 || above < 0 ? std::max(f.source, g.source) : -1;
    if (below >= 0) return Facet{g.corners, below, above, source};
    return Facet{{g.corners[0], g.corners[2], g.corners[1]}, above, below, source};
  }

  bool isThere(std::size_t g, const Change& change) const {
    return !gone_[g] && std::ranges::find(change.removed, g) == change.removed.end();
  }

  /// At its edges to `middle` a cell's border must not come to meet itself.
  bool fits(const Facet& fresh, Index middle, const Change& change) const {
    for (const Index w : fresh.corners) {
      if (w == middle || std::ranges::find(fresh.corners, middle) == fresh.corners.end()) continue;
      for (const Index cell : {fresh.inner, fresh.outer}) {
        if (cell < 0) continue;
        const auto counts = [&](const Facet& f) { return f.bounds(cell) && hasSide(f, middle, w); };
        std::set<std::size_t> before, after;
        for (const std::size_t g : around_.at(middle))
          if (!gone_[g] && counts(facets_[g])) {
            before.insert(g);
            if (isThere(g, change)) after.insert(g);
          }
        const auto come = static_cast<std::size_t>(std::ranges::count_if(change.fresh, counts));
        if (after.size() + come > std::max<std::size_t>(2, before.size())) return false;
      }
    }
    return true;
  }

  void carryOut(const Change& change) {
    for (const std::size_t g : change.removed) gone_[g] = 1;
    for (const Facet& fresh : change.fresh) {
      facets_.push_back(fresh);
      gone_.push_back(0);
      enlist(facets_.size() - 1);
    }
  }

  std::optional<std::size_t> uncutAcross(const Facet& f, Index p, Index q) {
    if (f.source < 0) return std::nullopt;
    const std::size_t side = sideFrom({a_.surface[at(f.source)], 0, 0, 0}, p, q);
    if (side == 3) return std::nullopt;
    const Index next = tets_.surfaceNeighbours[at(f.source)][side];
    const Triangle& corners = a_.surface[at(next)];
    if (isCut_[at(next)] || a_.surfaceLabel[at(corners[0])] != f.inner || isFlat(corners))
      return std::nullopt;
    isCut_[at(next)] = 1;
    facets_.push_back({corners, f.inner, -1, next});
    gone_.push_back(0);
    enlist(facets_.size() - 1);
    return facets_.size() - 1;
  }

  void putBack() {
    meshes_.skin.triangles.clear();
    meshes_.sheet.triangles.clear();
    for (std::size_t i = 0; i < facets_.size(); ++i)
      if (const Facet& f = facets_[i]; gone_[i])
        continue;
      else if (f.source >= 0)
        meshes_.skin.triangles.push_back({f.corners, f.source, f.inner});
      else
        meshes_.sheet.triangles.push_back({f.corners, f.outer, f.inner});
    meshes_.skin.split();
    meshes_.sheet.split();
  }

  const TetMesh& tets_;
  const Arrangement& a_;
  ClippedMeshes& meshes_;
  std::vector<unsigned char>& isCut_;
  std::vector<Facet> facets_;
  std::vector<unsigned char> gone_;  ///< per facet
  std::unordered_map<Index, std::vector<std::size_t>>
      around_;  ///< per corner of flat facets; may be out of date
};

}  // namespace

std::size_t absorbFlatTriangles(const TetMesh& tets, const Arrangement& arrangement, ClippedMeshes& meshes,
                                std::vector<unsigned char>& isCut) {
  if (meshes.flat == 0) return 0;
  return FlatAbsorber(tets, arrangement, meshes, isCut).run();
}

}  // namespace sherd
