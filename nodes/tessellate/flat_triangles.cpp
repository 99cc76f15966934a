#include "tessellate/flat_triangles.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace sherd {
namespace {

/// A triangle between two cells, or a cell (`inner`) and the outside.
struct Facet {
  Triangle corners;
  Index inner, outer;  ///< `outer`: the front of a sheet, −1 outside
  Index source;        ///< the surface triangle, −1 for a sheet's

  bool isOfOneSheetWith(const Facet& o) const { return inner == o.inner && outer == o.outer; }
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
      std::erase_if(flat, [&](std::size_t f) { return absorb(f); });
      absorbed += before - flat.size();
      again = flat.size() < before;  // what has absorbed one may be what another waits for
    }
    if (absorbed > 0 || facets_.size() > meshes_.skin.triangles.size() + meshes_.sheet.triangles.size())
      putBack();
    return absorbed;
  }

 private:
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

  /// Splits what lies across the longest side at the third corner; false where that can't be done.
  bool absorb(std::size_t f) {
    const Triangle t = facets_[f].corners;
    const std::size_t base = baseOf(t);
    const Index p = t[base], q = t[(base + 1) % 3], middle = t[(base + 2) % 3];
    const std::optional<std::size_t> other = across(f, p, q);
    if (!other) return false;
    const Facet& neighbour = facets_[*other];
    const Index apex = neighbour.corners[(sideFrom(neighbour, q, p) + 2) % 3];
    const Triangle one{q, middle, apex}, two{middle, p, apex};
    if (apex == middle || isFlat(one) || isFlat(two) || hasEdge(middle, apex, facets_[f])) return false;
    facets_[f] = {one, neighbour.inner, neighbour.outer, neighbour.source};
    facets_[*other].corners = two;
    enlist(f);
    enlist(*other);
    return true;
  }

  /// The one facet of f's sheet or skin with the edge from q to p.
  std::optional<std::size_t> across(std::size_t f, Index p, Index q) {
    std::optional<std::size_t> found;
    for (const std::size_t g : around_.at(q)) {
      if (g == f || found == g || !facets_[g].isOfOneSheetWith(facets_[f]) || sideFrom(facets_[g], q, p) == 3)
        continue;
      if (found) return std::nullopt;
      found = g;
    }
    return found ? found : uncutAcross(facets_[f], p, q);
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
    enlist(facets_.size() - 1);
    return facets_.size() - 1;
  }

  /// An edge between the two in the border of one of f's cells, which a second one would make ambiguous.
  bool hasEdge(Index v, Index w, const Facet& f) const {
    return std::ranges::any_of(around_.at(v), [&](std::size_t g) {
      const Facet& o = facets_[g];
      return (o.bounds(f.inner) || o.bounds(f.outer)) && (sideFrom(o, v, w) < 3 || sideFrom(o, w, v) < 3);
    });
  }

  void putBack() {
    meshes_.skin.triangles.clear();
    meshes_.sheet.triangles.clear();
    for (const Facet& f : facets_)
      if (f.source >= 0)
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
