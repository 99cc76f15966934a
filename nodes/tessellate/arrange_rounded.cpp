#include <algorithm>

#include "base/parallel.h"
#include "geometry/edge_table.h"
#include "geometry/exact_points.h"
#include "tessellate/arrangement.h"
#include "tessellate/crossing_order.h"
#include "tessellate/equal_positions.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 64;  ///< sheet triangles a task

/// Finds which edges cross which triangles, then works out all that follows.
class Arranger {
 public:
  Arranger(const TetMesh& tets, std::span<const Index> nodeLabel, const Sheets& sheets, double spot,
           const Exec& exec)
      : tets_(tets), nodeLabel_(nodeLabel), sheets_(sheets), exec_(exec) {
    a_.spot = spot;
  }

  Result<Arrangement> run() {
    number();
    findCrossings();
    if (exec_.cancelled()) return cancelledError();
    if (!orderSurface())
      return inconsistentCut("cells do not follow each other along an edge of the surface");
    if (!orderSheets())
      return inconsistentCut("inside and outside do not alternate along an edge of a sheet");
    if (exec_.cancelled()) return cancelledError();
    placeCrossings();
    SHERD_CHECK(labelSurface());
    if (exec_.cancelled()) return cancelledError();
    SHERD_CHECK(classifySheets(tets_, sheets_, a_));
    if (exec_.cancelled()) return cancelledError();
    SHERD_CHECK(pairSegments());
    nameCutTriangles();
    groupBySurface(a_);
    groupByPolygon(sheets_.polygons.size(), a_);
    a_.same = equalPositions(a_);
    return std::move(a_);
  }

 private:
  struct Pair {
    Index edge, through;
    friend auto operator<=>(const Pair&, const Pair&) = default;
  };

  void number() {
    const TriMesh& surface = *tets_.surface;
    a_.surface = surface.triangles;
    a_.firstCrack = static_cast<Index>(surface.positions.size());
    a_.firstNew = a_.firstCrack + static_cast<Index>(sheets_.vertices.size());
    a_.positions = surface.positions;
    a_.positions.insert(a_.positions.end(), sheets_.vertices.begin(), sheets_.vertices.end());
    for (const SheetPolygon& p : sheets_.polygons) {
      const auto c = sheets_.cornersOf(p);
      crack_.push_back({c[0] + a_.firstCrack, c[1] + a_.firstCrack, c[2] + a_.firstCrack});
    }
    surfaceEdges_ = buildEdgeTable(surface.triangles, surface.positions.size());
  }

  std::array<Index, 2> surfaceEnds(Index e) const { return surfaceEdges_.ends[at(e)]; }
  std::array<Index, 2> sheetEnds(Index e) const {
    const auto& ends = sheets_.edges[at(e)];
    return {ends[0] + a_.firstCrack, ends[1] + a_.firstCrack};
  }

  /// Tests each sheet triangle against the surface triangles that its tetrahedron holds.
  void findCrossings() {
    const std::size_t n = crack_.size(), blocks = (n + kBlock - 1) / kBlock;
    std::vector<std::vector<Pair>> surfacePairs(blocks), crackPairs(blocks);
    const ExactPoints points(a_.positions, a_.firstCrack);
    parallelFor(exec_, n, kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c)
        testTriangle(points, static_cast<Index>(c), surfacePairs[begin / kBlock], crackPairs[begin / kBlock]);
    });
    merge(
        points, surfacePairs, crack_, [this](Index e) { return surfaceEnds(e); }, surfaceCrossings_);
    merge(
        points, crackPairs, a_.surface, [this](Index e) { return sheetEnds(e); }, a_.sheetCrossings);
    indexByEdge(surfaceCrossings_, surfaceEdges_.ends.size());
    indexByEdge(a_.sheetCrossings, sheets_.edges.size());
  }

  template <class Ends>
  static void merge(const ExactPoints& points, std::vector<std::vector<Pair>>& lists,
                    std::span<const Triangle> triangles, Ends ends, EdgeCrossings& out) {
    std::vector<Pair> all;
    for (auto& list : lists) all.insert(all.end(), list.begin(), list.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const Pair& p : all)
      out.list.push_back({p.edge, p.through, points.side(triangles[at(p.through)], ends(p.edge)[0]) > 0, -1});
  }

  void testTriangle(const ExactPoints& points, Index c, std::vector<Pair>& surfacePairs,
                    std::vector<Pair>& crackPairs) const {
    const Triangle& crack = crack_[at(c)];
    Box box;
    for (const Index v : crack) box.add(a_.positions[at(v)]);
    const std::size_t tet = at(sheets_.polygons[at(c)].tet);
    for (Index h = tets_.heldBegin[tet]; h < tets_.heldBegin[tet + 1]; ++h) {
      const Index s = tets_.held[at(h)];
      const Triangle& surface = a_.surface[at(s)];
      Box other;
      for (const Index v : surface) other.add(a_.positions[at(v)]);
      if (!box.overlaps(other)) continue;
      for (std::size_t e = 0; e < 3; ++e) {
        if (points.crosses(surface[e], surface[(e + 1) % 3], crack))
          surfacePairs.push_back({surfaceEdges_.ofTriangle[at(s)][e], c});
        if (points.crosses(crack[e], crack[(e + 1) % 3], surface))
          crackPairs.push_back({sheets_.edgesOf(sheets_.polygons[at(c)])[e], s});
      }
    }
  }

  bool orderSurface() {
    const ExactPoints points(a_.positions, a_.firstCrack);
    return orderAlongEdges(
        surfaceCrossings_,
        [&](const Crossing& x, const Crossing& y) {
          const auto [p, q] = surfaceEdges_.ends[at(x.edge)];
          return points.compareCrossings(p, q, crack_[at(x.through)], crack_[at(y.through)]) < 0;
        },
        [this](const Crossing& x) { return cellsAcross(sheets_, x); });
  }

  bool orderSheets() {
    const ExactPoints points(a_.positions, a_.firstCrack);
    return orderAlongEdges(
        a_.sheetCrossings,
        [&](const Crossing& x, const Crossing& y) {
          const auto [p, q] = sheetEnds(x.edge);
          return points.compareCrossings(p, q, a_.surface[at(x.through)], a_.surface[at(y.through)]) < 0;
        },
        sidesAcross);
  }

  void placeCrossings() {
    Index next = a_.firstNew;
    for (EdgeCrossings* crossings : {&surfaceCrossings_, &a_.sheetCrossings})
      for (Crossing& x : crossings->list) x.vertex = next++;
    a_.positions.resize(at(next));
    const ExactPoints points(a_.positions, a_.firstCrack);
    auto place = [&](const EdgeCrossings& crossings, std::span<const Triangle> triangles, auto ends) {
      parallelFor(exec_, crossings.list.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Crossing& x = crossings.list[i];
          const auto [p, q] = ends(x.edge);
          a_.positions[at(x.vertex)] = points.crossing(p, q, triangles[at(x.through)]);
        }
      });
    };
    place(surfaceCrossings_, crack_, [this](Index e) { return surfaceEnds(e); });
    place(a_.sheetCrossings, a_.surface, [this](Index e) { return sheetEnds(e); });
  }

  Result<void> labelSurface() {
    const std::size_t n = tets_.surface->positions.size();
    DisjointSets sets(n);
    a_.surfaceLabel.assign(n, -1);
    if (!spreadOverEdges(
            surfaceEdges_.ends.size(), [this](std::size_t e) { return surfaceEdges_.ends[e]; },
            surfaceCrossings_, [this](const Crossing& x) { return cellsAcross(sheets_, x); }, a_.surfaceLabel,
            sets))
      return inconsistentCut("a part of the surface lies in two cells");
    // Parts of the surface that no sheet crosses: one vertex of each is located in the tetrahedra.
    std::vector<Index> missing(n, -1);
    for (std::size_t v = 0; v < n; ++v) {
      if (a_.surfaceLabel[v] >= 0) continue;
      Index& label = missing[sets.find(v)];
      if (label < 0) label = locate(static_cast<Index>(v));
      if (label < 0) return inconsistentCut("a vertex of the surface lies in no tetrahedron");
      a_.surfaceLabel[v] = label;
    }
    return {};
  }

  /// The cell of a surface vertex: the first sheet met on the way to a node of the tetrahedron that holds it,
  /// or that node's own cell.
  Index locate(Index vertex) {
    const Index tet = tets_.vertexTet[at(vertex)];
    if (tet < 0) return -1;
    if (withNodes_.empty()) {
      withNodes_.assign(a_.positions.begin(), a_.positions.begin() + a_.firstNew);
      withNodes_.insert(withNodes_.end(), tets_.nodes.begin(), tets_.nodes.end());
    }
    return cellTowards(ExactPoints(withNodes_, a_.firstCrack), vertex, tets_.tets[at(tet)][0] + a_.firstNew);
  }

  /// Of all sheets: a vertex on a face may pass, when moved, into the next tetrahedron.
  Index cellTowards(const ExactPoints& points, Index vertex, Index node) const {
    Box way;
    way.add(points[vertex]);
    way.add(points[node]);
    Index nearest = -1;
    for (std::size_t c = 0; c < crack_.size(); ++c) {
      Box box;
      for (const Index v : crack_[c]) box.add(points[v]);
      if (!way.overlaps(box) || !points.crosses(vertex, node, crack_[c])) continue;
      if (nearest < 0 || points.compareCrossings(vertex, node, crack_[c], crack_[at(nearest)]) < 0)
        nearest = static_cast<Index>(c);
    }
    if (nearest < 0) return nodeLabel_[at(node - a_.firstNew)];
    const SheetPolygon& c = sheets_.polygons[at(nearest)];
    return points.side(crack_[at(nearest)], vertex) > 0 ? c.front : c.back;
  }

  struct End {
    Index surface, crack, vertex;
    bool starts;
  };

  /// Each crossing is an end of the segments of all triangles around its edge. On the surface triangle the
  /// segment has the back cell on its left, so it starts where the border, counter-clockwise, passes from
  /// back to front.
  Result<void> pairSegments() {
    std::vector<End> ends;
    for (const Crossing& x : surfaceCrossings_.list)
      for (const Index s : surfaceEdges_.trianglesOf(x.edge))
        ends.push_back({s, x.through, x.vertex, runsForward(s, x.edge) != x.fromFront});
    std::vector<std::vector<std::array<Index, 2>>> uses(sheets_.edges.size());  // polygon and slot
    for (std::size_t p = 0; p < sheets_.polygons.size(); ++p)
      for (Index slot = 0; slot < sheets_.polygons[p].count; ++slot)
        uses[at(sheets_.edgesOf(sheets_.polygons[p])[at(slot)])].push_back({static_cast<Index>(p), slot});
    for (const Crossing& x : a_.sheetCrossings.list)
      for (const auto& [p, slot] : uses[at(x.edge)])
        ends.push_back(
            {x.through, p, x.vertex, sheets_.forward(sheets_.polygons[at(p)], slot) == x.fromFront});
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return std::tuple(a.surface, a.crack, !a.starts, a.vertex) <
             std::tuple(b.surface, b.crack, !b.starts, b.vertex);
    });
    for (std::size_t i = 0; i < ends.size(); i += 2) {
      if (i + 1 >= ends.size() || ends[i].surface != ends[i + 1].surface ||
          ends[i].crack != ends[i + 1].crack || !ends[i].starts || ends[i + 1].starts)
        return inconsistentCut("two triangles meet in something else than a segment");
      a_.segments.push_back({ends[i].surface, ends[i].crack, ends[i].vertex, ends[i + 1].vertex});
    }
    return {};
  }

  bool runsForward(Index t, Index edge) const {
    int slot = 0;
    while (slot < 2 && surfaceEdges_.ofTriangle[at(t)][static_cast<std::size_t>(slot)] != edge) ++slot;
    return surfaceEdges_.forward(a_.surface, t, slot);
  }

  /// Keeps of the surface's edges those that are crossed.
  void nameCutTriangles() {
    std::vector<Index> cutNumber(surfaceEdges_.ends.size(), -1);
    std::vector<unsigned char> isCut(a_.surface.size(), 0);
    for (const Segment& s : a_.segments) isCut[at(s.surface)] = 1;
    for (Crossing x : surfaceCrossings_.list) {
      Index& number = cutNumber[at(x.edge)];
      if (number < 0) {
        number = static_cast<Index>(a_.cutEdges.size());
        a_.cutEdges.push_back(surfaceEnds(x.edge));
      }
      x.edge = number;
      a_.surfaceCrossings.list.push_back(x);
    }
    indexByEdge(a_.surfaceCrossings, a_.cutEdges.size());
    for (std::size_t s = 0; s < isCut.size(); ++s) {
      if (!isCut[s]) continue;
      a_.cutTriangles.push_back(static_cast<Index>(s));
      std::array<Index, 3> sides{};
      for (std::size_t c = 0; c < 3; ++c) sides[c] = cutNumber[at(surfaceEdges_.ofTriangle[s][c])];
      a_.edgesOfCut.push_back(sides);
    }
  }

  const TetMesh& tets_;
  std::span<const Index> nodeLabel_;
  const Sheets& sheets_;
  const Exec& exec_;
  std::vector<Triangle> crack_;  ///< the sheets' triangles, numbered as in the arrangement
  EdgeTable surfaceEdges_;
  EdgeCrossings surfaceCrossings_;  ///< by surfaceEdges_
  std::vector<Vec3> withNodes_;     ///< the tetrahedra's nodes behind the sheets' vertices; made when needed
  Arrangement a_;
};

}  // namespace

Result<Arrangement> arrangeRounded(const TetMesh& tets, std::span<const Index> nodeLabel,
                                   const Sheets& sheets, double spot, const Exec& exec) {
  return Arranger(tets, nodeLabel, sheets, spot, exec).run();
}

}  // namespace sherd
