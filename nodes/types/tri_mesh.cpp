#include "types/tri_mesh.h"

#include "base/value_type.h"
#include "types/surface_looks.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<TriMesh>);

void hashValue(Hasher& hasher, const TriMesh& mesh) {
  hasher.add(mesh.positions).add(mesh.triangles).add(mesh.normals).add(mesh.materialOf);
  hasher.add(mesh.uvSets.size()).add(mesh.colorSets.size()).add(mesh.materials.size());
  for (const auto& set : mesh.uvSets) hasher.add(set.name).add(set.uv);
  for (const auto& set : mesh.colorSets) hasher.add(set.name).add(set.rgba);
  for (const auto& name : mesh.materials) hasher.add(name);
  hashBits(hasher, mesh.frame);
  hasher.add(mesh.source).add(mesh.piece);
  hashPart(hasher, mesh.looks);
}

std::size_t byteSize(const TriMesh& mesh) {
  std::size_t bytes = mesh.positions.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(Triangle) +
                      mesh.normals.size() * sizeof(Vec3) + mesh.materialOf.size() * sizeof(Index);
  for (const auto& set : mesh.uvSets) bytes += set.uv.size() * sizeof(Vec2);
  for (const auto& set : mesh.colorSets) bytes += set.rgba.size() * sizeof(Vec4);
  if (mesh.looks) bytes += byteSize(*mesh.looks);
  return bytes;
}

void saveValue(ArchiveWriter& to, const TriMesh& mesh) {
  to.array(mesh.positions);
  to.array(mesh.triangles);
  to.array(mesh.normals);
  putList(to, mesh.uvSets, [&](const TriMesh::UvSet& set) {
    to.text(set.name);
    to.array(set.uv);
  });
  putList(to, mesh.colorSets, [&](const TriMesh::ColorSet& set) {
    to.text(set.name);
    to.array(set.rgba);
  });
  putList(to, mesh.materials, [&](const std::string& name) { to.text(name); });
  to.array(mesh.materialOf);
  putBits(to, mesh.frame);
  to.text(mesh.source);
  to.text(mesh.piece);
  to.part(mesh.looks);
}

namespace {

bool isSound(const TriMesh& mesh) {
  const std::size_t corners = mesh.cornerCount();
  bool sound = allInRange(mesh.triangles, 0, mesh.positions.size()) &&
               (mesh.normals.empty() || mesh.normals.size() == corners) &&
               (mesh.materialOf.empty() || mesh.materialOf.size() == mesh.triangles.size()) &&
               allInRange(mesh.materialOf, 0, mesh.materials.size());
  for (const auto& set : mesh.uvSets) sound = sound && set.uv.size() == corners;
  for (const auto& set : mesh.colorSets) sound = sound && set.rgba.size() == corners;
  return sound;
}

}  // namespace

std::optional<TriMesh> loadValue(ArchiveReader& from, std::type_identity<TriMesh>) {
  std::optional<TriMesh> loaded(std::in_place);
  TriMesh& mesh = *loaded;
  from.array(mesh.positions);
  from.array(mesh.triangles);
  from.array(mesh.normals);
  getList(from, mesh.uvSets, [&](TriMesh::UvSet& set) {
    set.name = from.text();
    from.array(set.uv);
  });
  getList(from, mesh.colorSets, [&](TriMesh::ColorSet& set) {
    set.name = from.text();
    from.array(set.rgba);
  });
  getList(from, mesh.materials, [&](std::string& name) { name = from.text(); });
  from.array(mesh.materialOf);
  getBits(from, mesh.frame);
  mesh.source = from.text();
  mesh.piece = from.text();
  mesh.looks = from.part<SurfaceLooks>();
  if (!from.ok() || !isSound(mesh)) loaded.reset();
  return loaded;
}

}  // namespace sherd
