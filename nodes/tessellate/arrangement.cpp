#include "tessellate/arrangement.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "geometry/disjoint_sets.h"
#include "geometry/exact_points.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 64;  ///< crack triangles a task

Error inconsistent(const char* what) {
  return failure(fmt::format("the cut surface does not close: {}", what),
                 "the surface may touch or cut itself; check it with LoadMesh");
}

/// Finds which edges cross which triangles, then works out all that follows.
class Arranger {
 public:
  Arranger(const TetMesh& tets, std::span<const Index> nodeLabel, const CrackComplex& complex,
           const Exec& exec)
      : tets_(tets), nodeLabel_(nodeLabel), complex_(complex), exec_(exec) {}

  Result<Arrangement> run() {
    number();
    if (exec_.cancelled()) return cancelledError();
    findCrossings();
    if (exec_.cancelled()) return cancelledError();
    SHERD_CHECK(orderCrossings());
    if (exec_.cancelled()) return cancelledError();
    placeCrossings();
    if (exec_.cancelled()) return cancelledError();
    SHERD_CHECK(labelSurface());
    if (exec_.cancelled()) return cancelledError();
    SHERD_CHECK(classifyCrack());
    if (exec_.cancelled()) return cancelledError();
    SHERD_CHECK(pairSegments());
    if (exec_.cancelled()) return cancelledError();
    findEqualPositions();
    return std::move(a_);
  }

 private:
  struct Pair {
    Index edge, triangle;
    friend auto operator<=>(const Pair&, const Pair&) = default;
  };

  void number() {
    const TriMesh& surface = *tets_.surface;
    a_.surface = surface.triangles;
    a_.firstCrack = static_cast<Index>(surface.positions.size());
    a_.firstNew = a_.firstCrack + static_cast<Index>(complex_.vertices.size());
    a_.positions.reserve(at(a_.firstNew) * 5 / 4);
    a_.positions = surface.positions;
    a_.positions.insert(a_.positions.end(), complex_.vertices.begin(), complex_.vertices.end());
    for (const CrackTriangle& c : complex_.triangles) {
      ownCrack_.push_back(c.corners);
      a_.crack.push_back(
          {c.corners[0] + a_.firstCrack, c.corners[1] + a_.firstCrack, c.corners[2] + a_.firstCrack});
    }
    a_.surfaceEdges = buildEdgeTable(surface.triangles, surface.positions.size());
    a_.crackEdges = buildEdgeTable(ownCrack_, complex_.vertices.size());
  }

  std::array<Index, 2> surfaceEnds(Index e) const { return a_.surfaceEdges.ends[at(e)]; }
  std::array<Index, 2> crackEnds(Index e) const {
    const auto& ends = a_.crackEdges.ends[at(e)];
    return {ends[0] + a_.firstCrack, ends[1] + a_.firstCrack};
  }

  /// Tests each crack triangle against the surface triangles that its tetrahedron holds.
  void findCrossings() {
    const std::size_t n = a_.crack.size(), blocks = (n + kBlock - 1) / kBlock;
    std::vector<std::vector<Pair>> surfacePairs(blocks), crackPairs(blocks);
    const ExactPoints points(a_.positions);
    parallelFor(exec_, n, kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c)
        testTriangle(points, static_cast<Index>(c), surfacePairs[begin / kBlock], crackPairs[begin / kBlock]);
    });
    auto merge = [](std::vector<std::vector<Pair>>& lists, std::vector<Crossing>& out) {
      std::vector<Pair> all;
      for (auto& list : lists) all.insert(all.end(), list.begin(), list.end());
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(), all.end()), all.end());
      for (const Pair& p : all) out.push_back({p.edge, p.triangle, false, -1});
    };
    merge(surfacePairs, a_.surfaceCrossings.list);
    merge(crackPairs, a_.crackCrossings.list);
  }

  void testTriangle(const ExactPoints& points, Index c, std::vector<Pair>& surfacePairs,
                    std::vector<Pair>& crackPairs) const {
    const Triangle& crack = a_.crack[at(c)];
    Box box;
    for (const Index v : crack) box.add(a_.positions[at(v)]);
    const std::size_t tet = at(complex_.triangles[at(c)].tet);
    for (Index h = tets_.heldBegin[tet]; h < tets_.heldBegin[tet + 1]; ++h) {
      const Index s = tets_.held[at(h)];
      const Triangle& surface = a_.surface[at(s)];
      Box other;
      for (const Index v : surface) other.add(a_.positions[at(v)]);
      if (!box.overlaps(other)) continue;
      for (std::size_t e = 0; e < 3; ++e) {
        if (points.crosses(surface[e], surface[(e + 1) % 3], crack))
          surfacePairs.push_back({a_.surfaceEdges.ofTriangle[at(s)][e], c});
        if (points.crosses(crack[e], crack[(e + 1) % 3], surface))
          crackPairs.push_back({a_.crackEdges.ofTriangle[at(c)][e], s});
      }
    }
  }

  // What lies on the two sides of a crossed triangle: cells for a sheet, inside (0) and outside (1) for the
  // surface.
  std::array<Index, 2> cellsAcross(const Crossing& x) const {
    const CrackTriangle& c = complex_.triangles[at(x.triangle)];
    return x.fromFront ? std::array{c.front, c.back} : std::array{c.back, c.front};
  }
  static std::array<Index, 2> sidesAcross(const Crossing& x) {
    return x.fromFront ? std::array<Index, 2>{1, 0} : std::array<Index, 2>{0, 1};
  }

  /// Sorts crossings along their edges. Crossings at the very same point are put in an order in which each
  /// leaves the region where the next begins.
  template <class Ends, class Across>
  bool orderAlong(EdgeCrossings& crossings, std::size_t edgeCount, std::span<const Triangle> triangles,
                  Ends ends, Across across) {
    const ExactPoints points(a_.positions);
    auto& list = crossings.list;
    crossings.begin.assign(edgeCount + 1, 0);
    for (const Crossing& x : list) ++crossings.begin[at(x.edge) + 1];
    std::partial_sum(crossings.begin.begin(), crossings.begin.end(), crossings.begin.begin());
    bool consistent = true;
    for (std::size_t first = 0; first < list.size();) {
      std::size_t last = first;
      while (last < list.size() && list[last].edge == list[first].edge) ++last;
      const auto [p, q] = ends(list[first].edge);
      for (std::size_t i = first; i < last; ++i)
        list[i].fromFront = points.side(triangles[at(list[i].triangle)], p) > 0;
      const auto order = [&, p = p, q = q](const Crossing& x, const Crossing& y) {
        return points.compareCrossings(p, q, triangles[at(x.triangle)], triangles[at(y.triangle)]) < 0;
      };
      std::stable_sort(list.begin() + static_cast<std::ptrdiff_t>(first),
                       list.begin() + static_cast<std::ptrdiff_t>(last), order);
      consistent = chain(std::span(list).subspan(first, last - first), order, across) && consistent;
      first = last;
    }
    return consistent;
  }

  template <class Order, class Across>
  static bool chain(std::span<Crossing> run, Order order, Across across) {
    auto follows = [&](const Crossing& x, const Crossing& y) { return across(x)[1] == across(y)[0]; };
    for (std::size_t i = 0; i + 1 < run.size(); ++i) {
      if (i > 0 ? follows(run[i - 1], run[i]) : follows(run[i], run[i + 1]) || order(run[i], run[i + 1]))
        continue;
      // Among those tied with this one, take the first that continues the chain.
      std::size_t end = i + 1;
      while (end < run.size() && !order(run[i], run[end])) ++end;
      for (std::size_t j = i; j < end; ++j) {
        bool fits = i > 0 ? follows(run[i - 1], run[j]) : true;
        if (i == 0)  // a beginning is where no other tied crossing arrives
          for (std::size_t k = i; k < end; ++k) fits = fits && (k == j || !follows(run[k], run[j]));
        if (!fits) continue;
        std::swap(run[i], run[j]);
        break;
      }
    }
    for (std::size_t i = 0; i + 1 < run.size(); ++i)
      if (!follows(run[i], run[i + 1])) return false;
    return true;
  }

  Result<void> orderCrossings() {
    const bool surfaceFits = orderAlong(
        a_.surfaceCrossings, a_.surfaceEdges.ends.size(), a_.crack,
        [this](Index e) { return surfaceEnds(e); }, [this](const Crossing& x) { return cellsAcross(x); });
    const bool crackFits = orderAlong(
        a_.crackCrossings, a_.crackEdges.ends.size(), a_.surface, [this](Index e) { return crackEnds(e); },
        sidesAcross);
    if (!surfaceFits) return inconsistent("cells do not follow each other along an edge of the surface");
    if (!crackFits) return inconsistent("inside and outside do not alternate along an edge of a sheet");
    return {};
  }

  void placeCrossings() {
    Index next = a_.firstNew;
    for (EdgeCrossings* crossings : {&a_.surfaceCrossings, &a_.crackCrossings})
      for (Crossing& x : crossings->list) x.vertex = next++;
    a_.positions.resize(at(next));
    const ExactPoints points(a_.positions);
    auto place = [&](const EdgeCrossings& crossings, std::span<const Triangle> triangles, auto ends) {
      parallelFor(exec_, crossings.list.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Crossing& x = crossings.list[i];
          const auto [p, q] = ends(x.edge);
          a_.positions[at(x.vertex)] = points.crossing(p, q, triangles[at(x.triangle)]);
        }
      });
    };
    place(a_.surfaceCrossings, a_.crack, [this](Index e) { return surfaceEnds(e); });
    place(a_.crackCrossings, a_.surface, [this](Index e) { return crackEnds(e); });
  }

  /// Spreads what is known at the ends of crossed edges over the uncrossed ones. -1 where nothing is known.
  template <class Across>
  static bool spread(const EdgeTable& edges, const EdgeCrossings& crossings, std::size_t vertices,
                     Across across, std::vector<Index>& known, DisjointSets& sets) {
    for (std::size_t e = 0; e < edges.ends.size(); ++e)
      if (crossings.on(static_cast<Index>(e)).empty()) sets.join(at(edges.ends[e][0]), at(edges.ends[e][1]));
    std::vector<Index> ofRoot(vertices, -1);
    bool consistent = true;
    auto tell = [&](Index vertex, Index what) {
      Index& slot = ofRoot[sets.find(at(vertex))];
      if (slot >= 0 && slot != what) consistent = false;
      slot = what;
    };
    for (std::size_t e = 0; e < edges.ends.size(); ++e) {
      const auto on = crossings.on(static_cast<Index>(e));
      if (on.empty()) continue;
      tell(edges.ends[e][0], across(on.front())[0]);
      tell(edges.ends[e][1], across(on.back())[1]);
    }
    known.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) known[v] = ofRoot[sets.find(v)];
    return consistent;
  }

  Result<void> labelSurface() {
    const std::size_t n = tets_.surface->positions.size();
    DisjointSets sets(n);
    if (!spread(
            a_.surfaceEdges, a_.surfaceCrossings, n, [this](const Crossing& x) { return cellsAcross(x); },
            a_.surfaceLabel, sets))
      return inconsistent("a part of the surface lies in two cells");
    // Parts of the surface that no sheet crosses: one vertex of each is located in the tetrahedra.
    std::vector<Index> missing(n, -1);
    for (std::size_t v = 0; v < n; ++v) {
      if (a_.surfaceLabel[v] >= 0) continue;
      Index& label = missing[sets.find(v)];
      if (label < 0) label = locate(static_cast<Index>(v));
      if (label < 0) return inconsistent("a vertex of the surface lies in no tetrahedron");
      a_.surfaceLabel[v] = label;
    }
    return {};
  }

  /// The cell of a surface vertex, found in the tetrahedron that holds it: the first sheet met on the way to
  /// one of its nodes, or that node's own cell.
  Index locate(Index vertex) {
    // The tetrahedra's nodes and crack vertices are numbered behind the surface's, as in `positions`.
    std::vector<Vec3> all(a_.positions.begin(), a_.positions.begin() + a_.firstNew);
    all.insert(all.end(), tets_.nodes.begin(), tets_.nodes.end());
    const ExactPoints points(all);
    for (std::size_t t = 0; t < tets_.tets.size(); ++t) {
      Tetra tet = tets_.tets[t];
      Box box;
      for (Index& node : tet) {
        box.add(tets_.nodes[at(node)]);
        node += a_.firstNew;
      }
      const Vec3& p = all[at(vertex)];
      if ((p.array() < box.low.array()).any() || (p.array() > box.high.array()).any()) continue;
      bool inside = true;
      for (const auto& f : kTetraFace)
        inside = inside &&
                 points.orientation(tet[static_cast<std::size_t>(f[0])], tet[static_cast<std::size_t>(f[1])],
                                    tet[static_cast<std::size_t>(f[2])], vertex) < 0;
      if (inside) return cellTowards(points, vertex, tet[0], static_cast<Index>(t));
    }
    return -1;
  }

  Index cellTowards(const ExactPoints& points, Index vertex, Index node, Index tet) const {
    Index nearest = -1;
    for (std::size_t c = 0; c < a_.crack.size(); ++c) {
      if (complex_.triangles[c].tet != tet || !points.crosses(vertex, node, a_.crack[c])) continue;
      if (nearest < 0 || points.compareCrossings(vertex, node, a_.crack[c], a_.crack[at(nearest)]) < 0)
        nearest = static_cast<Index>(c);
    }
    if (nearest < 0) return nodeLabel_[at(node - a_.firstNew)];
    const CrackTriangle& c = complex_.triangles[at(nearest)];
    return points.side(a_.crack[at(nearest)], vertex) > 0 ? c.front : c.back;
  }

  Result<void> classifyCrack() {
    const std::size_t n = complex_.vertices.size();
    DisjointSets sets(n);
    std::vector<Index> side;
    if (!spread(a_.crackEdges, a_.crackCrossings, n, sidesAcross, side, sets))
      return inconsistent("a part of a sheet lies both inside and outside of the surface");
    std::vector<Index> ofRoot(n, -1);
    for (std::size_t v = 0; v < n; ++v)
      if (side[v] < 0 && complex_.onCage[v]) ofRoot[sets.find(v)] = 1;
    // Sheets that the surface does not cross at all and that do not reach the cage's boundary: rare.
    std::optional<SurfaceTree> tree;
    a_.crackInside.assign(n, false);
    for (std::size_t v = 0; v < n; ++v) {
      if (side[v] < 0) {
        Index& known = ofRoot[sets.find(v)];
        if (known < 0) {
          if (!tree) tree.emplace(tets_.surface->positions, tets_.surface->triangles);
          known = tree->contains(complex_.vertices[v]) ? 0 : 1;
        }
        side[v] = known;
      }
      a_.crackInside[v] = side[v] == 0;
    }
    return {};
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
    for (const Crossing& x : a_.surfaceCrossings.list)
      for (const Index s : a_.surfaceEdges.trianglesOf(x.edge))
        ends.push_back(
            {s, x.triangle, x.vertex, runsForward(a_.surfaceEdges, a_.surface, s, x.edge) != x.fromFront});
    for (const Crossing& x : a_.crackCrossings.list)
      for (const Index c : a_.crackEdges.trianglesOf(x.edge))
        ends.push_back(
            {x.triangle, c, x.vertex, runsForward(a_.crackEdges, ownCrack_, c, x.edge) == x.fromFront});
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return std::tuple(a.surface, a.crack, !a.starts, a.vertex) <
             std::tuple(b.surface, b.crack, !b.starts, b.vertex);
    });
    for (std::size_t i = 0; i < ends.size(); i += 2) {
      if (i + 1 >= ends.size() || ends[i].surface != ends[i + 1].surface ||
          ends[i].crack != ends[i + 1].crack || !ends[i].starts || ends[i + 1].starts)
        return inconsistent("two triangles meet in something else than a segment");
      a_.segments.push_back({ends[i].surface, ends[i].crack, ends[i].vertex, ends[i + 1].vertex});
    }
    return {};
  }

  static bool runsForward(const EdgeTable& edges, std::span<const Triangle> triangles, Index t, Index edge) {
    int slot = 0;
    while (slot < 2 && edges.ofTriangle[at(t)][static_cast<std::size_t>(slot)] != edge) ++slot;
    return edges.forward(triangles, t, slot);
  }

  /// Among the sheets' vertices, the crossings, and the corners of crossed surface triangles.
  void findEqualPositions() {
    std::vector<Index> involved;
    for (Index v = a_.firstCrack; at(v) < a_.positions.size(); ++v) involved.push_back(v);
    auto corners = [&](Index s) {
      involved.insert(involved.end(), a_.surface[at(s)].begin(), a_.surface[at(s)].end());
    };
    for (const Crossing& x : a_.surfaceCrossings.list)
      for (const Index s : a_.surfaceEdges.trianglesOf(x.edge)) corners(s);
    for (const Crossing& x : a_.crackCrossings.list) corners(x.triangle);
    auto key = [&](Index v) {
      const Vec3& p = a_.positions[at(v)];
      return std::tuple(p.x(), p.y(), p.z(), v);
    };
    std::sort(involved.begin(), involved.end(), [&](Index i, Index j) { return key(i) < key(j); });
    a_.same.resize(a_.positions.size());
    std::iota(a_.same.begin(), a_.same.end(), Index{0});
    for (std::size_t i = 1; i < involved.size(); ++i)
      if (a_.positions[at(involved[i])] == a_.positions[at(involved[i - 1])])
        a_.same[at(involved[i])] = a_.same[at(involved[i - 1])];
  }

  const TetMesh& tets_;
  std::span<const Index> nodeLabel_;
  const CrackComplex& complex_;
  const Exec& exec_;
  std::vector<Triangle> ownCrack_;  ///< the sheets' triangles in the complex's own numbers
  Arrangement a_;
};

}  // namespace

Result<Arrangement> arrange(const TetMesh& tets, std::span<const Index> nodeLabel,
                            const CrackComplex& complex, const Exec& exec) {
  return Arranger(tets, nodeLabel, complex, exec).run();
}

}  // namespace sherd
