#include "repair/stitch.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/box_tree.h"
#include "geometry/edge_table.h"
#include "geometry/point_triangle.h"

namespace sherd {
namespace {

using Edge = std::array<Index, 2>;

Edge edgeOf(Index a, Index b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// The open edges, and how short the shortest at each of their vertices is.
struct Borders {
  std::vector<Edge> edges;
  std::vector<Index> vertices;   ///< ascending
  std::vector<double> shortest;  ///< per vertex of the surface; 0 where no open edge ends

  explicit Borders(const Patchwork& surface) : shortest(surface.positions.size(), 0) {
    const EdgeTable table = buildEdgeTable(surface.triangles, surface.positions.size());
    for (std::size_t e = 0; e < table.ends.size(); ++e) {
      if (table.trianglesOf(static_cast<Index>(e)).size() != 1) continue;
      edges.push_back(table.ends[e]);
      const double length =
          (surface.positions[at(edges.back()[0])] - surface.positions[at(edges.back()[1])]).norm();
      for (const Index v : edges.back())
        shortest[at(v)] = shortest[at(v)] > 0 ? std::min(shortest[at(v)], length) : length;
    }
    for (std::size_t v = 0; v < shortest.size(); ++v)
      if (shortest[v] > 0) vertices.push_back(static_cast<Index>(v));
  }
};

Box around(const Vec3& p, double reach) {
  Box box;
  box.add(p - Vec3::Constant(reach));
  box.add(p + Vec3::Constant(reach));
  return box;
}

void record(Stitched& done, double distance, const Vec3& place) {
  if (done.joined + done.split == 0) done.place = place;
  done.moved = std::max(done.moved, distance);
}

/// Joins each border vertex with the nearest other one where that is so for both.
std::size_t joinNearest(Patchwork& surface, const Borders& borders, double tolerance, Stitched& done) {
  std::vector<Box> boxes;
  for (const Index v : borders.vertices) boxes.push_back(around(surface.positions[at(v)], 0));
  const BoxTree tree(boxes);
  std::map<Index, Index> nearest;
  for (const Index v : borders.vertices) {
    const double reach = std::min(tolerance, borders.shortest[at(v)] / 4);
    double best = reach;
    tree.visitOverlaps(around(surface.positions[at(v)], reach), [&](Index i) {
      const Index u = borders.vertices[at(i)];
      const double distance = (surface.positions[at(u)] - surface.positions[at(v)]).norm();
      if (u == v || distance > borders.shortest[at(u)] / 4) return;
      const auto known = nearest.find(v);
      if (distance < best || (distance == best && (known == nearest.end() || u < known->second)))
        best = distance, nearest[v] = u;
    });
  }
  std::size_t joined = 0;
  for (const auto& [v, u] : nearest) {
    const auto back = nearest.find(u);
    if (u < v || back == nearest.end() || back->second != v) continue;
    record(done, (surface.positions[at(u)] - surface.positions[at(v)]).norm(), surface.positions[at(v)]);
    surface.positions[at(u)] = surface.positions[at(v)];
    ++done.joined, ++joined;
  }
  if (joined > 0) joinEqual(surface);
  return joined;
}

/// Splits each border edge at the border vertex on it that lies nearest to its middle.
std::size_t splitAtVertices(Patchwork& surface, const Borders& borders, double tolerance, Stitched& done) {
  std::vector<Box> boxes;
  for (const Index v : borders.vertices) boxes.push_back(around(surface.positions[at(v)], 0));
  const BoxTree tree(boxes);
  std::vector<std::array<Index, 3>> splits;
  for (const Edge& edge : borders.edges) {
    const Vec3 &a = surface.positions[at(edge[0])], &b = surface.positions[at(edge[1])];
    const double reach = std::min(tolerance, (b - a).norm() / 4);
    Box box = around(a, reach);
    box.add(b - Vec3::Constant(reach));
    box.add(b + Vec3::Constant(reach));
    Index chosen = -1;
    double best = std::numeric_limits<double>::infinity(), moved = 0;
    tree.visitOverlaps(box, [&](Index i) {
      const Index v = borders.vertices[at(i)];
      if (v == edge[0] || v == edge[1]) return;
      const Vec3& p = surface.positions[at(v)];
      const double off = (closestOnSegment(p, a, b) - p).norm();
      const double ends = std::min((p - a).norm(), (p - b).norm());
      if (off > reach || ends <= std::max(4 * off, 1e-12 * (b - a).norm())) return;
      if (const double middle = (p - a / 2 - b / 2).norm(); middle < best)
        best = middle, chosen = v, moved = off;
    });
    if (chosen < 0) continue;
    record(done, moved, surface.positions[at(chosen)]);
    ++done.split;
    splits.push_back({edge[0], edge[1], chosen});
  }
  splitEdges(surface, splits);
  return splits.size();
}

}  // namespace

void splitEdges(Patchwork& surface, const std::vector<std::array<Index, 3>>& splits) {
  std::map<Edge, Index> vertexOn;
  for (const auto& [a, b, v] : splits) vertexOn.emplace(edgeOf(a, b), v);
  if (vertexOn.empty()) return;
  std::vector<bool> keep(surface.triangles.size(), true);
  // Grows while it is walked: the parts are looked at in their turn.
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Triangle corners = surface.triangles[t];
      const Facet facet = surface.facets[t];
      const Index a = corners[c], b = corners[(c + 1) % 3], d = corners[(c + 2) % 3];
      const auto found = vertexOn.find(edgeOf(a, b));
      if (found == vertexOn.end()) continue;
      keep[t] = false;
      const Index v = found->second;
      if (v == d) break;
      const Vec3 side = surface.positions[at(b)] - surface.positions[at(a)];
      const double share = side.dot(surface.positions[at(v)] - surface.positions[at(a)]) / side.squaredNorm();
      Facet first = facet, second = facet;
      const double part = std::clamp(share, 0.0, 1.0);
      const Vec3 middle = (1 - part) * facet.corners[c] + part * facet.corners[(c + 1) % 3];
      first.corners[(c + 1) % 3] = second.corners[c] = middle;
      Triangle left = corners, right = corners;
      left[(c + 1) % 3] = right[c] = v;
      surface.add(left, first);
      surface.add(right, second);
      keep.resize(surface.triangles.size(), true);
      break;
    }
  keepOnly(surface, keep);
}

Stitched stitch(Patchwork& surface, double tolerance, const Exec& exec) {
  Stitched done;
  for (int round = 0; round < 30 && !exec.cancelled(); ++round) {
    const Borders borders(surface);
    if (borders.edges.empty()) break;
    if (joinNearest(surface, borders, tolerance, done) > 0) continue;
    if (splitAtVertices(surface, borders, tolerance, done) == 0) break;
  }
  return done;
}

}  // namespace sherd
