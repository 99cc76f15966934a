// Small bodies and sites that a cut along Voronoi cells goes wrong on where it can: seeded, each case a
// function of its number alone.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "types/partition.h"

namespace sherd::test {

struct AdversarialCase {
  std::string what;  ///< e.g. "thin plate, cage 4x4x4, grid of 8 sites, jitter 1e-12, moved"
  Partition cells;
  double minVolume = 1e-5;  ///< share of the body's volume
};

/// Bodies: boxes, thin plates, needles, tetrahedra, L and U shapes, hollow boxes, two boxes, spheres, tori;
/// on a dyadic grid, so that sheets, faces of the surface and faces of the cage coincide to the last bit, or
/// turned. Sites: random, on grids, in a plane, on a line, mirrored at faces, at one distance from a point,
/// at nodes of the cage, coincident; moved by 1e-3 … 1e-16 of the body's size. Metrics: Euclidean, folded,
/// flattened, constant, of one to five dimensions. Surfaces with slivers; cages with slivers. All of it times
/// 1e-6, 1 or 1e6, at the origin or 1e6 sizes from it.
AdversarialCase adversarialCase(std::uint64_t seed);

/// The same with `SurfaceMode::Conforming` in mind: the body's tetrahedra bound its surface themselves.
AdversarialCase conformingCase(std::uint64_t seed);

/// Nearest sites as labels, the lower index where two are equally near.
void labelByNearest(Partition& cells);

/// The same cells with site i renamed order[i].
Partition withSitesRenamed(const Partition& cells, const std::vector<Index>& order);

}  // namespace sherd::test
