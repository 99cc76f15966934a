#include "repair/sheets.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/disjoint_sets.h"
#include "geometry/edge_table.h"
#include "geometry/solid.h"
#include "repair/holes.h"

namespace sherd {
namespace {

/// Faces that hang together across edges of two.
struct Patch {
  std::vector<Index> triangles;
  std::vector<Index> joints;  ///< edges of three triangles and more, each as often as the patch uses it
  bool isOpen = false;
  bool isSheet = false;
};

std::vector<Patch> patchesOf(const Patchwork& surface, const EdgeTable& edges) {
  DisjointSets sets(surface.triangles.size());
  for (std::size_t e = 0; e < edges.ends.size(); ++e)
    if (const auto users = edges.trianglesOf(static_cast<Index>(e)); users.size() == 2)
      sets.join(at(users[0]), at(users[1]));
  std::map<std::size_t, Patch> byRoot;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Patch& patch = byRoot[sets.find(t)];
    patch.triangles.push_back(static_cast<Index>(t));
    for (const Index edge : edges.ofTriangle[t]) {
      const std::size_t uses = edges.trianglesOf(edge).size();
      if (uses == 1) patch.isOpen = true;
      if (uses > 2) patch.joints.push_back(edge);
    }
  }
  std::vector<Patch> patches;
  for (auto& [root, patch] : byRoot) patches.push_back(std::move(patch));
  return patches;
}

/// Does it bound next to nothing once its border is filled?
bool isThin(const Patchwork& surface, const Patch& patch, double thickness, const Exec& exec) {
  Patchwork own;
  std::map<Index, Index> numbers;
  for (const Index t : patch.triangles) {
    Triangle corners = surface.triangles[at(t)];
    for (Index& v : corners) {
      const auto [it, isNew] = numbers.try_emplace(v, static_cast<Index>(own.positions.size()));
      if (isNew) own.positions.push_back(surface.positions[at(v)]);
      v = it->second;
    }
    own.add(corners, surface.facets[at(t)]);
  }
  fillHoles(own, exec);
  const double volume = std::abs(solidVolume(own.positions, own.triangles));
  return volume <= thickness * areaOf(surface, patch.triangles) * boxOf(own.positions).diagonal();
}

/// Takes back what others don't close without, until nothing changes.
void keepClosed(std::vector<Patch>& patches) {
  for (bool changed = true; changed;) {
    changed = false;
    std::map<Index, std::size_t> others;  // uses of an edge by what is no sheet
    for (const Patch& patch : patches)
      for (const Index edge : patch.joints) others[edge] += patch.isSheet ? 0 : 1;
    for (Patch& patch : patches) {
      const bool isSheet = patch.isSheet && std::all_of(patch.joints.begin(), patch.joints.end(),
                                                        [&](Index e) { return others[e] % 2 == 0; });
      changed = changed || isSheet != patch.isSheet;
      patch.isSheet = isSheet;
    }
  }
}

/// Takes back what hangs on no solid.
void keepHanging(std::vector<Patch>& patches) {
  std::map<Index, bool> isHeld;
  for (const Patch& patch : patches)
    for (const Index edge : patch.joints) isHeld[edge] = isHeld[edge] || !patch.isSheet;
  std::vector<bool> hangs(patches.size(), false);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const Patch& patch = patches[p];
      if (!patch.isSheet || hangs[p] ||
          std::none_of(patch.joints.begin(), patch.joints.end(), [&](Index e) { return isHeld[e]; }))
        continue;
      changed = hangs[p] = true;
      for (const Index edge : patch.joints) isHeld[edge] = true;
    }
  }
  for (std::size_t p = 0; p < patches.size(); ++p) patches[p].isSheet = hangs[p];
}

/// Points of the triangle, the corners among them, no farther apart than a fiftieth of the solid unless there
/// would be more than about a hundred.
std::vector<Vec3> pointsOf(const Patchwork& surface, Index t, const Footing& solid) {
  const auto& [i, j, k] = surface.triangles[at(t)];
  const Vec3 &a = surface.positions[at(i)], &b = surface.positions[at(j)], &c = surface.positions[at(k)];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int steps = static_cast<int>(std::clamp(std::ceil(50 * longest / solid.diagonal()), 1.0, 12.0));
  std::vector<Vec3> points;
  for (int u = 0; u <= steps; ++u)
    for (int v = 0; u + v <= steps; ++v) points.push_back((u * a + v * b + (steps - u - v) * c) / steps);
  return points;
}

}  // namespace

std::vector<DanglingSheet> danglingSheets(const Patchwork& surface, double thickness, const Exec& exec) {
  const EdgeTable edges = buildEdgeTable(surface.triangles, surface.positions.size());
  std::vector<Patch> patches = patchesOf(surface, edges);
  bool any = false;
  for (Patch& patch : patches) {
    if (exec.cancelled()) return {};
    patch.isSheet = patch.isOpen && !patch.joints.empty() && isThin(surface, patch, thickness, exec);
    any = any || patch.isSheet;
  }
  if (!any) return {};
  keepClosed(patches);
  keepHanging(patches);
  std::vector<DanglingSheet> sheets;
  for (Patch& patch : patches) {
    if (!patch.isSheet) continue;
    const Vec3 place = surface.positions[at(surface.triangles[at(patch.triangles[0])][0])];
    const double area = areaOf(surface, patch.triangles);
    sheets.push_back({std::move(patch.triangles), area, place});
  }
  return sheets;
}

SheetPlace placeOf(const Patchwork& surface, const std::vector<Index>& sheet, const Footing& solid,
                   double on) {
  bool touches = false, isWithin = true;
  for (const Index t : sheet)
    for (const Vec3& p : pointsOf(surface, t, solid)) {
      const bool holds = solid.holds(p);
      touches = touches || holds || solid.isNear(p, on);
      isWithin = isWithin && holds;
      if (touches && !isWithin) return SheetPlace::Touching;
    }
  return isWithin ? SheetPlace::Within : SheetPlace::Free;
}

bool slabOverlaps(const Patchwork& surface, const std::vector<Index>& sheet, const Footing& solid,
                  double thickness) {
  for (const Index t : sheet) {
    const auto& [i, j, k] = surface.triangles[at(t)];
    const Vec3& a = surface.positions[at(i)];
    const Vec3 normal = (surface.positions[at(j)] - a).cross(surface.positions[at(k)] - a).normalized();
    for (const Vec3& p : pointsOf(surface, t, solid))
      for (const double side : {0.0, -0.45, 0.45})
        if (const Vec3 q = p + side * thickness * normal; solid.holds(q) && !solid.isNear(q, 0.1 * thickness))
          return true;
  }
  return false;
}

double areaOf(const Patchwork& surface, const std::vector<Index>& sheet) {
  double area = 0;
  for (const Index t : sheet) {
    const auto& [i, j, k] = surface.triangles[at(t)];
    const Vec3& a = surface.positions[at(i)];
    area += 0.5 * (surface.positions[at(j)] - a).cross(surface.positions[at(k)] - a).norm();
  }
  return area;
}

}  // namespace sherd
