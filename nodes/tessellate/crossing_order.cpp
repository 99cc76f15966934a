#include "tessellate/crossing_order.h"

#include <fmt/format.h>

#include <optional>

#include "geometry/surface_tree.h"

namespace sherd {

Error inconsistentCut(const char* what) {
  return failure(fmt::format("the cut surface does not close: {}", what),
                 "the surface may touch or cut itself; check it with LoadMesh");
}

Result<void> classifySheets(const TetMesh& tets, const Sheets& sheets, Arrangement& arrangement) {
  const std::size_t n = sheets.vertices.size();
  DisjointSets sets(n);
  std::vector<Index> side(n, -1);
  if (!spreadOverEdges(
          sheets.edges.size(), [&](std::size_t e) { return sheets.edges[e]; }, arrangement.sheetCrossings,
          sidesAcross, side, sets))
    return inconsistentCut("a part of a sheet lies both inside and outside of the surface");
  std::vector<Index> ofRoot(n, -1);
  for (std::size_t v = 0; v < n; ++v)
    if (side[v] < 0 && sheets.onCage[v]) ofRoot[sets.find(v)] = 1;
  // Sheets that the surface does not cross at all and that do not reach the cage's boundary: rare.
  std::optional<SurfaceTree> tree;
  arrangement.sheetInside.assign(n, 0);
  for (std::size_t v = 0; v < n; ++v) {
    if (side[v] < 0) {
      Index& known = ofRoot[sets.find(v)];
      if (known < 0) {
        if (!tree) tree.emplace(tets.surface->positions, tets.surface->triangles);
        known = tree->contains(sheets.vertices[v]) ? 0 : 1;
      }
      side[v] = known;
    }
    arrangement.sheetInside[v] = side[v] == 0;
  }
  return {};
}

void groupByPolygon(std::size_t polygons, Arrangement& a) {
  a.byPolygonBegin.assign(polygons + 1, 0);
  for (const Segment& s : a.segments) ++a.byPolygonBegin[at(s.polygon) + 1];
  std::partial_sum(a.byPolygonBegin.begin(), a.byPolygonBegin.end(), a.byPolygonBegin.begin());
  std::vector<Index> fill(a.byPolygonBegin.begin(), a.byPolygonBegin.end() - 1);
  a.byPolygon.resize(a.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i)
    a.byPolygon[at(fill[at(a.segments[i].polygon)]++)] = static_cast<Index>(i);
}

void groupBySurface(Arrangement& a) {
  a.segmentBegin.assign(1, 0);
  std::size_t i = 0;
  for (const Index s : a.cutTriangles) {
    while (i < a.segments.size() && a.segments[i].surface == s) ++i;
    a.segmentBegin.push_back(static_cast<Index>(i));
  }
}

}  // namespace sherd
