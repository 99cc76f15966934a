#include "tessellate/tessellate.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/solid.h"
#include "tessellate/arrangement.h"
#include "tessellate/clip.h"
#include "tessellate/pieces.h"

namespace sherd {

Result<Fragments> tessellate(const Partition& cells, const TessellateParams& params, const Exec& exec) {
  const std::shared_ptr<const TetMesh>& tets = cells.embedding->tets;
  const TriMesh& surface = *tets->surface;
  const CrackComplex complex = canonicalCrackComplex(cells);
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.1);
  SHERD_ASSIGN(const Arrangement arrangement, arrange(*tets, cells.label, complex, exec));
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.5);
  const ClippedMeshes meshes = clip(arrangement, complex, exec);
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.8);
  const double volume = solidVolume(surface.positions, surface.triangles);
  Fragments result =
      assemblePieces(arrangement, meshes, params.minVolume * volume, cells.material.density, exec);
  if (exec.cancelled()) return cancelledError();
  result.tets = tets;
  result.material = cells.material;
  result.sites = cells.siteCount();
  result.energy = cells.energy;
  result.gamma = cells.gamma;
  result.degreeGiven = cells.degreeGiven;
  result.counts.cutTets = complex.cutTets;
  result.counts.crackTriangles = complex.triangles.size();
  result.counts.cutSurfaceTriangles = meshes.cutSurfaceTriangles;
  result.counts.forcedTriangles = meshes.forced;
  std::vector<bool> holds(cells.siteCount(), false);
  for (const SkinTriangle& t : meshes.skin) holds[at(t.cell)] = true;
  for (const SheetTriangle& t : meshes.sheet) holds[at(t.front)] = holds[at(t.back)] = true;
  result.counts.emptyCells = static_cast<std::size_t>(std::count(holds.begin(), holds.end(), false));
  return result;
}

}  // namespace sherd
