#include "geometry/weld.h"

#include <bit>
#include <unordered_map>

namespace sherd {
namespace {

using Bits = std::array<std::uint64_t, 3>;

/// Equal for equal numbers: adding +0 turns −0 into +0 and changes nothing else.
Bits bitsOf(const Vec3& p) {
  return {std::bit_cast<std::uint64_t>(p.x() + 0.0), std::bit_cast<std::uint64_t>(p.y() + 0.0),
          std::bit_cast<std::uint64_t>(p.z() + 0.0)};
}

struct BitsHash {
  std::size_t operator()(const Bits& bits) const {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const std::uint64_t b : bits) {  // the finaliser of splitmix64, per coordinate
      h ^= b;
      h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
      h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
      h ^= h >> 31;
    }
    return static_cast<std::size_t>(h);
  }
};

/// Per vertex, the first one at its position.
std::vector<Index> firstAtPosition(const std::vector<Vec3>& positions) {
  std::unordered_map<Bits, Index, BitsHash> seen;
  seen.reserve(positions.size());
  std::vector<Index> first(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    first[v] = seen.try_emplace(bitsOf(positions[v]), static_cast<Index>(v)).first->second;
  return first;
}

std::vector<bool> usedVertices(const TriMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) used[at(v)] = true;
  return used;
}

/// Moves the kept groups of `width` entries to the front.
template <class T>
void compact(std::vector<T>& list, std::size_t width, const std::vector<bool>& keep) {
  if (list.empty()) return;
  std::size_t to = 0;
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t])
      for (std::size_t c = 0; c < width; ++c) list[to++] = list[width * t + c];
  list.resize(to);
}

void dropUnusedVertices(TriMesh& mesh) {
  const std::vector<bool> used = usedVertices(mesh);
  std::vector<Index> number(mesh.positions.size(), -1);
  std::size_t next = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    number[v] = static_cast<Index>(next);
    mesh.positions[next++] = mesh.positions[v];
  }
  mesh.positions.resize(next);
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) v = number[at(v)];
}

}  // namespace

void keepTriangles(TriMesh& mesh, const std::vector<bool>& keep) {
  compact(mesh.triangles, 1, keep);
  compact(mesh.materialOf, 1, keep);
  compact(mesh.normals, 3, keep);
  for (auto& set : mesh.uvSets) compact(set.uv, 3, keep);
  for (auto& set : mesh.colorSets) compact(set.rgba, 3, keep);
}

WeldCounts weld(TriMesh& mesh) {
  WeldCounts counts;
  const std::vector<bool> used = usedVertices(mesh);
  const std::vector<Index> first = firstAtPosition(mesh.positions);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v])
      ++counts.unusedVertices;
    else if (first[v] != static_cast<Index>(v))
      ++counts.joined;
  }
  std::vector<bool> keep(mesh.triangles.size());
  for (std::size_t t = 0; t < keep.size(); ++t) {
    Triangle& triangle = mesh.triangles[t];
    for (Index& v : triangle) v = first[at(v)];
    keep[t] = triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0];
    if (!keep[t]) ++counts.collapsedTriangles;
  }
  if (counts.collapsedTriangles > 0) keepTriangles(mesh, keep);
  dropUnusedVertices(mesh);
  return counts;
}

}  // namespace sherd
