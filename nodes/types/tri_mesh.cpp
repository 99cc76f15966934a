#include "types/tri_mesh.h"

namespace sherd {

void hashValue(Hasher& hasher, const TriMesh& mesh) {
  hasher.add(mesh.positions).add(mesh.triangles).add(mesh.normals).add(mesh.materialOf);
  for (const auto& set : mesh.uvSets) hasher.add(set.name).add(set.uv);
  for (const auto& set : mesh.colorSets) hasher.add(set.name).add(set.rgba);
  for (const auto& name : mesh.materials) hasher.add(name);
  hasher.add(mesh.uvSets.size()).add(mesh.colorSets.size()).add(mesh.materials.size());
  hasher.add(mesh.frame.metresPerUnit).add(static_cast<int>(mesh.frame.up)).add(mesh.source);
}

std::size_t byteSize(const TriMesh& mesh) {
  std::size_t bytes = mesh.positions.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(Triangle) +
                      mesh.normals.size() * sizeof(Vec3) + mesh.materialOf.size() * sizeof(Index);
  for (const auto& set : mesh.uvSets) bytes += set.uv.size() * sizeof(Vec2);
  for (const auto& set : mesh.colorSets) bytes += set.rgba.size() * sizeof(Vec4);
  return bytes;
}

}  // namespace sherd
