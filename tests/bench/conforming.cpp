#include "bench/conforming.h"

#include "geometry/level_set.h"
#include "support/tet_families.h"
#include "tetrahedralize/volume_mesher.h"

namespace sherd::bench {

Result<std::shared_ptr<const TetMesh>> conformingMesh(const TriMesh& surface, double edge, std::size_t step) {
  const Box box = boxOf(surface.positions);
  std::vector<Vec3> unit;
  for (const Vec3& p : surface.positions) unit.emplace_back((p - box.centre()) / box.diagonal());
  const double voxel = std::min(edge / 6, 1.0 / 250);
  const LevelSet distance(unit, surface.triangles, voxel, 4 * voxel, Exec{});
  VolumeToMesh volume;
  volume.field = distance.sampler();
  volume.edgeLength = [edge](const Vec3&) { return edge; };
  volume.facetDistance = [edge](const Vec3&) { return edge / 30; };
  volume.box = boxOf(unit);
  volume.box.add(volume.box.low - Vec3::Constant(2 * voxel));
  volume.box.add(volume.box.high + Vec3::Constant(2 * voxel));
  volume.precision = voxel / 100;
  for (std::size_t i = 0; i < unit.size(); i += step) volume.seeds.push_back(unit[i]);
  SHERD_ASSIGN(VolumeMesh mesh, VolumeMesh::refine(volume, Exec{}));
  SHERD_CHECK(mesh.removeSlivers(
      8, 8, [](const Tetrahedra&) { return true; }, Exec{}));
  Tetrahedra tets = mesh.extract();
  for (Vec3& p : tets.nodes) p = box.centre() + box.diagonal() * p;
  return families::shared(families::withOwnSurface(std::move(tets.nodes), std::move(tets.tets)));
}

}  // namespace sherd::bench
