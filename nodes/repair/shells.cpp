#include "repair/shells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "geometry/disjoint_sets.h"
#include "geometry/edge_table.h"
#include "geometry/solid.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

/// Connected by edges, of however many triangles.
struct Part {
  std::vector<Index> triangles;  ///< ascending
  double volume = 0;             ///< m³, signed
  Box box;
};

std::vector<Part> partsOf(const Patchwork& surface) {
  const EdgeTable edges = buildEdgeTable(surface.triangles, surface.positions.size());
  DisjointSets sets(surface.triangles.size());
  for (std::size_t e = 0; e < edges.ends.size(); ++e) {
    const auto users = edges.trianglesOf(static_cast<Index>(e));
    for (const Index t : users) sets.join(at(users[0]), at(t));
  }
  std::vector<Part> parts;
  std::vector<std::size_t> number(surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::size_t root = sets.find(t);
    if (root == t) {
      number[t] = parts.size();
      parts.emplace_back();
    }
    Part& part = parts[number[root]];
    part.triangles.push_back(static_cast<Index>(t));
    for (const Index v : surface.triangles[t]) part.box.add(surface.positions[at(v)]);
  }
  return parts;
}

std::vector<Triangle> cornersOf(const Patchwork& surface, const Part& part) {
  std::vector<Triangle> list;
  list.reserve(part.triangles.size());
  for (const Index t : part.triangles) list.push_back(surface.triangles[at(t)]);
  return list;
}

double areaOf(const Patchwork& surface, Index t) {
  const Triangle& v = surface.triangles[at(t)];
  const Vec3& a = surface.positions[at(v[0])];
  return 0.5 * (surface.positions[at(v[1])] - a).cross(surface.positions[at(v[2])] - a).norm();
}

const Vec3& cornerOf(const Patchwork& surface, Index t) {
  return surface.positions[at(surface.triangles[at(t)][0])];
}

/// Not a corner: those may lie on another part that is only touched.
Vec3 middleOf(const Patchwork& surface, Index t) {
  Vec3 middle = Vec3::Zero();
  for (const Index v : surface.triangles[at(t)]) middle += surface.positions[at(v)] / 3;
  return middle;
}

/// Walks the patches of edge-neighbours and decides for each triangle whether it is turned.
class Walk {
 public:
  explicit Walk(const Patchwork& surface)
      : surface_(surface),
        edges_(buildEdgeTable(surface.triangles, surface.positions.size())),
        side_(surface.triangles.size(), -1) {}

  std::vector<Index> odd() {
    std::vector<Index> turned;
    for (std::size_t t = 0; t < side_.size(); ++t) {
      if (side_[t] >= 0) continue;
      const std::vector<Index> patch = from(static_cast<Index>(t));
      const auto ones = std::count_if(patch.begin(), patch.end(), [&](Index p) { return side_[at(p)] == 1; });
      const int fewer = 2 * static_cast<std::size_t>(ones) <= patch.size() ? 1 : 0;
      for (const Index p : patch)
        if (side_[at(p)] == fewer) turned.push_back(p);
    }
    std::sort(turned.begin(), turned.end());
    return turned;
  }

 private:
  std::vector<Index> from(Index seed) {
    std::vector<Index> patch{seed};
    side_[at(seed)] = 0;
    for (std::size_t k = 0; k < patch.size(); ++k)
      for (const Index edge : edges_.ofTriangle[at(patch[k])]) {
        const auto users = edges_.trianglesOf(edge);
        if (users.size() != 2) continue;
        const Index other = users[0] == patch[k] ? users[1] : users[0];
        if (side_[at(other)] >= 0) continue;
        const bool against = forward(patch[k], edge) == forward(other, edge);
        side_[at(other)] = static_cast<signed char>(side_[at(patch[k])] ^ static_cast<int>(against));
        patch.push_back(other);
      }
    return patch;
  }
  bool forward(Index t, Index edge) const {
    const auto& slots = edges_.ofTriangle[at(t)];
    return edges_.forward(surface_.triangles, t,
                          static_cast<int>(std::find(slots.begin(), slots.end(), edge) - slots.begin()));
  }

  const Patchwork& surface_;
  const EdgeTable edges_;
  std::vector<signed char> side_;
};

/// Decides from the largest part to the smallest.
class Facing {
 public:
  Facing(Patchwork& surface, bool dropInner, const std::vector<bool>& crossing, const Exec& exec)
      : surface_(surface), parts_(partsOf(surface)), dropInner_(dropInner), exec_(exec) {
    for (Part& part : parts_) part.volume = solidVolume(surface.positions, cornersOf(surface, part));
    crosses_.resize(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (const Index t : parts_[p].triangles) crosses_[p] = crosses_[p] || crossing[at(t)];
    order_.resize(parts_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return std::abs(parts_[a].volume) > std::abs(parts_[b].volume);
    });
  }

  Shells decide() {
    std::vector<int> around(parts_.size(), 0);          // winding number there of the larger parts
    std::vector<bool> inherited(parts_.size(), false);  // turned with what they lie in
    for (std::size_t k = 0; k < order_.size() && !exec_.cancelled(); ++k) {
      const std::size_t p = order_[k];
      const bool turnedByOuter = inherited[p];
      const bool outward = (parts_[p].volume > 0) != turnedByOuter;
      bool isTurned = turnedByOuter, isLeftOut = false;
      if (around[p] <= 0 && !outward) isTurned = !isTurned;
      if (around[p] > 0 && outward && !crosses_[p]) (dropInner_ ? isLeftOut : isTurned) ^= true;
      settle(p, isTurned, isLeftOut);
      if (isLeftOut) continue;
      const int sign = (parts_[p].volume > 0) != isTurned ? 1 : -1;
      for (const std::size_t inner : within(k)) {
        around[inner] += sign;
        // Inside out as a whole, with what it holds.
        if (isTurned != turnedByOuter && around[p] <= 0) inherited[inner] = !inherited[inner];
      }
    }
    keepOnly(surface_, keep_);
    return shells_;
  }

 private:
  void settle(std::size_t p, bool isTurned, bool isLeftOut) {
    keep_.resize(surface_.triangles.size(), true);
    if (isLeftOut) {
      note(shells_.inner, p);
      for (const Index t : parts_[p].triangles) keep_[at(t)] = false;
    } else if (isTurned) {
      note(shells_.inverted, p);
      for (const Index t : parts_[p].triangles) turn(surface_, at(t));
    }
  }
  void note(Defect& defect, std::size_t p) const {
    if (defect.count++ == 0) defect.place = cornerOf(surface_, parts_[p].triangles[0]);
  }
  /// The smaller parts most of whose probes lie in part order_[k].
  std::vector<std::size_t> within(std::size_t k) const {
    const Part& outer = parts_[order_[k]];
    std::optional<SurfaceTree> tree;
    std::vector<std::size_t> list;
    for (std::size_t j = k + 1; j < order_.size() && !exec_.cancelled(); ++j) {
      const std::vector<Index>& triangles = parts_[order_[j]].triangles;
      if (!outer.box.overlaps(parts_[order_[j]].box)) continue;
      if (!tree) tree.emplace(surface_.positions, cornersOf(surface_, outer));
      int inside = 0;
      constexpr std::size_t kProbes = 5;
      for (std::size_t i = 0; i < kProbes; ++i)
        inside += tree->contains(middleOf(surface_, triangles[i * (triangles.size() - 1) / (kProbes - 1)]));
      if (2 * inside > static_cast<int>(kProbes)) list.push_back(order_[j]);
    }
    return list;
  }

  Patchwork& surface_;
  std::vector<Part> parts_;
  std::vector<bool> crosses_;
  std::vector<std::size_t> order_;
  std::vector<bool> keep_;
  Shells shells_;
  bool dropInner_;
  const Exec& exec_;
};

}  // namespace

Defect makeCoherent(Patchwork& surface) {
  Defect turned;
  for (const Index t : Walk(surface).odd()) {
    if (turned.count++ == 0) turned.place = cornerOf(surface, t);
    turn(surface, at(t));
  }
  return turned;
}

std::vector<std::vector<Index>> findLeaves(const Patchwork& surface, double thickness) {
  std::vector<std::vector<Index>> leaves;
  for (Part& part : partsOf(surface)) {
    double area = 0;
    for (const Index t : part.triangles)
      if (!surface.facets[at(t)].isNew) area += areaOf(surface, t);
    const double volume = std::abs(solidVolume(surface.positions, cornersOf(surface, part)));
    const bool wasOpen = std::any_of(part.triangles.begin(), part.triangles.end(),
                                     [&](Index t) { return surface.facets[at(t)].isNew; });
    // What was closed may be thin; what was open is a leaf if filling its border makes nothing of it.
    if (volume > (wasOpen ? thickness : 1e-12) * area * part.box.diagonal()) continue;
    leaves.push_back(std::move(part.triangles));
  }
  return leaves;
}

Shells faceOutward(Patchwork& surface, bool dropInner, const std::vector<bool>& crossing, const Exec& exec) {
  return Facing(surface, dropInner, crossing, exec).decide();
}

}  // namespace sherd
