#include "tessellate/tet_search.h"

#include <algorithm>

namespace sherd {
namespace {

/// As Box::overlaps(), without branches, which would go either way.
bool overlap(const Box& a, const Box& b) {
  bool all = true;
  for (Eigen::Index k = 0; k < 3; ++k) all &= (a.low[k] <= b.high[k]) & (b.low[k] <= a.high[k]);
  return all;
}

}  // namespace

void TetSearch::search(Index first, Index last, FoundSegments& out) {
  const Index tet = exact_.sheets.polygons[at(first)].tet;
  const Index heldBegin = tets_.heldBegin[at(tet)], heldEnd = tets_.heldBegin[at(tet) + 1];
  if (heldBegin == heldEnd) return;
  prepare(first, last);
  const std::vector<Vec3>& positions = tets_.surface->positions;
  for (Index h = heldBegin; h < heldEnd; ++h) {
    const Index s = tets_.held[at(h)];
    const Triangle& corners = tets_.surface->triangles[at(s)];
    if (isInOneCell(corners, tet)) continue;
    std::optional<TriangleInTet> triangle;
    Box box;
    for (const Index v : corners) box.add(positions[at(v)]);
    for (Index p = first; p < last; ++p) {
      if (!overlap(box, boxes_[at(p - first)])) continue;
      if (planes_[at(p - first)].misses(positions[at(corners[0])], positions[at(corners[1])],
                                        positions[at(corners[2])]))
        continue;
      if (!triangle) triangle.emplace(*frame_, corners, positions);
      const auto [back, front] = exact_.ranks[at(p)];
      SegmentEnd ends[2];
      if (triangle->meets(back, front, exact_.linesOf(p), ends[0], ends[1]))
        addSegment(*triangle, ends, s, p, out);
    }
  }
}

void TetSearch::prepare(Index first, Index last) {
  frame_.emplace(tets_, values_, exact_.sheets.polygons[at(first)].tet);
  ranks_.clear(), planes_.clear(), boxes_.clear(), toFirst_.clear();
  for (Index p = first; p < last; ++p) {
    const auto& [back, front] = exact_.ranks[at(p)];
    planes_.emplace_back(*frame_, back, front);
    Box& box = boxes_.emplace_back();
    for (const Index v : exact_.sheets.cornersOf(exact_.sheets.polygons[at(p)]))
      box.add(exact_.sheets.vertices[at(v)]);
    box.low.array() -= rounding_, box.high.array() += rounding_;
    ranks_.push_back(back);
    ranks_.push_back(front);
  }
  std::sort(ranks_.begin(), ranks_.end());
  ranks_.erase(std::unique(ranks_.begin(), ranks_.end()), ranks_.end());
  for (std::size_t r = 1; r < ranks_.size(); ++r) toFirst_.emplace_back(*frame_, ranks_[0], ranks_[r]);
}

/// With all corners in the tetrahedron and in one cell, so is the triangle: cells are convex there.
bool TetSearch::isInOneCell(const Triangle& corners, Index tet) {
  bool one = true;
  Index label = -1;
  for (const Index v : corners) {
    if (tets_.vertexTet[at(v)] != tet) {
      one = false;
      continue;
    }
    const Index own = labelOf(v);
    one = one && (label < 0 || label == own);
    label = own;
  }
  return one;
}

Index TetSearch::labelOf(Index vertex) {
  Index& label = labels_[at(vertex)];
  if (label < 0) label = values_.site(leastAt(tets_.surface->positions[at(vertex)]));
  return label;
}

/// The rank that is least at a point of the tetrahedron.
Index TetSearch::leastAt(const Vec3& point) const {
  std::size_t best = 0;
  Approx least = 0;
  bool certain = true;
  for (std::size_t r = 1; r < ranks_.size(); ++r) {
    const Approx value = toFirst_[r - 1].value(point);
    const int sign = (value - least).sign();
    certain = certain && sign != 0;
    if (sign < 0) best = r, least = value;
  }
  if (certain) return ranks_[best];
  const auto coordinates = frame_->coordinates(point);
  Index rank = ranks_.front();
  for (const Index r : ranks_)
    if (r != rank && frame_->sign(point, coordinates, r, rank) < 0) rank = r;
  return rank;
}

void TetSearch::addSegment(const TriangleInTet& triangle, const SegmentEnd (&ends)[2], Index surface,
                           Index polygon, FoundSegments& out) const {
  const Triangle& corners = tets_.surface->triangles[at(surface)];
  const SheetPolygon& p = exact_.sheets.polygons[at(polygon)];
  for (const bool isTo : {false, true}) {
    const SegmentEnd& end = ends[isTo];
    FoundEnd found;
    found.end = end;
    found.segment = 2 * static_cast<Index>(out.segments.size()) + isTo;
    if (end.side >= 0) {
      const auto c = static_cast<std::size_t>(end.side), d = (c + 1) % 3;
      const Index from = corners[c], to = corners[d];
      found.a = std::min(from, to), found.b = std::max(from, to), found.through = polygon;
      found.fromFront = triangle.signAtCorner(from < to ? c : d) < 0;
      out.surfaceEnds.push_back(found);
    } else {
      // Along the polygon's border the surface's inside begins at the segment's start, and ends at its end.
      found.a = p.first + end.slot, found.b = -1, found.through = surface;
      found.fromFront = exact_.sheets.forward(p, end.slot) != isTo;
      out.sheetEnds.push_back(found);
    }
  }
  out.segments.push_back({surface, polygon, -1, -1});
}

}  // namespace sherd
