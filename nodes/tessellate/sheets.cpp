#include "tessellate/sheets.h"

#include <algorithm>

namespace sherd {

void Sheets::connect() {
  struct Side {
    Index high, corner;
  };
  // Buckets by the lower end (counting sort), then a short sort within each bucket.
  std::vector<Index> begin(vertices.size() + 1, 0), next(corners.size());
  for (const SheetPolygon& p : polygons)
    for (Index i = 0; i < p.count; ++i) {
      const std::size_t c = at(p.first + i);
      next[c] = corners[at(p.first + (i + 1) % p.count)];
      ++begin[at(std::min(corners[c], next[c])) + 1];
    }
  for (std::size_t v = 0; v < vertices.size(); ++v) begin[v + 1] += begin[v];
  std::vector<Side> sides(corners.size());
  std::vector<Index> fill(begin.begin(), begin.end() - 1);
  for (std::size_t c = 0; c < corners.size(); ++c)
    sides[at(fill[at(std::min(corners[c], next[c]))]++)] = {std::max(corners[c], next[c]),
                                                            static_cast<Index>(c)};
  edges.clear(), byEdgeBegin.clear();
  byEdge.resize(corners.size());
  edgeOf.resize(corners.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto first = sides.begin() + begin[v], last = sides.begin() + begin[v + 1];
    std::sort(first, last, [](const Side& a, const Side& b) {
      return a.high != b.high ? a.high < b.high : a.corner < b.corner;
    });
    for (auto s = first; s != last; ++s) {
      const Index place = static_cast<Index>(s - sides.begin());
      if (s == first || s->high != (s - 1)->high) {
        edges.push_back({static_cast<Index>(v), s->high});
        byEdgeBegin.push_back(place);
      }
      edgeOf[at(s->corner)] = static_cast<Index>(edges.size()) - 1;
      byEdge[at(place)] = s->corner;
    }
  }
  byEdgeBegin.push_back(static_cast<Index>(corners.size()));
}

}  // namespace sherd
