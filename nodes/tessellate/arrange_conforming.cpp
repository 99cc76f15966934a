#include <algorithm>
#include <numeric>

#include "tessellate/arrangement.h"
#include "tessellate/crossing_order.h"
#include "tessellate/equal_positions.h"

namespace sherd {
namespace {

class Arranger {
 public:
  Arranger(const TetMesh& tets, std::span<const Index> nodeOf, std::span<const Index> nodeCell,
           const Sheets& sheets, double spot)
      : sheets_(sheets), vertexOf_(tets.nodes.size(), -1) {
    const TriMesh& surface = *tets.surface;
    a_.spot = spot;
    a_.surface = surface.triangles;
    a_.firstCrack = static_cast<Index>(surface.positions.size());
    a_.positions = surface.positions;
    a_.positions.insert(a_.positions.end(), sheets.vertices.begin(), sheets.vertices.end());
    a_.firstNew = static_cast<Index>(a_.positions.size());
    for (std::size_t v = 0; v < nodeOf.size(); ++v) {
      vertexOf_[at(nodeOf[v])] = static_cast<Index>(v);
      a_.surfaceLabel.push_back(nodeCell[at(nodeOf[v])]);
    }
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      faces_.push_back({sorted(t), static_cast<Index>(t)});
    std::sort(faces_.begin(), faces_.end());
  }

  Result<Arrangement> run() {
    findSegments();
    nameCutEdges();
    SHERD_CHECK(orderCrossings());
    a_.sheetCrossings.begin.assign(sheets_.edges.size() + 1, 0);
    a_.sheetInside.assign(sheets_.vertices.size(), 1);
    groupBySurface(a_);
    groupByPolygon(sheets_.polygons.size(), a_);
    a_.same = equalPositions(a_);
    return std::move(a_);
  }

 private:
  struct Face {
    Triangle corners;  ///< ascending
    Index triangle;
    friend bool operator<(const Face& x, const Face& y) { return x.corners < y.corners; }
  };
  /// A crossing by its edge's ends.
  struct Found {
    std::array<Index, 2> ends;
    Crossing crossing;
    friend bool operator<(const Found& x, const Found& y) {
      return std::tie(x.ends, x.crossing.vertex) < std::tie(y.ends, y.crossing.vertex);
    }
  };

  Triangle sorted(std::size_t triangle) const {
    Triangle t = a_.surface[triangle];
    std::sort(t.begin(), t.end());
    return t;
  }

  /// The surface triangle that an edge of the sheets lies on, or −1.
  Index triangleUnder(Index v, Index w) const {
    std::vector<Index> nodes;
    for (const Index corner : {v, w})
      for (const Index node : sheets_.simplexOf[at(corner)])
        if (node >= 0 && std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
    if (nodes.size() != 3) return -1;
    Face face{{vertexOf_[at(nodes[0])], vertexOf_[at(nodes[1])], vertexOf_[at(nodes[2])]}, -1};
    std::sort(face.corners.begin(), face.corners.end());
    const auto found = std::lower_bound(faces_.begin(), faces_.end(), face);
    return found != faces_.end() && found->corners == face.corners ? found->triangle : -1;
  }

  void findSegments() {
    for (std::size_t p = 0; p < sheets_.polygons.size(); ++p) {
      const auto corners = sheets_.cornersOf(sheets_.polygons[p]);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Index v = corners[i], w = corners[(i + 1) % corners.size()], s = triangleUnder(v, w);
        if (s < 0) continue;
        // Seen from the front the polygon lies left of vw; seen from outside the surface the front cell does.
        a_.segments.push_back({s, static_cast<Index>(p), w + a_.firstCrack, v + a_.firstCrack});
        addCrossing(s, static_cast<Index>(p), w, true);
        addCrossing(s, static_cast<Index>(p), v, false);
      }
    }
    std::sort(a_.segments.begin(), a_.segments.end(), [](const Segment& x, const Segment& y) {
      return std::tie(x.surface, x.polygon, x.from) < std::tie(y.surface, y.polygon, y.from);
    });
  }

  /// A segment that has the back cell on its left starts where the border, counter-clockwise, passes from
  /// back to front.
  void addCrossing(Index s, Index polygon, Index sheetVertex, bool starts) {
    const Tetra& simplex = sheets_.simplexOf[at(sheetVertex)];
    if (simplex[2] >= 0) return;
    std::array<Index, 2> ends{vertexOf_[at(simplex[0])], vertexOf_[at(simplex[1])]};
    std::sort(ends.begin(), ends.end());
    const Triangle& t = a_.surface[at(s)];
    bool forward = false;
    for (std::size_t c = 0; c < 3; ++c) forward = forward || (t[c] == ends[0] && t[(c + 1) % 3] == ends[1]);
    found_.push_back({ends, {-1, polygon, forward != starts, sheetVertex + a_.firstCrack}});
  }

  void nameCutEdges() {
    std::stable_sort(found_.begin(), found_.end());
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (i > 0 && found_[i].crossing.vertex == found_[i - 1].crossing.vertex)
        continue;  // seen from both sides
      if (a_.cutEdges.empty() || a_.cutEdges.back() != found_[i].ends) a_.cutEdges.push_back(found_[i].ends);
      found_[i].crossing.edge = static_cast<Index>(a_.cutEdges.size()) - 1;
      a_.surfaceCrossings.list.push_back(found_[i].crossing);
    }
    indexByEdge(a_.surfaceCrossings, a_.cutEdges.size());
    for (const Segment& s : a_.segments)
      if (a_.cutTriangles.empty() || a_.cutTriangles.back() != s.surface)
        a_.cutTriangles.push_back(s.surface);
    for (const Index s : a_.cutTriangles) {
      std::array<Index, 3> sides{};
      for (std::size_t c = 0; c < 3; ++c) {
        const Index v = a_.surface[at(s)][c], w = a_.surface[at(s)][(c + 1) % 3];
        const std::array<Index, 2> ends{std::min(v, w), std::max(v, w)};
        const auto found = std::lower_bound(a_.cutEdges.begin(), a_.cutEdges.end(), ends);
        sides[c] = found != a_.cutEdges.end() && *found == ends
                       ? static_cast<Index>(found - a_.cutEdges.begin())
                       : -1;
      }
      a_.edgesOfCut.push_back(sides);
    }
  }

  /// Along an edge of one tetrahedron every cell has one interval, so that the cells alone give the order.
  Result<void> orderCrossings() {
    for (std::size_t e = 0; e < a_.cutEdges.size(); ++e) {
      const auto first = a_.surfaceCrossings.list.begin() + a_.surfaceCrossings.begin[e],
                 last = a_.surfaceCrossings.list.begin() + a_.surfaceCrossings.begin[e + 1];
      Index cell = a_.surfaceLabel[at(a_.cutEdges[e][0])];
      for (auto x = first; x != last; ++x) {
        const auto next =
            std::find_if(x, last, [&](const Crossing& c) { return cellsAcross(sheets_, c)[0] == cell; });
        if (next == last)
          return inconsistentCut("cells do not follow each other along an edge of the surface");
        std::iter_swap(x, next);
        cell = cellsAcross(sheets_, *x)[1];
      }
      if (cell != a_.surfaceLabel[at(a_.cutEdges[e][1])])
        return inconsistentCut("a part of the surface lies in two cells");
    }
    return {};
  }

  const Sheets& sheets_;
  std::vector<Index> vertexOf_;  ///< per node, −1 for inner ones
  std::vector<Face> faces_;      ///< the surface's triangles by their corners
  std::vector<Found> found_;
  Arrangement a_;
};

}  // namespace

Result<Arrangement> arrangeConforming(const TetMesh& tets, std::span<const Index> nodeOf,
                                      std::span<const Index> nodeCell, const Sheets& sheets, double spot) {
  return Arranger(tets, nodeOf, nodeCell, sheets, spot).run();
}

}  // namespace sherd
