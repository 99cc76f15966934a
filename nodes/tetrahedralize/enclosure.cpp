#include "tetrahedralize/enclosure.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/parallel.h"
#include "geometry/clipping.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

Vec3 facetNormal(const TetMesh& cage, Index f) {
  const Triangle& t = cage.boundary[at(f)];
  const Vec3& a = cage.nodes[at(t[0])];
  return (cage.nodes[at(t[1])] - a).cross(cage.nodes[at(t[2])] - a).normalized();
}

/// How far the part of a surface triangle over (along the normal of) a facet rises above it.
double heightOver(const TetMesh& cage, Index f, std::span<const Vec3> positions, const Triangle& triangle) {
  const Triangle& corners = cage.boundary[at(f)];
  const Vec3 normal = facetNormal(cage, f);
  Polygon part;
  for (const Index v : triangle) part.push_back(positions[at(v)]);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3& p = cage.nodes[at(corners[c])];
    part = clipPolygon(part, p, (cage.nodes[at(corners[(c + 1) % 3])] - p).cross(normal));
  }
  double height = 0;
  for (const Vec3& p : part) height = std::max(height, normal.dot(p - cage.nodes[at(corners[0])]));
  return height;
}

/// Collects the deepest breach per facet.
class BreachList {
 public:
  void add(Index facet, double depth, const Vec3& place) {
    const auto [found, isNew] = deepest_.try_emplace(facet, Breach{facet, depth, place});
    if (!isNew && depth > found->second.depth) found->second = {facet, depth, place};
  }
  std::vector<Breach> take() const {
    std::vector<Breach> list;
    for (const auto& [facet, breach] : deepest_) list.push_back(breach);
    return list;
  }

 private:
  std::map<Index, Breach> deepest_;
};

/// From vertices of breaching triangles, the vertices outside the cage that hang together, with their
/// distances.
void addOutsideVertices(const SurfaceTree& boundary, std::span<const Vec3> positions,
                        std::span<const Triangle> triangles, std::vector<Index> from, BreachList& breaches,
                        const Exec& exec) {
  std::vector<std::vector<Index>> around(positions.size());
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) around[at(t[c])].push_back(t[(c + 1) % 3]);
  std::vector<bool> seen(positions.size(), false);
  while (!from.empty() && !exec.cancelled()) {
    const Index v = from.back();
    from.pop_back();
    if (seen[at(v)]) continue;
    seen[at(v)] = true;
    if (boundary.contains(positions[at(v)])) continue;
    const SurfacePoint nearest = boundary.closest(positions[at(v)]);
    breaches.add(nearest.triangle, nearest.distance, positions[at(v)]);
    from.insert(from.end(), around[at(v)].begin(), around[at(v)].end());
  }
}

/// Boundary nodes' outward directions.
std::vector<Vec3> nodeNormals(const TetMesh& cage) {
  std::vector<Vec3> normals(cage.nodes.size(), Vec3::Zero());
  for (const Triangle& t : cage.boundary) {
    const Vec3& a = cage.nodes[at(t[0])];
    const Vec3 area = (cage.nodes[at(t[1])] - a).cross(cage.nodes[at(t[2])] - a);
    for (const Index n : t) normals[at(n)] += area;
  }
  for (Vec3& n : normals)
    if (n.squaredNorm() > 0) n.normalize();
  return normals;
}

/// Does a facet with a moved node meet a facet that it shares no node with?
bool meetsItself(const TetMesh& cage, const std::vector<Vec3>& push, const Exec& exec) {
  const SurfaceTree tree(cage.nodes, cage.boundary);
  for (std::size_t f = 0; f < cage.boundary.size() && !exec.cancelled(); ++f) {
    const Triangle& t = cage.boundary[f];
    if (std::all_of(t.begin(), t.end(), [&](Index n) { return push[at(n)].isZero(); })) continue;
    for (const Index other : tree.meeting(cage.nodes[at(t[0])], cage.nodes[at(t[1])], cage.nodes[at(t[2])])) {
      const Triangle& o = cage.boundary[at(other)];
      if (std::none_of(t.begin(), t.end(),
                       [&](Index n) { return std::find(o.begin(), o.end(), n) != o.end(); }))
        return true;
    }
  }
  return false;
}

constexpr double kLeastShare = 0.3;  ///< of its volume that a tetrahedron keeps in one push

/// Moves the nodes, halving the moves at tetrahedra that would get too small. False if nothing moved.
bool moveNodes(TetMesh& cage, std::vector<Vec3>& push, const Exec& exec) {
  const std::vector<Vec3> before = cage.nodes;
  const auto volumeOf = [&](const Tetra& t, const std::vector<Vec3>& x) {
    return (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).dot(x[at(t[3])] - x[at(t[0])]);
  };
  for (int round = 0; round < 12 && !exec.cancelled(); ++round) {
    for (std::size_t n = 0; n < cage.nodes.size(); ++n) cage.nodes[n] = before[n] + push[n];
    std::set<Index> tooFar;
    for (const Tetra& t : cage.tets)
      if (volumeOf(t, cage.nodes) < kLeastShare * volumeOf(t, before)) tooFar.insert(t.begin(), t.end());
    if (tooFar.empty() && !meetsItself(cage, push, exec))
      return std::any_of(push.begin(), push.end(), [](const Vec3& p) { return !p.isZero(); });
    // Where the boundary would meet itself all moves are halved: rare, and then any of them may be the cause.
    if (tooFar.empty())
      for (Vec3& p : push) p *= 0.5;
    for (const Index n : tooFar) push[at(n)] *= round < 10 ? 0.5 : 0.0;
  }
  cage.nodes = before;
  return false;
}

}  // namespace

std::vector<Breach> findBreaches(const TetMesh& cage, std::span<const Vec3> positions,
                                 std::span<const Triangle> triangles, const std::vector<Shell>& shells,
                                 const Exec& exec) {
  const SurfaceTree tree(cage.nodes, cage.boundary);
  const auto corner = [&](std::size_t t, std::size_t c) { return positions[at(triangles[t][c])]; };
  std::vector<char> breaching(triangles.size(), 0);
  parallelFor(exec, triangles.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      breaching[t] = tree.meets(corner(t, 0), corner(t, 1), corner(t, 2));
  });
  BreachList breaches;
  std::vector<Index> start;
  for (std::size_t t = 0; t < triangles.size() && !exec.cancelled(); ++t) {
    if (!breaching[t]) continue;
    start.insert(start.end(), triangles[t].begin(), triangles[t].end());
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2), middle = (a + b + c) / 3;
    for (const Index f : tree.meeting(a, b, c))
      breaches.add(f, heightOver(cage, f, positions, triangles[t]), middle);
  }
  // A shell that meets no facet is inside as a whole or outside as a whole.
  for (const Shell& shell : shells) start.push_back(triangles[at(shell.triangles.front())][0]);
  addOutsideVertices(tree, positions, triangles, std::move(start), breaches, exec);
  return breaches.take();
}

std::vector<Breach> pushOutward(TetMesh& cage, std::vector<Breach> breaches, std::span<const Vec3> positions,
                                std::span<const Triangle> triangles, const std::vector<Shell>& shells,
                                const Exec& exec) {
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds && !breaches.empty() && !exec.cancelled(); ++round) {
    const std::vector<Vec3> normals = nodeNormals(cage);
    std::vector<double> length(cage.nodes.size(), 0.0);
    for (const Breach& b : breaches) {
      const Triangle& facet = cage.boundary[at(b.facet)];
      const double side = (cage.nodes[at(facet[1])] - cage.nodes[at(facet[0])]).norm();
      const Vec3 normal = facetNormal(cage, b.facet);
      for (const Index n : facet) {
        const double cosine = std::max(0.4, normals[at(n)].dot(normal));
        length[at(n)] = std::max(length[at(n)], std::min(0.3 * side, (1.1 * b.depth + 0.01 * side) / cosine));
      }
    }
    std::vector<Vec3> push(cage.nodes.size());
    for (std::size_t n = 0; n < push.size(); ++n) push[n] = length[n] * normals[n];
    if (!moveNodes(cage, push, exec)) break;
    breaches = findBreaches(cage, positions, triangles, shells, exec);
  }
  return breaches;
}

}  // namespace sherd
