#include "tetrahedralize/shells.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "geometry/solid.h"

namespace sherd {
namespace {

/// A directed edge (from, to) of corner `corner` (3 · triangle + c), keyed by its smaller vertex first.
struct Side {
  Index low, high, corner;
  bool forward;
};

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  Index find(Index i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  void join(Index a, Index b) {
    a = find(a), b = find(b);
    if (a != b) parent_[at(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

std::vector<Side> sortedSides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(3 * t + c), a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return sides;
}

Error edgeError(std::span<const Vec3> positions, const Side& side, std::size_t count) {
  const Vec3 middle = 0.5 * (positions[at(side.low)] + positions[at(side.high)]);
  const std::string where = "at the edge near " + placeText(middle) + " m";
  if (count == 1) return failure("the surface is open " + where, "close its holes", "mesh");
  if (count == 2)
    return failure("two neighbouring triangles are oriented against each other " + where,
                   "make the orientation consistent", "mesh");
  return failure(std::to_string(count) + " triangles meet " + where,
                 "make the surface a manifold: two triangles at each edge", "mesh");
}

/// Triangles joined across edges, and corners of one vertex joined around it (a fan is a set of joined
/// corners).
struct Joined {
  UnionFind triangles, corners;
};

Result<Joined> joinAcrossEdges(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  Joined joined{UnionFind(triangles.size()), UnionFind(3 * triangles.size())};
  const std::vector<Side> sides = sortedSides(triangles);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i != 2 || sides[i].forward == sides[i + 1].forward)
      return edgeError(positions, sides[i], end - i);
    const Index a = sides[i].corner, b = sides[i + 1].corner;
    const auto next = [](Index corner) { return corner - corner % 3 + (corner + 1) % 3; };
    joined.triangles.join(a / 3, b / 3);
    joined.corners.join(a, next(b));
    joined.corners.join(next(a), b);
    i = end;
  }
  return joined;
}

}  // namespace

Result<std::vector<Shell>> splitShells(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  for (const Triangle& t : triangles)
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      return failure("a triangle uses one vertex twice at " + placeText(positions[at(t[0])]) + " m",
                     "remove degenerate triangles", "mesh");
  SHERD_ASSIGN(Joined joined, joinAcrossEdges(positions, triangles));

  std::vector<Shell> shells;
  std::vector<Index> shellOf(triangles.size(), -1), fanOf(positions.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Index root = joined.triangles.find(static_cast<Index>(t));
    if (at(root) == t) {
      shellOf[t] = static_cast<Index>(shells.size());
      shells.emplace_back();
    }
    shellOf[t] = shellOf[at(root)];
    Shell& shell = shells[at(shellOf[t])];
    shell.triangles.push_back(static_cast<Index>(t));
    for (std::size_t c = 0; c < 3; ++c) {
      const Index corner = static_cast<Index>(3 * t + c);
      if (joined.corners.find(corner) != corner) continue;
      Index& fan = fanOf[at(triangles[t][c])];
      if (fan >= 0)
        return failure("two parts of the surface touch in one vertex at " +
                           placeText(positions[at(triangles[t][c])]) + " m",
                       "separate them or double the vertex", "mesh");
      fan = corner;
      ++shell.euler;  // one fan, one vertex
    }
  }
  for (Shell& shell : shells) {
    shell.euler -= static_cast<int>(shell.triangles.size()) / 2;  // E = 3/2 F
    std::vector<Triangle> part;
    for (const Index t : shell.triangles) part.push_back(triangles[at(t)]);
    shell.volume = solidVolume(positions, part);
  }
  return shells;
}

std::vector<std::pair<bool, int>> topologyOf(const std::vector<Shell>& shells) {
  std::vector<std::pair<bool, int>> topology;
  for (const Shell& shell : shells) topology.emplace_back(shell.volume < 0, shell.euler);
  std::sort(topology.begin(), topology.end());
  return topology;
}

bool enclosesTopology(const std::vector<std::pair<bool, int>>& got,
                      const std::vector<std::pair<bool, int>>& wanted, std::size_t contacts) {
  if (got == wanted) return true;
  const auto sum = [](const std::vector<std::pair<bool, int>>& shells, bool voids) {
    std::pair<int, int> countAndEuler{0, 0};
    for (const auto& [isVoid, euler] : shells)
      if (isVoid == voids) ++countAndEuler.first, countAndEuler.second += euler;
    return countAndEuler;
  };
  const auto [gotBodies, gotEuler] = sum(got, false);
  const auto [bodies, euler] = sum(wanted, false);
  const int most = static_cast<int>(std::min<std::size_t>(contacts, 1u << 20));
  // A contact joins two components, or is a handle: either takes 2 from the Euler characteristic.
  return sum(got, true) == sum(wanted, true) && gotBodies >= std::max(1, bodies - most) &&
         gotBodies <= bodies && gotEuler <= euler && gotEuler >= euler - 2 * most;
}

namespace {

struct Counts {
  int components = 0, voids = 0, handles = 0;
};

Counts countsOf(const std::vector<std::pair<bool, int>>& topology) {
  Counts c;
  for (const auto& [isVoid, euler] : topology) {
    ++(isVoid ? c.voids : c.components);
    c.handles += (2 - euler) / 2;
  }
  return c;
}

}  // namespace

bool joinsSome(const std::vector<std::pair<bool, int>>& got,
               const std::vector<std::pair<bool, int>>& wanted) {
  return countsOf(got).components < countsOf(wanted).components;
}

bool joinsNoBodies(const std::vector<std::pair<bool, int>>& got,
                   const std::vector<std::pair<bool, int>>& wanted) {
  const Counts a = countsOf(got), b = countsOf(wanted);
  return a.components == b.components && a.voids >= b.voids;
}

int topologyDifference(const std::vector<std::pair<bool, int>>& got,
                       const std::vector<std::pair<bool, int>>& wanted) {
  const Counts a = countsOf(got), b = countsOf(wanted);
  return std::abs(a.components - b.components) + std::abs(a.voids - b.voids) +
         std::abs(a.handles - b.handles);
}

std::string describeTopology(const std::vector<std::pair<bool, int>>& topology) {
  const auto [components, voids, handles] = countsOf(topology);
  const auto count = [](int n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
  };
  return count(components, "component", "components") + ", " + count(voids, "void", "voids") + ", " +
         count(handles, "handle", "handles");
}

std::string placeText(const Vec3& place) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", place.x(), place.y(), place.z());
  return text;
}

}  // namespace sherd
