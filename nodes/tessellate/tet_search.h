// The sheets of one tetrahedron against the surface triangles that it holds.
#pragma once

#include <optional>
#include <vector>

#include "tessellate/arrangement.h"
#include "tessellate/triangle_in_tet.h"

namespace sherd {

/// An end of a segment as found, named by what crosses what.
struct FoundEnd {
  Index a, b;     ///< of the surface edge, ascending; or the corner where the sheet edge begins, and −1
  Index through;  ///< the polygon; or the surface triangle
  Index segment;  ///< 2 · segment + (0: from, 1: to)
  bool fromFront;
  SegmentEnd end;  ///< of that segment

  bool names(const FoundEnd& o) const { return a == o.a && b == o.b && through == o.through; }
  friend bool operator<(const FoundEnd& x, const FoundEnd& y) {
    return std::tie(x.a, x.b, x.through, x.segment) < std::tie(y.a, y.b, y.through, y.segment);
  }
};

struct FoundSegments {
  std::vector<Segment> segments;
  std::vector<FoundEnd> surfaceEnds, sheetEnds;  ///< segment counts from the first of these
};

/// Keeps its memory from tetrahedron to tetrahedron; one per thread.
class TetSearch {
 public:
  /// `labels`: per surface vertex its cell, −1 where not known yet. Of those, only the vertices that lie in a
  /// searched tetrahedron are read and written. `rounding`: m, a bound of how far the sheets' vertices are
  /// from where they are thought to be.
  TetSearch(const TetMesh& tets, const ExactSheets& exact, const SiteValues& values,
            std::vector<Index>& labels, double rounding)
      : tets_(tets), exact_(exact), values_(values), labels_(labels), rounding_(rounding) {}

  /// Polygons first … last − 1 are those of one tetrahedron. Adds the segments in which they meet the
  /// surface, and names the cells of the vertices in the tetrahedron. Cost O(held triangles · polygons),
  /// mostly a few comparisons each.
  void search(Index first, Index last, FoundSegments& out);

 private:
  void prepare(Index first, Index last);
  Index labelOf(Index vertex);
  Index leastAt(const Vec3& point) const;
  bool isInOneCell(const Triangle& corners, Index tet);
  void addSegment(const TriangleInTet& triangle, const SegmentEnd (&ends)[2], Index surface, Index polygon,
                  FoundSegments& out) const;

  const TetMesh& tets_;
  const ExactSheets& exact_;
  const SiteValues& values_;
  std::vector<Index>& labels_;
  double rounding_;
  std::optional<TetFrame> frame_;
  std::vector<Index> ranks_;         ///< that share the tetrahedron, ascending
  std::vector<SheetPlane> planes_;   ///< per polygon
  std::vector<Box> boxes_;           ///< per polygon: it lies within
  std::vector<SheetPlane> toFirst_;  ///< per rank but the first: its value less the first's
};

}  // namespace sherd
