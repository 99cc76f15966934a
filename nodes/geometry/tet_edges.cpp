#include "geometry/tet_edges.h"

#include <algorithm>

namespace sherd {

std::vector<Edge> tetEdges(std::span<const Tetra> tets) {
  std::vector<Edge> edges;
  edges.reserve(6 * tets.size());
  for (const Tetra& tet : tets)
    for (const auto& corner : kTetraEdge) {
      const auto [low, high] = std::minmax(tet[at(corner[0])], tet[at(corner[1])]);
      edges.push_back({low, high});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

NodeGraph::NodeGraph(std::size_t nodes, std::span<const Edge> edges)
    : begin_(nodes + 1, 0), list_(2 * edges.size()) {
  for (const Edge& e : edges)
    for (const Index n : e) ++begin_[at(n) + 1];
  for (std::size_t n = 0; n < nodes; ++n) begin_[n + 1] += begin_[n];
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (const Edge& e : edges) {
    list_[next[at(e[0])]++] = e[1];
    list_[next[at(e[1])]++] = e[0];
  }
  for (std::size_t n = 0; n < nodes; ++n)
    std::sort(list_.begin() + static_cast<std::ptrdiff_t>(begin_[n]),
              list_.begin() + static_cast<std::ptrdiff_t>(begin_[n + 1]));
}

}  // namespace sherd
