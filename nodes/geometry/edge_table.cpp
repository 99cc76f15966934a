#include "geometry/edge_table.h"

#include <algorithm>

namespace sherd {

EdgeTable buildEdgeTable(std::span<const Triangle> triangles, std::size_t vertexCount) {
  struct Side {
    Index high, triangle;
    int slot;
  };
  // Buckets by the lower end (counting sort), then a short sort within each bucket.
  std::vector<Index> begin(vertexCount + 1, 0);
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) ++begin[at(std::min(t[c], t[(c + 1) % 3])) + 1];
  for (std::size_t v = 0; v < vertexCount; ++v) begin[v + 1] += begin[v];
  std::vector<Side> sides(3 * triangles.size());
  std::vector<Index> fill(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const Index a = triangles[t][static_cast<std::size_t>(c)],
                  b = triangles[t][static_cast<std::size_t>((c + 1) % 3)];
      sides[at(fill[at(std::min(a, b))]++)] = {std::max(a, b), static_cast<Index>(t), c};
    }
  EdgeTable table;
  table.ofTriangle.resize(triangles.size());
  table.use.reserve(sides.size());
  for (std::size_t v = 0; v < vertexCount; ++v) {
    const auto first = sides.begin() + begin[v], last = sides.begin() + begin[v + 1];
    std::sort(first, last, [](const Side& a, const Side& b) {
      return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
    });
    for (auto s = first; s != last; ++s) {
      if (s == first || s->high != (s - 1)->high) {
        table.ends.push_back({static_cast<Index>(v), s->high});
        table.useBegin.push_back(static_cast<Index>(table.use.size()));
      }
      table.ofTriangle[at(s->triangle)][static_cast<std::size_t>(s->slot)] =
          static_cast<Index>(table.ends.size()) - 1;
      table.use.push_back(s->triangle);
    }
  }
  table.useBegin.push_back(static_cast<Index>(table.use.size()));
  return table;
}

}  // namespace sherd
