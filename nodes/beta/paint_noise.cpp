#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "beta/layers.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

class ValueNoise {
 public:
  ValueNoise(std::uint64_t seed, double size) : rng_(seed), size_(size) {}

  /// In [0, 1).
  double at(const Vec3& metres) const {
    const Vec3 p = metres / size_, cell = p.array().floor();
    const Vec3 t = p - cell;
    const Vec3 s = (t.array().cube() * (10 + t.array() * (6 * t.array() - 15))).matrix();
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::uint64_t number = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const int high = corner >> axis & 1;
        weight *= high ? s[axis] : 1 - s[axis];
        // 21 bits an axis: it repeats after two million cells.
        const auto place = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[axis]) + high);
        number = number << 21 | (place & 0x1fffff);
      }
      value += weight * rng_.uniformAt(number);
    }
    return value;
  }

 private:
  Rng rng_;
  double size_;
};

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
