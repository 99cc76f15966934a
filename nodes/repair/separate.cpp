#include "repair/separate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "geometry/box_tree.h"
#include "geometry/disjoint_sets.h"
#include "geometry/edge_table.h"
#include "geometry/exact_points.h"
#include "geometry/self_intersections.h"
#include "repair/stitch.h"

namespace sherd {
namespace {

/// One triangle at an edge of several.
struct Wing {
  Index triangle;
  bool forward;
  Index apex;  ///< the corner that is not on the edge
};

class Fans {
 public:
  explicit Fans(const Patchwork& surface)
      : surface_(surface),
        edges_(buildEdgeTable(surface.triangles, surface.positions.size())),
        corners_(3 * surface.triangles.size()) {}

  /// False where it can't be told which triangles belong together.
  bool join() {
    for (std::size_t e = 0; e < edges_.ends.size(); ++e) {
      const auto users = edges_.trianglesOf(static_cast<Index>(e));
      if (users.size() == 2) {
        joinAt(static_cast<Index>(e), users[0], users[1]);
        continue;
      }
      std::vector<Wing> wings = wingsAt(static_cast<Index>(e));
      for (std::size_t k = 0; k < wings.size(); ++k) {
        // Solid lies counter-clockwise of a triangle that runs backward, up to one that runs forward.
        const Wing &wing = wings[k], &next = wings[(k + 1) % wings.size()];
        if (wing.forward == next.forward) return false;
        if (!wing.forward) joinAt(static_cast<Index>(e), wing.triangle, next.triangle);
      }
    }
    return true;
  }

  /// Edges of several wedges of solid that hang together at both ends, so that new vertices there would not
  /// part them.
  std::vector<Index> pinched() {
    std::vector<Index> list;
    for (std::size_t e = 0; e < edges_.ends.size(); ++e) {
      const auto users = edges_.trianglesOf(static_cast<Index>(e));
      if (users.size() <= 2) continue;
      std::array<std::set<std::size_t>, 2> fans;
      for (std::size_t k = 0; k < 2; ++k)
        for (const Index t : users) fans[k].insert(corners_.find(cornerAt(t, edges_.ends[e][k])));
      if (2 * fans[0].size() < users.size() && 2 * fans[1].size() < users.size())
        list.push_back(static_cast<Index>(e));
    }
    return list;
  }
  const std::array<Index, 2>& ends(Index edge) const { return edges_.ends[at(edge)]; }

  /// Per vertex, its fans as lists of corners (3 t + c); those with several only.
  std::map<Index, std::vector<std::vector<std::size_t>>> several() {
    std::map<std::pair<Index, std::size_t>, std::vector<std::size_t>> fans;
    for (std::size_t k = 0; k < 3 * surface_.triangles.size(); ++k)
      fans[{surface_.triangles[k / 3][k % 3], corners_.find(k)}].push_back(k);
    std::map<Index, std::vector<std::vector<std::size_t>>> byVertex;
    for (auto& [key, list] : fans) byVertex[key.first].push_back(std::move(list));
    std::erase_if(byVertex, [](const auto& entry) { return entry.second.size() < 2; });
    for (auto& [vertex, list] : byVertex)
      std::stable_sort(list.begin(), list.end(),
                       [](const auto& a, const auto& b) { return a.size() > b.size(); });
    return byVertex;
  }

 private:
  std::size_t cornerAt(Index t, Index v) const {
    const Triangle& corners = surface_.triangles[at(t)];
    return 3 * at(t) +
           static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
  }
  void joinAt(Index edge, Index s, Index t) {
    for (const Index v : edges_.ends[at(edge)]) corners_.join(cornerAt(s, v), cornerAt(t, v));
  }
  /// Counter-clockwise about the edge; exact.
  std::vector<Wing> wingsAt(Index edge) const {
    const auto [a, b] = edges_.ends[at(edge)];
    const ExactPoints points(surface_.positions);
    std::vector<Wing> wings;
    for (const Index t : edges_.trianglesOf(edge)) {
      const auto& slots = edges_.ofTriangle[at(t)];
      const auto slot = static_cast<std::size_t>(std::find(slots.begin(), slots.end(), edge) - slots.begin());
      wings.push_back({t, edges_.forward(surface_.triangles, t, static_cast<int>(slot)),
                       surface_.triangles[at(t)][(slot + 2) % 3]});
    }
    const Index first = wings[0].apex;
    const auto isFirstHalf = [&, a = a, b = b](Index p) {
      return p == first || points.orientation(a, b, first, p) > 0;
    };
    std::stable_sort(wings.begin(), wings.end(), [&, a = a, b = b](const Wing& s, const Wing& t) {
      if (s.apex == t.apex || t.apex == first) return false;
      if (s.apex == first) return true;
      if (isFirstHalf(s.apex) != isFirstHalf(t.apex)) return isFirstHalf(s.apex);
      return points.orientation(a, b, s.apex, t.apex) > 0;
    });
    return wings;
  }

  const Patchwork& surface_;
  EdgeTable edges_;
  DisjointSets corners_;
};

/// Moves fans off the vertex that they share with others, one after the other.
class Mover {
 public:
  Mover(Patchwork& surface, double distance) : surface_(surface), distance_(distance) {
    boxes_.resize(surface.triangles.size());
    for (std::size_t t = 0; t < boxes_.size(); ++t)
      for (const Index v : surface.triangles[t]) {
        boxes_[t].add(surface.positions[at(v)] - Vec3::Constant(distance));
        boxes_[t].add(surface.positions[at(v)] + Vec3::Constant(distance));
      }
    tree_.emplace(boxes_);
  }

  /// Gives the fan a vertex of its own where it meets nothing; how far from the old one, or none.
  std::optional<double> move(Index vertex, const std::vector<std::size_t>& fan) {
    const Vec3 from = surface_.positions[at(vertex)];
    const auto twin = static_cast<Index>(surface_.positions.size());
    surface_.positions.push_back(from);
    for (const std::size_t corner : fan) surface_.triangles[corner / 3][corner % 3] = twin;
    const double reach = std::min(distance_, 0.01 * shortestEdge(from, fan));
    for (const double scale : {1.0, 1.0 / 16})
      for (const Vec3& direction : directions(from, fan)) {
        surface_.positions.back() = from + scale * reach * direction;
        if (isClear(fan)) return scale * reach;
      }
    for (const std::size_t corner : fan) surface_.triangles[corner / 3][corner % 3] = vertex;
    surface_.positions.pop_back();
    return std::nullopt;
  }

 private:
  double shortestEdge(const Vec3& from, const std::vector<std::size_t>& fan) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const std::size_t corner : fan)
      for (const std::size_t c : {(corner + 1) % 3, (corner + 2) % 3})
        shortest = std::min(shortest, (cornerPosition(corner / 3, c) - from).norm());
    return shortest;
  }
  const Vec3& cornerPosition(std::size_t t, std::size_t c) const {
    return surface_.positions[at(surface_.triangles[t][c])];
  }

  /// Into the solid and towards the fan's rim first, then all around.
  std::vector<Vec3> directions(const Vec3& from, const std::vector<std::size_t>& fan) const {
    Vec3 normals = Vec3::Zero(), rim = Vec3::Zero();
    for (const std::size_t corner : fan) {
      const std::size_t t = corner / 3, c = corner % 3;
      const Vec3 first = (cornerPosition(t, (c + 1) % 3) - from).normalized();
      const Vec3 second = (cornerPosition(t, (c + 2) % 3) - from).normalized();
      const Vec3 normal = first.cross(second);
      if (const double sine = normal.norm(); sine > 0)
        normals += std::atan2(sine, first.dot(second)) / sine * normal;
      rim += first + second;
    }
    std::vector<Vec3> list;
    const auto add = [&](const Vec3& direction) {
      if (const double length = direction.norm(); length > 1e-6) list.push_back(direction / length);
    };
    add(-normals);
    add(rim);
    add(rim.normalized() - normals.normalized());
    add(normals);
    for (int k = 0; k < 27; ++k) add(Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    return list;
  }

  bool isClear(const std::vector<std::size_t>& fan) const {
    bool clear = true;
    for (const std::size_t corner : fan) {
      const auto own = static_cast<Index>(corner / 3);
      const Triangle& triangle = surface_.triangles[at(own)];
      if (zeroAreaTriangles(surface_.positions, std::span(&triangle, 1)).size() == 1) return false;
      tree_->visitOverlaps(boxes_[at(own)], [&](Index t) {
        clear =
            clear && (t == own || !trianglesMeet(surface_.positions, triangle, surface_.triangles[at(t)]));
      });
      if (!clear) return false;
    }
    return true;
  }

  Patchwork& surface_;
  double distance_;
  std::vector<Box> boxes_;  ///< with room for moving
  std::optional<BoxTree> tree_;
};

/// A vertex in the middle of each pinched edge lets the wedges part there. False where they can't be told.
bool splitPinched(Patchwork& surface) {
  Fans fans(surface);
  if (!fans.join()) return false;
  std::vector<std::array<Index, 3>> splits;
  for (const Index edge : fans.pinched()) {
    const auto [a, b] = fans.ends(edge);
    splits.push_back({a, b, static_cast<Index>(surface.positions.size())});
    surface.positions.push_back(0.5 * surface.positions[at(a)] + 0.5 * surface.positions[at(b)]);
  }
  splitEdges(surface, splits);
  return true;
}

}  // namespace

std::optional<Separated> separate(Patchwork& surface, double distance, const Exec& exec) {
  if (!splitPinched(surface)) return std::nullopt;
  Fans fans(surface);
  if (!fans.join()) return std::nullopt;
  auto left = fans.several();
  Separated done;
  if (left.empty()) return done;
  done.place = surface.positions[at(left.begin()->first)];
  Mover mover(surface, distance);
  for (int pass = 0; pass < 3 && !left.empty(); ++pass) {
    for (auto& [vertex, list] : left) {
      if (exec.cancelled()) return std::nullopt;
      // All but one, the largest if that can be.
      for (std::size_t k = list.size(); k-- > 0 && list.size() > 1;)
        if (const auto moved = mover.move(vertex, list[k])) {
          done.moved = std::max(done.moved, *moved);
          ++done.vertices;
          list.erase(list.begin() + static_cast<std::ptrdiff_t>(k));
        }
    }
    std::erase_if(left, [](const auto& entry) { return entry.second.size() < 2; });
  }
  if (!left.empty()) return std::nullopt;
  return done;
}

}  // namespace sherd
