#include "repair/clean.h"

#include <algorithm>
#include <map>

#include "geometry/edge_table.h"
#include "geometry/self_intersections.h"
#include "repair/stitch.h"

namespace sherd {
namespace {

Vec3 middleOf(const Patchwork& surface, std::size_t t) {
  Vec3 middle = Vec3::Zero();
  for (const Index v : surface.triangles[t]) middle += surface.positions[at(v)] / 3;
  return middle;
}

/// Triangles of the same three corners, as ascending lists of two or more, in the order of the first ones.
std::vector<std::vector<std::size_t>> repeated(const Patchwork& surface) {
  std::vector<std::pair<Triangle, std::size_t>> sorted(surface.triangles.size());
  for (std::size_t t = 0; t < sorted.size(); ++t) {
    sorted[t] = {surface.triangles[t], t};
    std::sort(sorted[t].first.begin(), sorted[t].first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && sorted[end].first == sorted[begin].first) ++end;
    if (end - begin < 2) continue;
    groups.emplace_back();
    for (std::size_t k = begin; k < end; ++k) groups.back().push_back(sorted[k].second);
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

}  // namespace

Defect dropDuplicates(Patchwork& surface) {
  Defect dropped;
  const std::vector<std::vector<std::size_t>> groups = repeated(surface);
  if (groups.empty()) return dropped;
  const EdgeTable edges = buildEdgeTable(surface.triangles, surface.positions.size());
  std::vector<std::size_t> uses(edges.ends.size());  // of an edge, by different triangles
  for (std::size_t e = 0; e < uses.size(); ++e) uses[e] = edges.trianglesOf(static_cast<Index>(e)).size();
  for (const auto& group : groups)
    for (const Index edge : edges.ofTriangle[group[0]]) uses[at(edge)] -= group.size() - 1;
  std::vector<bool> keep(surface.triangles.size(), true);
  for (const auto& group : groups) {
    const auto& own = edges.ofTriangle[group[0]];
    const bool closedWithout =
        std::all_of(own.begin(), own.end(), [&](Index e) { return uses[at(e)] % 2 == 1 && uses[at(e)] > 1; });
    for (const Index edge : own) uses[at(edge)] -= closedWithout ? 1 : 0;
    for (std::size_t k = closedWithout ? 0 : 1; k < group.size(); ++k) {
      if (dropped.count++ == 0) dropped.place = middleOf(surface, group[k]);
      keep[group[k]] = false;
    }
  }
  keepOnly(surface, keep);
  return dropped;
}

void cancelOpposite(Patchwork& surface) {
  std::vector<bool> keep(surface.triangles.size(), true);
  for (const auto& group : repeated(surface)) {
    const Triangle& first = surface.triangles[group[0]];
    std::array<std::vector<std::size_t>, 2> ways;  // as the first runs, and the other way
    for (const std::size_t t : group) {
      const Triangle& v = surface.triangles[t];
      const auto k = static_cast<std::size_t>(std::find(v.begin(), v.end(), first[0]) - v.begin());
      ways[v[(k + 1) % 3] == first[1] ? 0 : 1].push_back(t);
    }
    const std::size_t pairs = std::min(ways[0].size(), ways[1].size());
    for (const auto& way : ways)
      for (std::size_t k = 0; k < pairs; ++k) keep[way[way.size() - 1 - k]] = false;
  }
  keepOnly(surface, keep);
}

void coarsen(Patchwork& surface, std::span<const std::array<Index, 2>> pairs, double spacing) {
  for (const auto& pair : pairs)
    for (const Index t : pair)
      for (const Index v : surface.triangles[at(t)])
        surface.positions[at(v)] = (surface.positions[at(v)] / spacing).array().round().matrix() * spacing;
  joinEqual(surface);
}

Defect dropFlat(Patchwork& surface, const Exec& exec) {
  Defect dropped;
  while (!exec.cancelled()) {
    const std::vector<Index> flat = zeroAreaTriangles(surface.positions, surface.triangles);
    if (flat.empty()) break;
    std::vector<bool> keep(surface.triangles.size(), true);
    std::vector<std::array<Index, 3>> splits;  // the ends of the longest side, and the corner between them
    std::map<std::array<Index, 2>, Index> chosen;
    for (const Index t : flat) {
      const Triangle& v = surface.triangles[at(t)];
      std::size_t apex = 0;
      double longest = -1;
      for (std::size_t c = 0; c < 3; ++c) {
        const double length =
            (surface.positions[at(v[(c + 1) % 3])] - surface.positions[at(v[(c + 2) % 3])]).squaredNorm();
        if (length > longest) longest = length, apex = c;
      }
      std::array<Index, 2> side{v[(apex + 1) % 3], v[(apex + 2) % 3]};
      if (side[0] > side[1]) std::swap(side[0], side[1]);
      // The other flat ones at that side are split with the rest, into shorter ones for the next round.
      if (!chosen.try_emplace(side, v[apex]).second) continue;
      splits.push_back({side[0], side[1], v[apex]});
      if (dropped.count++ == 0) dropped.place = middleOf(surface, at(t));
      keep[at(t)] = false;
    }
    keepOnly(surface, keep);
    splitEdges(surface, splits);
  }
  return dropped;
}

}  // namespace sherd
