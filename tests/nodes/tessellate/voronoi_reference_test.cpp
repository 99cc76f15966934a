// Cells in space against Voro++ (C. H. Rycroft, Chaos 19, 2009), clipped by convex bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "base/rng.h"
#include "support/nearest_cells.h"
#include "support/surface_families.h"
#include "tessellate/tessellate.h"

#ifdef SHERD_VOROPP
#include <voro++/voro++.hh>
#endif

namespace sherd::test {
namespace {

#ifdef SHERD_VOROPP
/// A body n · x ≤ c for all its planes.
struct ConvexBody {
  const char* name;
  TriMesh surface;
  std::vector<Vec4> planes;  ///< (n, c), besides those of the box
  Box box;                   ///< the body's, whose sides bound it as well
};

ConvexBody boxBody() {
  const Vec3 low(-1, -0.5, 0.25), high(1, 0.75, 2);
  ConvexBody body{"box", families::boxSurface(low, high, 8, 8, 8), {}, {}};
  body.box.add(low);
  body.box.add(high);
  return body;
}

/// A cube with one corner cut off by x + y + z ≤ 1.
ConvexBody cutCornerBody() {
  ConvexBody body;
  body.name = "cube with a corner cut off";
  // The plane runs through (1, 1, −1), (1, −1, 1) and (−1, 1, 1).
  body.surface.positions = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                            {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1}};
  body.surface.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {0, 4, 6},
                            {0, 6, 2}, {3, 5, 1}, {3, 2, 6}, {4, 5, 6}, {3, 6, 5}};
  body.planes = {Vec4(1, 1, 1, 1)};
  body.box = boxOf(body.surface.positions);
  return body;
}

std::vector<Vec3> sitesWithin(const ConvexBody& body, std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3> sites;
  while (sites.size() < count) {
    const Vec3 share(rng.uniform(), rng.uniform(), rng.uniform());
    const Vec3 p = body.box.low + share.cwiseProduct(body.box.high - body.box.low);
    const bool inside = std::all_of(body.planes.begin(), body.planes.end(),
                                    [&](const Vec4& plane) { return plane.head<3>().dot(p) < plane[3]; });
    if (inside) sites.push_back(p);
  }
  return sites;
}

std::vector<double> referenceVolumes(const ConvexBody& body, const std::vector<Vec3>& sites) {
  const Vec3 &low = body.box.low, &high = body.box.high;
  voro::container container(low.x(), high.x(), low.y(), high.y(), low.z(), high.z(), 6, 6, 6, false, false,
                            false, 16);
  std::vector<std::unique_ptr<voro::wall_plane>> walls;
  for (const Vec4& plane : body.planes) {
    walls.push_back(std::make_unique<voro::wall_plane>(plane[0], plane[1], plane[2], plane[3]));
    container.add_wall(*walls.back());
  }
  for (std::size_t s = 0; s < sites.size(); ++s)
    container.put(static_cast<int>(s), sites[s].x(), sites[s].y(), sites[s].z());
  std::vector<double> volumes(sites.size(), 0);
  voro::c_loop_all loop(container);
  voro::voronoicell cell;
  if (loop.start()) do {
      if (container.compute_cell(cell, loop)) volumes[static_cast<std::size_t>(loop.pid())] = cell.volume();
    } while (loop.inc());
  return volumes;
}

void expectReference(const ConvexBody& body, int cage, std::size_t count, std::uint64_t seed) {
  SCOPED_TRACE(testing::Message() << body.name << ", " << count << " sites, cage of " << cage
                                  << " cubes a side");
  const std::vector<Vec3> sites = sitesWithin(body, count, seed);
  TessellateParams params;
  params.cells = CellMode::Exact;
  params.minVolume = 0;
  const auto f =
      tessellate(euclideanCells(families::cagedInBlock(body.surface, cage), sites), params, Exec{});
  ASSERT_TRUE(f.ok()) << f.error().text();
  std::vector<double> volumes(count, 0);
  double whole = 0;
  for (const Piece& piece : f->pieces) {
    volumes[at(piece.cell)] += piece.volume;
    whole += piece.volume;
  }
  const std::vector<double> reference = referenceVolumes(body, sites);
  for (std::size_t s = 0; s < count; ++s) EXPECT_NEAR(volumes[s], reference[s], 1e-9 * whole) << s;
}

TEST(SlowVoronoiReference, ExactCellsHaveTheVolumesOfVoroPlusPlus) {
  for (const ConvexBody& body : {boxBody(), cutCornerBody()})
    for (const int cage : {1, 4, 9})
      for (const std::size_t count : {2u, 7u, 67u, 250u})
        expectReference(body, cage, count, 10 * count + static_cast<std::uint64_t>(cage));
}
#else
TEST(SlowVoronoiReference, ExactCellsHaveTheVolumesOfVoroPlusPlus) {
  GTEST_SKIP() << "Voro++ was absent when this was built; install voro++-dev and configure again";
}
#endif

}  // namespace
}  // namespace sherd::test
