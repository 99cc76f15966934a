#include "repair/hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "base/rng.h"
#include "geometry/box_tree.h"
#include "geometry/disjoint_sets.h"
#include "geometry/edge_table.h"
#include "geometry/self_intersections.h"
#include "repair/arrangement.h"

namespace sherd {
namespace {

using Number = Exact::FT;
using Point2 = Exact::Point_2;

/// Faces in the same place, as one.
struct Layer {
  Triangle corners;                             ///< as the first of them runs
  int net = 0;                                  ///< how many more run so than the other way
  std::vector<std::pair<Index, bool>> sources;  ///< and whether they run so; ascending
};

std::vector<Layer> layersOf(const CutSurface& arrangement) {
  const std::size_t n = arrangement.faces.size();
  std::vector<std::pair<Triangle, std::size_t>> sorted(n);
  for (std::size_t f = 0; f < n; ++f) {
    sorted[f] = {arrangement.faces[f].corners, f};
    std::sort(sorted[f].first.begin(), sorted[f].first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Layer> layers;
  for (std::size_t k = 0; k < n; ++k) {
    const CutSurface::Face& face = arrangement.faces[sorted[k].second];
    if (k == 0 || sorted[k].first != sorted[k - 1].first) layers.push_back({face.corners, 0, {}});
    Layer& layer = layers.back();
    // The same way round where it runs through the first two corners in the same order.
    const auto i = static_cast<std::size_t>(
        std::find(face.corners.begin(), face.corners.end(), layer.corners[0]) - face.corners.begin());
    const bool same = face.corners[(i + 1) % 3] == layer.corners[1];
    layer.net += same ? 1 : -1;
    layer.sources.emplace_back(face.source, same);
  }
  // In the order of the surface, not of vertex numbers.
  for (Layer& layer : layers) std::sort(layer.sources.begin(), layer.sources.end());
  std::stable_sort(layers.begin(), layers.end(),
                   [](const Layer& a, const Layer& b) { return a.sources[0].first < b.sources[0].first; });
  return layers;
}

/// Counts how often the surface winds around points beside faces.
class Winding {
 public:
  Winding(const Patchwork& surface, const CutSurface& arrangement)
      : surface_(surface), points_(arrangement.points), boxes_(surface.triangles.size()) {
    for (std::size_t t = 0; t < boxes_.size(); ++t)
      for (const Index v : surface.triangles[t]) boxes_[t].add(surface.positions[at(v)]);
    tree_.emplace(boxes_);
  }

  /// Just in front of the face, where its corners turn counter-clockwise.
  int before(const Triangle& face, std::uint64_t seed) const {
    Vec3 corner[3];
    for (int c = 0; c < 3; ++c) corner[c] = rounded(points_[at(face[static_cast<std::size_t>(c)])]);
    int axis = 0;
    (corner[1] - corner[0]).cross(corner[2] - corner[0]).cwiseAbs().maxCoeff(&axis);
    for (int attempt = 0; attempt < 3; ++attempt, axis = (axis + 1) % 3) {
      const int way = static_cast<int>(turn(face, axis));
      if (way == 0) continue;
      Rng rng(seed, static_cast<std::uint64_t>(attempt));
      for (int probe = 0; probe < 20; ++probe)
        if (const auto winding = along(face, axis, way, rng)) return *winding;
    }
    throw std::runtime_error("no line through a face misses all edges");
  }

 private:
  static Vec3 rounded(const Exact::Point_3& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
  }
  Point2 flat(Index v, int axis) const {
    const Exact::Point_3& p = points_[at(v)];
    return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
  }
  CGAL::Orientation turn(const Triangle& t, int axis) const {
    return CGAL::orientation(flat(t[0], axis), flat(t[1], axis), flat(t[2], axis));
  }
  /// Where the line through `place` along the axis crosses the triangle's plane.
  Number height(const Triangle& t, int axis, const Point2& place) const {
    const Exact::Point_3 &a = points_[at(t[0])], &b = points_[at(t[1])], &c = points_[at(t[2])];
    const Exact::Vector_3 n = CGAL::cross_product(b - a, c - a);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return a[axis] - (n[u] * (place.x() - a[u]) + n[v] * (place.y() - a[v])) / n[axis];
  }

  /// Along the axis, in the direction that the face looks to (`way`: +1 or −1), from a random point of it.
  /// None where the line meets an edge.
  std::optional<int> along(const Triangle& face, int axis, int way, Rng& rng) const {
    const double wa = 0.1 + rng.uniform(), wb = 0.1 + rng.uniform(), wc = 0.1 + rng.uniform();
    const Number sum = Number(wa) + Number(wb) + Number(wc);
    const Point2 a = flat(face[0], axis), b = flat(face[1], axis), c = flat(face[2], axis);
    const Point2 place((wa * a.x() + wb * b.x() + wc * c.x()) / sum,
                       (wa * a.y() + wb * b.y() + wc * c.y()) / sum);
    const Number start = height(face, axis, place);
    Box column;
    const auto set = [&](int k, const Number& value) {
      const auto [low, high] = CGAL::to_interval(value);
      column.low[k] = low;
      column.high[k] = high;
    };
    set((axis + 1) % 3, place.x());
    set((axis + 2) % 3, place.y());
    set(axis, start);
    (way > 0 ? column.high[axis] : column.low[axis]) = way * std::numeric_limits<double>::infinity();
    int winding = 0;
    bool isClean = true;
    tree_->visitOverlaps(column, [&](Index t) {
      if (!isClean) return;
      const Triangle& other = surface_.triangles[at(t)];
      const auto side = turn(other, axis);
      Point2 p[3];
      for (int k = 0; k < 3; ++k) p[k] = flat(other[static_cast<std::size_t>(k)], axis);
      int with = 0, against = 0;
      for (int k = 0; k < 3; ++k) {
        const auto s = CGAL::orientation(p[k], p[(k + 1) % 3], place);
        if (s == CGAL::COLLINEAR) ++with, ++against;
        if (s == CGAL::LEFT_TURN) ++with;
        if (s == CGAL::RIGHT_TURN) ++against;
      }
      if (with < 3 && against < 3) return;
      if (with + against > 3) {  // on an edge, or seen from its side
        isClean = false;
        return;
      }
      const auto above = CGAL::compare(height(other, axis, place), start);
      if (static_cast<int>(above) == way) winding += side == CGAL::LEFT_TURN ? way : -way;
    });
    if (!isClean) return std::nullopt;
    return winding;
  }

  const Patchwork& surface_;
  const std::vector<Exact::Point_3>& points_;
  std::vector<Box> boxes_;
  std::optional<BoxTree> tree_;
};

/// To the last bit or so: what an interval knows of a point that barely exists is too little.
Vec3 roundedPoint(const Exact::Point_3& p) {
  const auto& exact = p.exact();
  return {CGAL::to_double(exact.x()), CGAL::to_double(exact.y()), CGAL::to_double(exact.z())};
}

/// Where in its source's base a corner of a face is.
Vec3 weightsOf(const Patchwork& surface, Index source, Index corner, const std::vector<Vec3>& points) {
  const Triangle& t = surface.triangles[at(source)];
  const Facet& facet = surface.facets[at(source)];
  for (std::size_t c = 0; c < 3; ++c)
    if (t[c] == corner) return facet.corners[c];
  const Vec3 &a = points[at(t[0])], &b = points[at(t[1])], &c = points[at(t[2])], &p = points[at(corner)];
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  Vec3 weights = Vec3::Constant(1.0 / 3);
  if (area2 > 0) {
    const double wb = (p - a).cross(c - a).dot(normal) / area2, wc = (b - a).cross(p - a).dot(normal) / area2;
    weights = Vec3(1 - wb - wc, wb, wc).cwiseMax(0.0);
    weights /= weights.sum();
  }
  return weights[0] * facet.corners[0] + weights[1] * facet.corners[1] + weights[2] * facet.corners[2];
}

double areaOf(const Triangle& t, const std::vector<Vec3>& points) {
  return 0.5 * (points[at(t[1])] - points[at(t[0])]).cross(points[at(t[2])] - points[at(t[0])]).norm();
}

/// Layers that hang together across edges of just two: the same space lies before all of them.
std::vector<std::size_t> patchesOf(const std::vector<Layer>& layers, std::size_t pointCount) {
  std::vector<Triangle> triangles;
  for (const Layer& layer : layers) triangles.push_back(layer.corners);
  const EdgeTable edges = buildEdgeTable(triangles, pointCount);
  DisjointSets sets(layers.size());
  for (std::size_t e = 0; e < edges.ends.size(); ++e) {
    const auto users = edges.trianglesOf(static_cast<Index>(e));
    if (users.size() != 2) continue;
    const auto forward = [&](Index t) {
      const auto& slots = edges.ofTriangle[at(t)];
      return edges.forward(
          triangles, t,
          static_cast<int>(std::find(slots.begin(), slots.end(), static_cast<Index>(e)) - slots.begin()));
    };
    if (forward(users[0]) != forward(users[1])) sets.join(at(users[0]), at(users[1]));
  }
  std::vector<std::size_t> root(layers.size());
  for (std::size_t l = 0; l < root.size(); ++l) root[l] = sets.find(l);
  return root;
}

class Builder {
 public:
  Builder(const Patchwork& surface, const CutSurface& arrangement, bool bothWays, const Exec& exec)
      : surface_(surface), arrangement_(arrangement), bothWays_(bothWays), exec_(exec) {
    points_ = surface.positions;
    points_.reserve(arrangement.points.size());
    for (std::size_t k = points_.size(); k < arrangement.points.size() && !exec.cancelled(); ++k)
      points_.push_back(roundedPoint(arrangement.points[k]));
    points_.resize(arrangement.points.size());
  }

  Hull build() {
    Hull hull;
    if (exec_.cancelled()) return hull;
    const std::vector<Layer> layers = layersOf(arrangement_);
    if (exec_.cancelled()) return hull;
    const std::vector<std::size_t> patch = patchesOf(layers, points_.size());
    const std::map<std::size_t, int> before = windings(layers, patch);
    if (exec_.cancelled()) return hull;
    hull.surface.positions = points_;
    for (std::size_t l = 0; l < layers.size() && !exec_.cancelled(); ++l)
      place(layers[l], before.at(patch[l]), hull);
    std::sort(hull.lost.begin(), hull.lost.end());
    hull.lost.erase(std::unique(hull.lost.begin(), hull.lost.end()), hull.lost.end());
    joinEqual(hull.surface);
    return hull;
  }

 private:
  std::map<std::size_t, int> windings(const std::vector<Layer>& layers,
                                      const std::vector<std::size_t>& patch) const {
    const Winding winding(surface_, arrangement_);
    std::map<std::size_t, std::pair<double, std::size_t>> largest;  // of each patch: no thin one, for speed
    for (std::size_t l = 0; l < layers.size(); ++l) {
      const double area = areaOf(layers[l].corners, points_);
      auto [it, isNew] = largest.try_emplace(patch[l], area, l);
      if (!isNew && area > it->second.first) it->second = {area, l};
    }
    std::map<std::size_t, int> before;
    for (const auto& [root, face] : largest) {
      if (exec_.cancelled()) break;
      // Patches run coherently, so one face speaks for all.
      before[root] = winding.before(layers[face.second].corners, root);
    }
    return before;
  }

  void place(const Layer& layer, int before, Hull& hull) const {
    const int behind = before + layer.net;
    const auto isSolid = [&](int winding) { return bothWays_ ? winding != 0 : winding > 0; };
    const bool ahead = isSolid(before), back = isSolid(behind);
    if (ahead == back) {
      if (before == 0 && behind == 0)
        for (const auto& [source, same] : layer.sources)
          if (!surface_.facets[at(source)].isNew) hull.lost.push_back(source);
      if (!ahead && before != behind) {
        Vec3 middle = Vec3::Zero();
        for (const Index v : layer.corners) {
          hull.backward.push_back(points_[at(v)]);
          middle += points_[at(v)] / 3;
        }
        hull.backward.push_back(middle);
      }
      return;
    }
    // Of the sources the first that faces the right way, and lies on the given surface rather than in a hole.
    const auto better = [&](const std::pair<Index, bool>& a, const std::pair<Index, bool>& b) {
      const auto rank = [&](const std::pair<Index, bool>& s) {
        return std::pair(surface_.facets[at(s.first)].isNew, s.second != back);
      };
      return rank(a) < rank(b);
    };
    const auto [source, same] = *std::min_element(layer.sources.begin(), layer.sources.end(), better);
    const Facet& of = surface_.facets[at(source)];
    Triangle corners = layer.corners;
    if (!same) std::swap(corners[1], corners[2]);  // as the source runs
    if (isWhole(source, corners)) corners = surface_.triangles[at(source)];
    Facet facet = of;
    for (std::size_t c = 0; c < 3; ++c) facet.corners[c] = weightsOf(surface_, source, corners[c], points_);
    hull.surface.add(corners, facet);
    if (same != back) turn(hull.surface, hull.surface.triangles.size() - 1);
  }
  /// Is it the source, uncut?
  bool isWhole(Index source, Triangle corners) const {
    Triangle own = surface_.triangles[at(source)];
    std::sort(own.begin(), own.end());
    std::sort(corners.begin(), corners.end());
    return own == corners;
  }

  const Patchwork& surface_;
  const CutSurface& arrangement_;
  bool bothWays_;
  const Exec& exec_;
  std::vector<Vec3> points_;
};

}  // namespace

Result<Hull> outerHull(const Patchwork& surface, bool bothWays, std::size_t pairLimit, const Exec& exec) {
  const IntersectingPairs met = intersectingPairs(surface.positions, surface.triangles, exec, pairLimit);
  if (exec.cancelled()) return cancelledError();
  if (met.more) return failure("too many triangles meet each other for an exact union");
  try {
    const CutSurface arrangement = arrange(surface.positions, surface.triangles, met.pairs, exec);
    if (exec.cancelled()) return cancelledError();
    Hull hull = Builder(surface, arrangement, bothWays, exec).build();
    if (exec.cancelled()) return cancelledError();
    hull.pairs = met.pairs.size();
    return hull;
  } catch (const std::exception& error) {  // CGAL's
    return failure(std::string("the exact union failed: ") + error.what());
  }
}

}  // namespace sherd
