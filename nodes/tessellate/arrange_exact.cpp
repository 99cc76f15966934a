#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/copy_points.h"
#include "tessellate/arrangement.h"
#include "tessellate/bucket_sort.h"
#include "tessellate/crossing_order.h"
#include "tessellate/equal_positions.h"
#include "tessellate/tet_search.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 32;  ///< cut tetrahedra a task

class Arranger {
 public:
  Arranger(const TetMesh& tets, ExactSheets& exact, const SiteValues& values, double spot, const Exec& exec)
      : tets_(tets),
        exact_(exact),
        sheets_(exact.sheets),
        values_(values),
        exec_(exec),
        positions_(tets.surface->positions),
        triangles_(tets.surface->triangles) {
    a_.spot = spot;
  }

  Result<Arrangement> run() {
    groupByTet();
    findSegments();
    if (exec_.cancelled()) return cancelledError();
    number();
    TaskGroup placing;  // nothing of this needs places
    placing.run([this] { placeVertices(); });
    sortSegments();
    nameSurfaceEdges();
    groupBySurface(a_);
    groupByPolygon(sheets_.polygons.size(), a_);
    placing.wait();
    if (exec_.cancelled()) return cancelledError();
    TaskGroup tasks;
    tasks.run([this] { a_.same = equalPositions(a_); });
    SHERD_CHECK(orderCrossings());
    SHERD_CHECK(checkLabels());
    SHERD_CHECK(classifySheets(tets_, sheets_, a_));
    tasks.wait();
    return std::move(a_);
  }

 private:
  void groupByTet() {
    for (std::size_t p = 0; p < sheets_.polygons.size(); ++p)
      if (p == 0 || sheets_.polygons[p].tet != sheets_.polygons[p - 1].tet)
        tetBegin_.push_back(static_cast<Index>(p));
    cutTets_ = tetBegin_.size();
    tetBegin_.push_back(static_cast<Index>(sheets_.polygons.size()));
    cutTet_.assign(tets_.tets.size(), -1);
    for (std::size_t i = 0; i < cutTets_; ++i)
      cutTet_[at(sheets_.polygons[at(tetBegin_[i])].tet)] = static_cast<Index>(i);
  }

  void findSegments() {
    a_.surfaceLabel.assign(positions_.size(), -1);
    found_.resize((cutTets_ + kBlock - 1) / kBlock);
    TaskGroup tasks;
    tasks.run([this] { exact_.sheets.connect(); });  // one thread's work, and not needed to find segments
    parallelFor(exec_, cutTets_, kBlock, [&](std::size_t begin, std::size_t end) {
      TetSearch search(tets_, exact_, values_, a_.surfaceLabel, 2 * a_.spot);
      for (std::size_t i = begin; i < end; ++i)
        search.search(tetBegin_[i], tetBegin_[i + 1], found_[begin / kBlock]);
    });
    tasks.wait();
  }

  /// From the heaviest corner, so that a point close to a corner keeps that corner's digits; within the
  /// corners' box, so that a coordinate that they share stays.
  Vec3 placed(const Triangle& corners, const std::array<double, 3>& w) const {
    const auto base = static_cast<std::size_t>(std::max_element(w.begin(), w.end()) - w.begin());
    const Vec3& origin = positions_[at(corners[base])];
    Vec3 offset = Vec3::Zero();
    Box box;
    for (std::size_t c = 0; c < 3; ++c) {
      if (w[c] != 0) box.add(positions_[at(corners[c])]);
      if (c != base) offset += w[c] * (positions_[at(corners[c])] - origin);
    }
    return Vec3(origin + offset).cwiseMax(box.low).cwiseMin(box.high);
  }

  /// Gathers the blocks, gives each crossing one vertex, and ties the segments' ends to them.
  void number() {
    std::vector<FoundEnd> surfaceEnds, sheetEnds;
    std::vector<Segment>& segments = a_.segments;
    for (FoundSegments& block : found_) {
      const Index first = 2 * static_cast<Index>(segments.size());
      for (auto [from, to] :
           {std::pair(&block.surfaceEnds, &surfaceEnds), std::pair(&block.sheetEnds, &sheetEnds)})
        for (FoundEnd& end : *from) {
          end.segment += first;
          if (end.b < 0) end.a = sheets_.edgeOf[at(end.a)];
          to->push_back(end);
        }
      segments.insert(segments.end(), block.segments.begin(), block.segments.end());
    }
    a_.surface = triangles_;
    a_.firstCrack = static_cast<Index>(positions_.size());
    a_.firstNew = a_.firstCrack + static_cast<Index>(sheets_.vertices.size());
    takeEnds(surfaceEnds, positions_.size(), a_.surfaceCrossings);
    takeEnds(sheetEnds, sheets_.edges.size(), a_.sheetCrossings);
    indexByEdge(a_.surfaceCrossings, a_.cutEdges.size());
    indexByEdge(a_.sheetCrossings, sheets_.edges.size());
  }

  void sortSegments() {
    bucketSort(
        a_.segments, triangles_.size(), [](const Segment& s) { return s.surface; },
        [](const Segment& x, const Segment& y) {
          return std::tie(x.surface, x.polygon) < std::tie(y.surface, y.polygon);
        });
  }

  /// Each crossing by the first of the segments that end there.
  void placeVertices() {
    a_.positions.resize(at(a_.firstNew) + places_.size());
    parallelFor(exec_, positions_.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
      copyPoints(positions_.subspan(begin, end - begin), a_.positions.data() + begin);
    });
    copyPoints(sheets_.vertices, a_.positions.data() + a_.firstCrack);
    const double tolerance = 0x1p-52 * boxOf(tets_.nodes).diagonal();
    parallelFor(exec_, places_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [surface, polygon, segmentEnd] = places_[i];
        const TetFrame frame(tets_, values_, sheets_.polygons[at(polygon)].tet);
        TriangleInTet triangle(frame, triangles_[at(surface)], positions_);
        triangle.take(exact_.ranks[at(polygon)][0], exact_.ranks[at(polygon)][1], exact_.linesOf(polygon));
        a_.positions[at(a_.firstNew) + i] =
            placed(triangles_[at(surface)], triangle.weights(segmentEnd, tolerance));
      }
    });
  }

  void takeEnds(std::vector<FoundEnd>& ends, std::size_t keys, EdgeCrossings& out) {
    bucketSort(
        ends, keys, [](const FoundEnd& e) { return e.a; }, std::less<>());
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const FoundEnd& end = ends[i];
      if (i == 0 || !end.names(ends[i - 1])) {
        if (end.b >= 0 && (i == 0 || ends[i - 1].a != end.a || ends[i - 1].b != end.b))
          a_.cutEdges.push_back({end.a, end.b});
        const Index edge = end.b >= 0 ? static_cast<Index>(a_.cutEdges.size()) - 1 : end.a;
        out.list.push_back(
            {edge, end.through, end.fromFront, a_.firstNew + static_cast<Index>(places_.size())});
        const Segment& first = a_.segments[at(end.segment / 2)];
        places_.push_back({first.surface, first.polygon, end.end});
      }
      Segment& segment = a_.segments[at(end.segment / 2)];
      (end.segment % 2 == 0 ? segment.from : segment.to) = out.list.back().vertex;
    }
  }

  /// Which triangles are cut, and by which of their sides: those on which a segment ends.
  void nameSurfaceEdges() {
    for (const Segment& s : a_.segments) {
      if (a_.cutTriangles.empty() || a_.cutTriangles.back() != s.surface) {
        a_.cutTriangles.push_back(s.surface);
        a_.edgesOfCut.push_back({-1, -1, -1});
      }
      for (const Index end : {s.from, s.to}) {
        const std::size_t crossing =
            at(end - a_.firstNew);  // vertices are numbered as the crossings are listed
        if (crossing >= a_.surfaceCrossings.list.size()) continue;
        const Index edge = a_.surfaceCrossings.list[crossing].edge;
        a_.edgesOfCut.back()[sideOf(triangles_[at(s.surface)], a_.cutEdges[at(edge)])] = edge;
      }
    }
  }

  /// Which side of the triangle runs between these vertices.
  static std::size_t sideOf(const Triangle& t, const std::array<Index, 2>& ends) {
    std::size_t side = 0;
    while (std::min(t[side], t[(side + 1) % 3]) != ends[0] || std::max(t[side], t[(side + 1) % 3]) != ends[1])
      ++side;
    return side;
  }

  std::array<Vec3, 4> cornersOf(Index tet) const {
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = tets_.nodes[at(tets_.tets[at(tet)][i])];
    return corners;
  }

  Result<void> orderCrossings() {
    if (!orderAlongEdges(
            a_.surfaceCrossings,
            [&](const Crossing& x, const Crossing& y) { return isBeforeOnSurface(x, y); },
            [&](const Crossing& x) { return cellsAcross(sheets_, x); }))
      return inconsistentCut("cells do not follow each other along an edge of the surface");
    if (!orderAlongEdges(
            a_.sheetCrossings, [&](const Crossing& x, const Crossing& y) { return isBeforeOnSheet(x, y); },
            sidesAcross))
      return inconsistentCut("inside and outside do not alternate along an edge of a sheet");
    return {};
  }

  bool isBeforeOnSurface(const Crossing& x, const Crossing& y) const {
    const auto [p, q] = a_.cutEdges[at(x.edge)];
    const Vec3 &from = positions_[at(p)], &to = positions_[at(q)];
    const Vec3 direction = to - from;
    const double along = (a_.positions[at(y.vertex)] - a_.positions[at(x.vertex)]).dot(direction);
    if (std::abs(along) > 1e-11 * direction.squaredNorm() + slack(from, to, direction)) return along > 0;
    const std::array<Vec3, 2> ends{from, to};
    const auto frame = [&](const Crossing& c) {
      return TetFrame(tets_, values_, sheets_.polygons[at(c.through)].tet);
    };
    const TetFrame f = frame(x), g = frame(y);
    const auto [backX, frontX] = exact_.ranks[at(x.through)];
    const auto [backY, frontY] = exact_.ranks[at(y.through)];
    return compareAlongEdge(ends, f.corners, f.differenceFunction(frontX, backX), g.corners,
                            g.differenceFunction(frontY, backY)) < 0;
  }

  /// What rounding of the coordinates may add to a projection on `direction`.
  static double slack(const Vec3& a, const Vec3& b, const Vec3& direction) {
    return 0x1p-48 * std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()) * direction.norm();
  }

  bool isBeforeOnSheet(const Crossing& x, const Crossing& y) const {
    const auto [v, w] = sheets_.edges[at(x.edge)];
    const Vec3 &from = sheets_.vertices[at(v)], &to = sheets_.vertices[at(w)];
    const Vec3 direction = to - from;
    Box box;
    for (const Crossing* c : {&x, &y})
      for (const Index corner : triangles_[at(c->through)]) box.add(positions_[at(corner)]);
    const double along = (a_.positions[at(y.vertex)] - a_.positions[at(x.vertex)]).dot(direction);
    const double size = 1e-11 * (box.diagonal() + direction.norm());
    if (direction.norm() > size && std::abs(along) > size * direction.norm() + slack(from, to, direction))
      return along > 0;
    return isBeforeExactly(x, y);
  }

  bool isBeforeExactly(const Crossing& x, const Crossing& y) const {
    const auto [polygon, slot] = polygonAt(x.edge);
    const TetFrame frame(tets_, values_, sheets_.polygons[at(polygon)].tet);
    const auto [back, front] = exact_.ranks[at(polygon)];
    const SheetEdgeLine& line = exact_.linesOf(polygon)[at(slot)];
    const AffineFunction border =
        line.face >= 0 ? TetFrame::cornerFunction(line.face) : frame.differenceFunction(line.third, back);
    std::array<std::array<Vec3, 3>, 2> triangles;
    for (std::size_t c = 0; c < 3; ++c) {
      triangles[0][c] = positions_[at(triangles_[at(x.through)][c])];
      triangles[1][c] = positions_[at(triangles_[at(y.through)][c])];
    }
    // x comes first where it lies on the side of y's triangle that the edge comes from.
    const int side = sideOfMeeting(frame.corners, border, frame.differenceFunction(front, back), triangles[0],
                                   triangles[1]);
    return side == (y.fromFront ? 1 : -1);
  }

  /// A polygon with this edge, and the edge's place in it.
  std::array<Index, 2> polygonAt(Index edge) const {
    const Index corner = sheets_.cornersAlong(edge)[0];
    const auto after = std::upper_bound(sheets_.polygons.begin(), sheets_.polygons.end(), corner,
                                        [](Index c, const SheetPolygon& p) { return c < p.first; });
    const Index polygon = static_cast<Index>(after - sheets_.polygons.begin()) - 1;
    return {polygon, corner - sheets_.polygons[at(polygon)].first};
  }

  /// The cell of every surface vertex is the only one of its tetrahedron; searchTet has found those in cut
  /// ones.
  Result<void> checkLabels() {
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      if (a_.surfaceLabel[v] >= 0) continue;
      const Index tet = tets_.vertexTet[v];
      if (tet < 0 || cutTet_[at(tet)] >= 0)
        return inconsistentCut("a vertex of the surface lies in no tetrahedron");
      a_.surfaceLabel[v] = values_.site(values_.least(tets_.tets[at(tet)][0]));
    }
    for (std::size_t e = 0; e < a_.cutEdges.size(); ++e) {
      const auto on = a_.surfaceCrossings.on(static_cast<Index>(e));
      if (cellsAcross(sheets_, on.front())[0] != a_.surfaceLabel[at(a_.cutEdges[e][0])] ||
          cellsAcross(sheets_, on.back())[1] != a_.surfaceLabel[at(a_.cutEdges[e][1])])
        return inconsistentCut("a part of the surface lies in two cells");
    }
    return {};
  }

  const TetMesh& tets_;
  ExactSheets& exact_;
  const Sheets& sheets_;
  const SiteValues& values_;
  const Exec& exec_;
  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
  std::vector<Index> tetBegin_;  ///< per cut tetrahedron its first polygon; one more at the end
  std::vector<Index> cutTet_;    ///< per tetrahedron its number among the cut ones, or −1
  std::size_t cutTets_ = 0;
  struct Place {
    Index surface, polygon;
    SegmentEnd end;
  };

  std::vector<FoundSegments> found_;
  std::vector<Place> places_;  ///< per crossing
  Arrangement a_;
};

}  // namespace

Result<Arrangement> arrangeExact(const TetMesh& tets, ExactSheets& exact, const SiteValues& values,
                                 double spot, const Exec& exec) {
  return Arranger(tets, exact, values, spot, exec).run();
}

}  // namespace sherd
