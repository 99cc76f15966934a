#include "embed/paths.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "geometry/tet_edges.h"

namespace sherd {
namespace {

/// Does the line from a to b pass through triangle (p0, p1, p2)? On its rim counts, to 1e-9 of the lengths at
/// hand: nothing topological hangs on it, but rounding should not choose.
bool crosses(const Vec3& a, const Vec3& b, const Vec3 (&p)[3]) {
  const double size = std::max({(b - a).norm(), (p[1] - p[0]).norm(), (p[2] - p[0]).norm()});
  const double rim = 1e-9 * size * size * size;
  bool left = true, right = true;
  for (int c = 0; c < 3; ++c) {
    const double side = (b - a).dot((p[c] - a).cross(p[(c + 1) % 3] - a));
    left = left && side > -rim;
    right = right && side < rim;
  }
  return left || right;
}

/// Pairs of corners on the two sides of each inner face whose line stays in the two tetrahedra.
std::vector<Edge> linesAcrossFaces(std::span<const Vec3> nodes, std::span<const Tetra> tets,
                                   std::span<const Tetra> neighbours) {
  std::vector<Edge> lines;
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (std::size_t f = 0; f < 4; ++f) {
      const Index other = neighbours[t][f];
      if (other <= static_cast<Index>(t)) continue;  // once per face
      Vec3 face[3];
      for (std::size_t c = 0; c < 3; ++c) face[c] = nodes[at(tets[t][at(kTetraFace[f][c])])];
      const Tetra& beyond = tets[at(other)];
      for (std::size_t g = 0; g < 4; ++g)
        if (neighbours[at(other)][g] == static_cast<Index>(t) &&
            crosses(nodes[at(tets[t][f])], nodes[at(beyond[g])], face))
          lines.push_back({tets[t][f], beyond[g]});
    }
  return lines;
}

}  // namespace

PathGraph::PathGraph(std::span<const Vec3> nodes, std::span<const Tetra> tets,
                     std::span<const Tetra> neighbours, std::span<const double> stretch)
    : links_(nodes.size()) {
  std::vector<Edge> lines = tetEdges(tets);
  const std::vector<Edge> across = linesAcrossFaces(nodes, tets, neighbours);
  lines.insert(lines.end(), across.begin(), across.end());
  for (const auto& [a, b] : lines) {
    double length = (nodes[at(a)] - nodes[at(b)]).norm();
    if (!stretch.empty()) length *= 0.5 * (stretch[at(a)] + stretch[at(b)]);
    links_[at(a)].push_back({b, length});
    links_[at(b)].push_back({a, length});
    meanLink_ += length / static_cast<double>(lines.size());
  }
}

std::vector<double> PathGraph::lengthsFrom(Index source) const {
  std::vector<double> length(links_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  length[at(source)] = 0;
  queue.emplace(0.0, source);
  while (!queue.empty()) {
    const auto [d, n] = queue.top();
    queue.pop();
    if (d > length[at(n)]) continue;
    for (const Link& link : links_[at(n)]) {
      const double through = d + link.length;
      if (through >= length[at(link.to)]) continue;
      length[at(link.to)] = through;
      queue.emplace(through, link.to);
    }
  }
  return length;
}

}  // namespace sherd
