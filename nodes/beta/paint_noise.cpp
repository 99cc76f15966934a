#include "base/parallel.h"
#include "beta/layers.h"
#include "geometry/surface_tree.h"
#include "geometry/value_noise.h"

namespace sherd {
namespace {

/// Blocks that the mesh's solid touches.
Blocks blocksOfSolid(const TriMesh& mesh, const Lattice& lattice, const Exec& exec) {
  const SurfaceTree surface(mesh.positions, mesh.triangles);
  const Box index = lattice.indexBox(boxOf(mesh.positions));
  Blocks blocks;
  blocks.add(index.low, index.high, [&](const openvdb::Coord& origin) {
    if (exec.cancelled()) return false;
    const Vec3 centre = lattice.blockCentre(origin);
    return surface.closest(centre).distance <= lattice.blockRadius() || surface.contains(centre);
  });
  return blocks;
}

}  // namespace

Result<void> paintNoise(Canvas& canvas, const TriMesh* mesh, const PaintBetaParams& params, double noiseSize,
                        const Exec& exec) {
  const Lattice lattice = canvas.lattice();
  Blocks blocks;
  if (mesh != nullptr)
    blocks = blocksOfSolid(*mesh, lattice, exec);
  else
    blocks.addActive(canvas.grid->tree());
  const ValueNoise noise(static_cast<std::uint64_t>(params.seed), noiseSize);
  const auto noiseIn = [&](const openvdb::Coord&) -> Canvas::Edit {
    return [&](const openvdb::Coord& c, double value, bool isOn) -> std::optional<double> {
      if (mesh == nullptr && !isOn) return std::nullopt;
      const double share = noise.at(lattice.metres(c));
      return blended(params.blend, value, params.low + share * (params.high - params.low));
    };
  };
  return canvas.edit(blocks, noiseIn, exec);
}

}  // namespace sherd
