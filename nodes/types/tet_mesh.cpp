#include "types/tet_mesh.h"

#include <algorithm>

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<TetMesh>);

void hashValue(Hasher& hasher, const TetMesh& mesh) {
  hashPart(hasher, mesh.surface);
  hasher.add(mesh.nodes).add(mesh.tets).add(mesh.neighbours).add(mesh.boundary);
  hasher.add(mesh.heldBegin).add(mesh.held).add(mesh.insideFraction);
  hasher.add(mesh.vertexTet).add(mesh.surfaceNeighbours);
  hasher.add(mesh.patches.begin).add(mesh.patches.triangles).add(mesh.patches.regular);
  hasher.add(mesh.patches.neighbourBegin).add(mesh.patches.neighbours).add(mesh.patches.sums);
  hashBits(hasher, mesh.patches.origin);
  hashBits(hasher, mesh.quality);
}

std::size_t byteSize(const TetMesh& mesh) {
  return (mesh.surface ? byteSize(*mesh.surface) : 0) + mesh.nodes.size() * sizeof(Vec3) +
         mesh.tets.size() * (2 * sizeof(Tetra) + sizeof(double)) + mesh.boundary.size() * sizeof(Triangle) +
         (mesh.held.size() + mesh.heldBegin.size() + mesh.vertexTet.size()) * sizeof(Index) +
         mesh.surfaceNeighbours.size() * sizeof(Triangle) +
         (2 * mesh.patches.triangles.size() + mesh.patches.neighbours.size()) * sizeof(Index) +
         mesh.patches.count() * (sizeof(SolidSums) + 2 * sizeof(Index) + 1);
}

void saveValue(ArchiveWriter& to, const TetMesh& mesh) {
  to.part(mesh.surface);
  to.array(mesh.nodes);
  to.array(mesh.tets);
  to.array(mesh.neighbours);
  to.array(mesh.boundary);
  to.array(mesh.heldBegin);
  to.array(mesh.held);
  to.array(mesh.vertexTet);
  to.array(mesh.surfaceNeighbours);
  const TrianglePatches& patches = mesh.patches;
  to.array(patches.begin);
  to.array(patches.triangles);
  to.array(patches.neighbourBegin);
  to.array(patches.neighbours);
  to.array(patches.regular);
  to.array(patches.sums);
  putBits(to, patches.origin);
  to.array(mesh.insideFraction);
  putBits(to, mesh.quality);
}

namespace {

/// `count` lists that follow one another without gap, of numbers below `end`; or nothing at all.
bool listsAreSound(const std::vector<Index>& begin, const std::vector<Index>& list, std::size_t count,
                   std::size_t end) {
  if (begin.empty()) return list.empty();
  return begin.size() == count + 1 && begin.front() == 0 && std::is_sorted(begin.begin(), begin.end()) &&
         at(begin.back()) == list.size() && allInRange(list, 0, end);
}

bool patchesAreSound(const TrianglePatches& p, std::size_t triangles) {
  return listsAreSound(p.begin, p.triangles, p.count(), triangles) &&
         listsAreSound(p.neighbourBegin, p.neighbours, p.count(), p.count()) && p.sums.size() == p.count() &&
         (p.begin.empty() ? p.count() == 0 : p.triangles.size() == triangles);
}

/// Either absent or one entry per vertex and triangle of the surface.
bool linksAreSound(const TetMesh& mesh) {
  const std::size_t vertices = mesh.surface ? mesh.surface->positions.size() : 0,
                    triangles = mesh.surface ? mesh.surface->triangles.size() : 0;
  return (mesh.vertexTet.empty() || mesh.vertexTet.size() == vertices) &&
         allInRange(mesh.vertexTet, -1, mesh.tets.size()) &&
         (mesh.surfaceNeighbours.empty() || mesh.surfaceNeighbours.size() == triangles) &&
         allInRange(mesh.surfaceNeighbours, 0, triangles) && patchesAreSound(mesh.patches, triangles);
}

bool isSound(const TetMesh& mesh) {
  const std::size_t tets = mesh.tets.size();
  return allInRange(mesh.tets, 0, mesh.nodes.size()) && allInRange(mesh.boundary, 0, mesh.nodes.size()) &&
         (mesh.neighbours.empty() || mesh.neighbours.size() == tets) &&
         allInRange(mesh.neighbours, -1, tets) &&
         (mesh.insideFraction.empty() || mesh.insideFraction.size() == tets) &&
         listsAreSound(mesh.heldBegin, mesh.held, tets, mesh.surface ? mesh.surface->triangles.size() : 0) &&
         linksAreSound(mesh);
}

}  // namespace

std::optional<TetMesh> loadValue(ArchiveReader& from, std::type_identity<TetMesh>) {
  std::optional<TetMesh> loaded(std::in_place);
  TetMesh& mesh = *loaded;
  mesh.surface = from.part<TriMesh>();
  from.array(mesh.nodes);
  from.array(mesh.tets);
  from.array(mesh.neighbours);
  from.array(mesh.boundary);
  from.array(mesh.heldBegin);
  from.array(mesh.held);
  from.array(mesh.vertexTet);
  from.array(mesh.surfaceNeighbours);
  TrianglePatches& patches = mesh.patches;
  from.array(patches.begin);
  from.array(patches.triangles);
  from.array(patches.neighbourBegin);
  from.array(patches.neighbours);
  from.array(patches.regular);
  from.array(patches.sums);
  getBits(from, patches.origin);
  from.array(mesh.insideFraction);
  getBits(from, mesh.quality);
  if (!from.ok() || !isSound(mesh)) return std::nullopt;
  mesh.patches.indexTriangles();
  return loaded;
}

double tetVolume(const TetMesh& mesh, std::size_t t) {
  const Tetra& tet = mesh.tets[t];
  const Vec3& a = mesh.nodes[at(tet[0])];
  const Vec3 b = mesh.nodes[at(tet[1])] - a, c = mesh.nodes[at(tet[2])] - a, d = mesh.nodes[at(tet[3])] - a;
  return b.cross(c).dot(d) / 6;
}

std::vector<double> lumpedVolumes(const TetMesh& mesh) {
  std::vector<double> volume(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double share = 0.25 * tetVolume(mesh, t) * mesh.insideFraction[t];
    for (const Index n : mesh.tets[t]) volume[at(n)] += share;
  }
  return volume;
}

void connectTets(TetMesh& mesh) {
  struct Side {
    Triangle key;
    Index tet, face;
  };
  std::vector<Side> sides;
  sides.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      Triangle key;
      for (std::size_t c = 0; c < 3; ++c) key[c] = mesh.tets[t][static_cast<std::size_t>(kTetraFace[f][c])];
      std::sort(key.begin(), key.end());
      sides.push_back({key, static_cast<Index>(t), f});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.key, a.tet) < std::tie(b.key, b.tet); });
  mesh.neighbours.assign(mesh.tets.size(), Tetra{-1, -1, -1, -1});
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.key != b.key) continue;
    mesh.neighbours[at(a.tet)][at(a.face)] = b.tet;
    mesh.neighbours[at(b.tet)][at(b.face)] = a.tet;
  }
  mesh.boundary.clear();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t f = 0; f < 4; ++f) {
      if (mesh.neighbours[t][f] >= 0) continue;
      Triangle face;
      for (std::size_t c = 0; c < 3; ++c) face[c] = mesh.tets[t][static_cast<std::size_t>(kTetraFace[f][c])];
      mesh.boundary.push_back(face);
    }
}

}  // namespace sherd
