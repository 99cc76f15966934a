#include "geometry/orient.h"

#include <algorithm>
#include <optional>

#include "geometry/solid.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

/// Do the two triangles of an edge run along it in the same direction, so that one of them is the wrong way
/// round?
bool runsAlong(std::span<const Triangle> triangles, const EdgeTable& edges, Index edge) {
  const auto users = edges.trianglesOf(edge);
  bool forward[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& slots = edges.ofTriangle[at(users[k])];
    const int slot = static_cast<int>(std::find(slots.begin(), slots.end(), edge) - slots.begin());
    forward[k] = edges.forward(triangles, users[k], slot);
  }
  return forward[0] == forward[1];
}

/// Walks over one part from `seed`, giving each triangle the side (0 or 1) on which its neighbours agree.
class Walk {
 public:
  Walk(std::span<const Triangle> triangles, const EdgeTable& edges)
      : triangles_(triangles), edges_(edges), side_(triangles.size(), -1) {}

  bool visited(Index t) const { return side_[at(t)] >= 0; }

  SurfacePart from(Index seed) {
    SurfacePart shell{.triangles = {seed}, .closed = true, .orientable = true, .odd = {}, .conflict = -1};
    side_[at(seed)] = 0;
    for (std::size_t k = 0; k < shell.triangles.size(); ++k)
      for (const Index edge : edges_.ofTriangle[at(shell.triangles[k])])
        visit(shell, shell.triangles[k], edge);
    std::sort(shell.triangles.begin(), shell.triangles.end());
    if (shell.orientable) chooseFewer(shell);
    return shell;
  }

 private:
  void visit(SurfacePart& shell, Index t, Index edge) {
    const auto users = edges_.trianglesOf(edge);
    if (users.size() != 2) shell.closed = false;
    if (users.size() > 2) fail(shell, edge);
    for (const Index other : users) {
      if (other == t) continue;
      const bool against = users.size() == 2 && runsAlong(triangles_, edges_, edge);
      const auto wanted = static_cast<signed char>(side_[at(t)] ^ static_cast<int>(against));
      if (!visited(other)) {
        side_[at(other)] = wanted;
        shell.triangles.push_back(other);
      } else if (users.size() == 2 && side_[at(other)] != wanted) {
        fail(shell, edge);
      }
    }
  }
  static void fail(SurfacePart& shell, Index edge) {
    shell.orientable = false;
    if (shell.conflict < 0) shell.conflict = edge;
  }
  void chooseFewer(SurfacePart& shell) const {
    const auto ones = std::count_if(shell.triangles.begin(), shell.triangles.end(),
                                    [&](Index t) { return side_[at(t)] == 1; });
    const int odd = 2 * static_cast<std::size_t>(ones) <= shell.triangles.size() ? 1 : 0;
    for (const Index t : shell.triangles)
      if (side_[at(t)] == odd) shell.odd.push_back(t);
  }

  std::span<const Triangle> triangles_;
  const EdgeTable& edges_;
  std::vector<signed char> side_;
};

std::vector<Triangle> cornersOf(const TriMesh& mesh, const SurfacePart& shell) {
  std::vector<Triangle> list;
  list.reserve(shell.triangles.size());
  for (const Index t : shell.triangles) list.push_back(mesh.triangles[at(t)]);
  return list;
}

template <class T>
void swapCorners(std::vector<T>& perCorner, std::size_t t) {
  if (!perCorner.empty()) std::swap(perCorner[3 * t + 1], perCorner[3 * t + 2]);
}

/// Negates the normals of the given triangles where, summed up, they point to the back.
void faceNormals(TriMesh& mesh, const std::vector<Index>& list) {
  if (mesh.normals.empty()) return;
  double agreement = 0;
  for (const Index t : list) {
    const Triangle& v = mesh.triangles[at(t)];
    const Vec3& a = mesh.positions[at(v[0])];
    const Vec3 area = (mesh.positions[at(v[1])] - a).cross(mesh.positions[at(v[2])] - a);
    for (std::size_t c = 0; c < 3; ++c) agreement += area.dot(mesh.normals[3 * at(t) + c]);
  }
  if (agreement >= 0) return;
  for (const Index t : list)
    for (std::size_t c = 0; c < 3; ++c) mesh.normals[3 * at(t) + c] *= -1;
}

void turn(TriMesh& mesh, const std::vector<Index>& list) {
  for (const Index triangle : list) {
    const std::size_t t = at(triangle);
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    swapCorners(mesh.normals, t);
    for (auto& set : mesh.uvSets) swapCorners(set.uv, t);
    for (auto& set : mesh.colorSets) swapCorners(set.rgba, t);
  }
  faceNormals(mesh, list);
}

}  // namespace

std::vector<SurfacePart> surfaceParts(std::span<const Triangle> triangles, const EdgeTable& edges) {
  std::vector<SurfacePart> shells;
  Walk walk(triangles, edges);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!walk.visited(static_cast<Index>(t))) shells.push_back(walk.from(static_cast<Index>(t)));
  return shells;
}

Nesting nestShells(const TriMesh& mesh, const std::vector<SurfacePart>& shells) {
  Nesting nesting{std::vector<double>(shells.size(), 0), std::vector<int>(shells.size(), 0)};
  std::vector<Box> boxes(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (!shells[s].closed || !shells[s].orientable) continue;
    if (shells[s].odd.empty()) nesting.volume[s] = solidVolume(mesh.positions, cornersOf(mesh, shells[s]));
    for (const Index t : shells[s].triangles)
      for (const Index v : mesh.triangles[at(t)]) boxes[s].add(mesh.positions[at(v)]);
  }
  for (std::size_t outer = 0; outer < shells.size(); ++outer) {
    std::optional<SurfaceTree> tree;
    for (std::size_t inner = 0; inner < shells.size(); ++inner) {
      const Vec3& p = mesh.positions[at(mesh.triangles[at(shells[inner].triangles[0])][0])];
      Box point;
      point.add(p);
      if (inner == outer || !boxes[outer].overlaps(point)) continue;
      if (!tree) tree.emplace(mesh.positions, cornersOf(mesh, shells[outer]));
      if (tree->contains(p)) ++nesting.depth[inner];
    }
  }
  return nesting;
}

Turned orient(TriMesh& mesh) {
  Turned turned;
  std::vector<SurfacePart> shells =
      surfaceParts(mesh.triangles, buildEdgeTable(mesh.triangles, mesh.positions.size()));
  bool solid = true;
  for (SurfacePart& shell : shells) {
    turned.triangles += shell.odd.size();
    turn(mesh, shell.odd);
    shell.odd.clear();
    solid = solid && shell.closed && shell.orientable;
  }
  if (!solid) return turned;
  const Nesting nesting = nestShells(mesh, shells);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const bool isVoid = nesting.depth[s] % 2 == 1;
    if (isVoid ? nesting.volume[s] <= 0 : nesting.volume[s] >= 0) continue;
    turn(mesh, shells[s].triangles);
    ++(isVoid ? turned.voids : turned.shells);
  }
  return turned;
}

}  // namespace sherd
