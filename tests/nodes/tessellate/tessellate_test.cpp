#include "tessellate/tessellate.h"

#include <gtest/gtest.h>

#include <set>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "geometry/solid.h"
#include "graph/node_type.h"
#include "support/promises.h"
#include "support/said.h"
#include "support/surface_families.h"

namespace sherd {
NodeType tessellateNode();
namespace {

/// Nearest-site cells in space itself.
Partition partitionBySites(std::shared_ptr<const TetMesh> tets, const std::vector<Vec3>& sites) {
  auto embedding = std::make_shared<Embedding>();
  embedding->tets = tets;
  embedding->coordinates.resize(3, static_cast<Eigen::Index>(tets->nodes.size()));
  for (std::size_t n = 0; n < tets->nodes.size(); ++n)
    embedding->coordinates.col(static_cast<Eigen::Index>(n)) = tets->nodes[n];
  embedding->diameter = boxOf(tets->nodes).diagonal();
  Partition cells;
  cells.embedding = embedding;
  cells.sites.resize(3, static_cast<Eigen::Index>(sites.size()));
  for (std::size_t s = 0; s < sites.size(); ++s) cells.sites.col(static_cast<Eigen::Index>(s)) = sites[s];
  for (const Vec3& node : tets->nodes) {
    std::size_t best = 0;
    for (std::size_t s = 1; s < sites.size(); ++s)
      if ((node - sites[s]).squaredNorm() < (node - sites[best]).squaredNorm()) best = s;
    cells.label.push_back(static_cast<Index>(best));
  }
  return cells;
}

std::vector<Vec3> randomSites(const TetMesh& tets, std::size_t count, std::uint64_t seed) {
  const Box box = boxOf(tets.surface->positions);
  Rng rng(seed);
  std::vector<Vec3> sites;
  for (std::size_t i = 0; i < count; ++i)
    sites.push_back(box.low +
                    Vec3(rng.uniform(), rng.uniform(), rng.uniform()).cwiseProduct(box.high - box.low));
  return sites;
}

Fragments breakAt(std::shared_ptr<const TetMesh> tets, const std::vector<Vec3>& sites,
                  double minVolume = 1e-5) {
  const auto result = tessellate(partitionBySites(std::move(tets), sites), {.minVolume = minVolume}, Exec{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
  return result.ok() ? *result : Fragments{};
}

Digest digestOf(const Fragments& f) {
  Hasher hasher;
  hashValue(hasher, f);
  return hasher.digest();
}

TEST(Tessellate, ACellThatIsNearestAtNoNodeIsThere) {
  // One cube of six tetrahedra as cage, 60 sites within the box inside of it: hardly any is nearest at a
  // node.
  const auto tets = families::cagedInBlock(families::boxSurface(Vec3(-1, -1, -1), Vec3(1, 1, 1), 3, 3, 3), 1);
  const std::vector<Vec3> sites = randomSites(*tets, 60, 11);
  const Fragments f = breakAt(tets, sites, 0);
  expectPromises(f);
  EXPECT_EQ(f.pieces.size(), 60u);
  EXPECT_EQ(f.counts.emptyCells, 0u);
  // Each piece is a convex cell that holds its site, and whose corners are no nearer to any other.
  for (const Piece& piece : f.pieces)
    for (const Triangle& t : piece.crack)
      for (const Index v : t) {
        const Vec3& x = f.positions[at(v)];
        const double own = (x - sites[at(piece.cell)]).norm();
        for (const Vec3& other : sites) EXPECT_GE((x - other).norm(), own - 1e-12);
      }
}

TEST(Tessellate, SlabsHaveTheirVolumes) {
  const auto tets = families::cagedInBlock(families::boxSurface(Vec3(-1, -1, -1), Vec3(1, 1, 1), 5, 4, 3), 4);
  const std::vector<double> at{-0.95, -0.6, -0.55, 0.1, 0.8, 0.81};
  std::vector<Vec3> sites;
  for (const double x : at) sites.emplace_back(x, 0.3, -0.2);
  const Fragments f = breakAt(tets, sites, 0);
  expectPromises(f);
  ASSERT_EQ(f.pieces.size(), at.size());
  for (const Piece& piece : f.pieces) {
    const std::size_t s = static_cast<std::size_t>(piece.cell);
    const double low = s == 0 ? -1 : (at[s - 1] + at[s]) / 2,
                 high = s + 1 == at.size() ? 1 : (at[s] + at[s + 1]) / 2;
    EXPECT_NEAR(piece.volume, 4 * (high - low), 1e-12);
  }
}

TEST(Tessellate, CoincidentSitesLeaveOneOfThemEmpty) {
  const auto tets = families::cagedInBlock(families::sphereSurface(Vec3::Zero(), 1, 24, 12), 3);
  const Vec3 a(0.4, 0.1, 0), b(-0.3, 0, 0.2);
  const Fragments f = breakAt(tets, {a, b, a, a});
  expectPromises(f);
  EXPECT_EQ(f.pieces.size(), 2u);
  EXPECT_EQ(f.counts.emptyCells, 2u);
}

TEST(Tessellate, SitesEquallyFarFromAWholeLine) {
  // Any number of cells around one axis, which runs through nodes and along edges of the cage.
  for (const int n : {3, 4, 5, 8, 13}) {
    const auto tets =
        families::cagedInBlock(families::boxSurface(Vec3(-1, -1, -1), Vec3(1, 1, 1), 2, 2, 2), 4);
    std::vector<Vec3> sites;
    for (int i = 0; i < n; ++i)
      sites.emplace_back(0.5 * std::cos(2 * M_PI * i / n), 0.5 * std::sin(2 * M_PI * i / n), 0);
    const Fragments f = breakAt(tets, sites);
    EXPECT_EQ(f.pieces.size(), static_cast<std::size_t>(n));
    expectPromises(f);
  }
}

TEST(Tessellate, CanonicalCellsKeepEveryPromise) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto tets =
        families::cagedInBlock(seed % 2 == 0 ? families::torusSurface(1, 0.35, 30, 14)
                                             : families::sphereSurface(Vec3(1, 2, 3), 1, 30, 15),
                               4 + static_cast<int>(seed % 4));
    const auto f = tessellate(partitionBySites(tets, randomSites(*tets, 3 + 4 * seed, seed)),
                              {.cells = CellMode::Canonical}, Exec{});
    SCOPED_TRACE(seed);
    ASSERT_TRUE(f.ok()) << f.error().text();
    expectPromises(*f);
  }
}

TEST(Tessellate, ConformingPiecesAreThoseOfTheCage) {
  for (const CellMode mode : {CellMode::Exact, CellMode::Canonical}) {
    const TetMesh u = families::uShape(1, 2, 4, 1, 0.25);
    const auto tets = families::shared(u);
    const auto f = tessellate(partitionBySites(tets, randomSites(*tets, 9, 6)),
                              {.cells = mode, .surface = SurfaceMode::Conforming, .minVolume = 0}, Exec{});
    ASSERT_TRUE(f.ok()) << f.error().text();
    expectPromises(*f);
    EXPECT_GE(f->pieces.size(), 6u);
    EXPECT_NEAR(solidVolume(f->tets->surface->positions, f->tets->surface->triangles), u.quality.cageVolume,
                1e-12);
  }
}

TEST(Tessellate, OneCellIsTheUntouchedSurface) {
  const auto tets = families::cagedInBlock(families::sphereSurface(Vec3::Zero(), 1, 24, 12), 3);
  const Fragments f = breakAt(tets, {Vec3::Zero()});
  ASSERT_EQ(f.pieces.size(), 1u);
  const Piece& piece = f.pieces[0];
  for (std::size_t t = 0; t < piece.surface.size(); ++t)
    EXPECT_EQ(piece.surface[t], tets->surface->triangles[at(piece.surfaceSource[t])]);
  EXPECT_EQ(std::set<Index>(piece.surfaceSource.begin(), piece.surfaceSource.end()).size(),
            tets->surface->triangles.size());
  EXPECT_EQ(piece.surface.size(), tets->surface->triangles.size());
  EXPECT_TRUE(piece.crack.empty());
  EXPECT_EQ(f.positions, tets->surface->positions);
  EXPECT_EQ(f.counts.cutTets, 0u);
}

TEST(Tessellate, WhatPiecesSayOfThemselvesIsWhatTheirTrianglesSay) {
  const auto tets = families::cagedInBlock(families::torusSurface(3, 1, 60, 30), 6);
  // Cells of all sizes: a few sites far apart, and a cluster that leaves pieces of a millionth of the body.
  std::vector<Vec3> sites = randomSites(*tets, 12, 5);
  for (int i = 0; i < 8; ++i)
    sites.push_back(Vec3(3, 0.99, 0) + 0.01 * Vec3(i % 2, (i / 2) % 2, i / 4) + 0.001 * Vec3(i, -i, i * i));
  const auto f = tessellate(partitionBySites(tets, sites), {.minVolume = 0}, Exec{});
  ASSERT_TRUE(f.ok()) << f.error().text();
  double least = 1e300;
  for (const Piece& piece : f->pieces) {
    const std::span<const Triangle> lists[] = {piece.surface, piece.crack};
    const SolidIntegrals own = integrateSolid(f->positions, lists);
    EXPECT_NEAR(piece.volume, own.volume, 1e-10 * own.volume) << piece.name;
    EXPECT_LT((piece.centreOfMass - own.centroid).norm(), 1e-10 * std::cbrt(own.volume)) << piece.name;
    const Mat3 inertia = own.inertia(Material{}.density);
    EXPECT_LT((piece.inertia - inertia).norm(), 1e-8 * inertia.norm()) << piece.name;
    least = std::min(least, own.volume);
  }
  EXPECT_LT(least, 1e-5 * f->pieces.front().volume);
}

TEST(Tessellate, TwoCellsHalveABox) {
  const auto tets = families::cagedInBlock(families::boxSurface(Vec3(-1, -1, -1), Vec3(1, 1, 1), 4, 4, 4), 5);
  const Fragments f = breakAt(tets, {Vec3(-0.5, 0.1, 0), Vec3(0.5, 0.1, 0)});
  ASSERT_EQ(f.pieces.size(), 2u);
  expectPromises(f);
  // The bisector is the plane x = 0, which the schemes reproduce since distances are affine along tetrahedral
  // edges.
  EXPECT_NEAR(f.pieces[0].volume, 4, 1e-9);
  EXPECT_NEAR(f.pieces[1].volume, 4, 1e-9);
  double contact = 0;
  for (const Triangle& t : f.pieces[0].crack) {
    for (const Index v : t) EXPECT_NEAR(f.positions[at(v)].x(), 0, 1e-12);
    contact += 0.5 * (f.positions[at(t[1])] - f.positions[at(t[0])])
                         .cross(f.positions[at(t[2])] - f.positions[at(t[0])])
                         .norm();
  }
  EXPECT_NEAR(contact, 4, 1e-9);
  EXPECT_NEAR(f.pieces[0].centreOfMass.norm(), 0.5, 1e-9);
}

TEST(Tessellate, SheetsThroughVerticesEdgesAndCoplanarFacesOfTheSurface) {
  // The surface's grid and the cage's grid have sheets of symmetric sites run exactly through them.
  for (const int n : {2, 3, 4, 6}) {
    const auto tets =
        families::cagedInBlock(families::boxSurface(Vec3(-1, -1, -1), Vec3(1, 1, 1), 4, 4, 4), n);
    std::vector<Vec3> sites;
    for (int i = 0; i < 8; ++i)
      sites.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    const Fragments f = breakAt(tets, sites);
    EXPECT_GE(f.pieces.size(), 8u) << n;
    expectPromises(f);
  }
}

TEST(Tessellate, SheetInThePlaneOfASurfaceFace) {
  // An L-shaped body would be simplest; here two sites put the sheet into the plane of the box's side x = 1.
  const TriMesh box = families::boxSurface(Vec3(-1, -1, -1), Vec3(1, 1, 1), 2, 2, 2);
  const auto tets = families::cagedInBlock(box, 4);
  const Fragments f = breakAt(tets, {Vec3(0.5, 0, 0), Vec3(1.5, 0, 0)}, 1e-9);
  expectPromises(f);
  EXPECT_NEAR(f.pieces[0].volume, 8, 1e-9);
}

TEST(Tessellate, AVoidStaysAVoid) {
  TriMesh shell = families::joined(families::sphereSurface(Vec3::Zero(), 1, 32, 16),
                                   families::reversed(families::sphereSurface(Vec3(0.1, 0, 0), 0.4, 16, 8)));
  const auto tets = families::cagedInBlock(shell, 6);
  // One cell's corner cuts off a cap, so that the other piece keeps the whole void.
  const Fragments f = breakAt(tets, {Vec3::Zero(), Vec3(0, 1.7, 0)});
  ASSERT_EQ(f.pieces.size(), 2u);
  expectPromises(f);
  const Fragments through = breakAt(tets, {Vec3(-0.4, 0.01, 0), Vec3(0.6, 0.01, 0.02), Vec3(0, 0.5, 0.5)});
  expectPromises(through);
}

TEST(Tessellate, SmallCellInsideIsAPieceWithinAVoid) {
  const auto tets = families::cagedInBlock(families::sphereSurface(Vec3::Zero(), 1, 32, 16), 9);
  std::vector<Vec3> sites{Vec3(0.01, 0.02, 0.03)};
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
    sites.insert(sites.end(), {0.9 * d, -0.9 * d});
  const Fragments f = breakAt(tets, sites);
  EXPECT_EQ(f.pieces.size(), 7u);
  expectPromises(f);
}

TEST(Tessellate, DetachedPartsArePiecesOfTheirOwn) {
  // A cell that holds both arms of a U, but not its bridge.
  const TetMesh u = families::uShape(1, 2, 4, 1, 0.25);
  const auto tets = families::cagedInBlock(*u.surface, 8);
  const Fragments f = breakAt(tets, {Vec3(0.5, 2.0, 0.125), Vec3(0.5, -0.9, 0.125)});
  expectPromises(f);
  EXPECT_EQ(f.pieces.size(), 3u);
  EXPECT_EQ(f.counts.detachedParts, 1u);
}

TEST(Tessellate, SmallPartsJoinTheNeighbourThatTheyTouchMost) {
  const auto tets = families::cagedInBlock(families::sphereSurface(Vec3::Zero(), 1, 32, 16), 6);
  const std::vector<Vec3> sites = randomSites(*tets, 20, 3);
  const Fragments all = breakAt(tets, sites, 0), merged = breakAt(tets, sites, 0.05);
  expectPromises(all);
  expectPromises(merged);
  EXPECT_LT(merged.pieces.size(), all.pieces.size());
  EXPECT_EQ(merged.pieces.size() + merged.counts.mergedParts, all.pieces.size());
  for (const Piece& p : merged.pieces) EXPECT_GE(p.volume, 0.05 * 4.0);
}

TEST(TessellateNode, SaysHowManyPartsWereMergedAndWhy) {
  const auto tets = families::cagedInBlock(families::sphereSurface(Vec3::Zero(), 1, 32, 16), 6);
  const auto saidOf = [&](std::size_t sites, const char* bound, double value, Said& said) {
    const NodeType type = tessellateNode();
    ParamValues params;
    for (const ParamInfo& p : type.params) params[p.name] = p.fallback;
    params[bound] = value;
    NodeIo io(said.exec);
    io.setInput("cells", Value::of<Partition>(std::make_shared<const Partition>(
                             partitionBySites(tets, randomSites(*tets, sites, 3)))));
    EXPECT_TRUE(type.run(params, io).ok());
    return io.output("pieces").as<Fragments>();
  };
  Said all, absolute, some, none;
  EXPECT_EQ(saidOf(12, "min_volume", 0.5, all)->pieces.size(), 1u);
  EXPECT_TRUE(all.warning("11 parts of 12 cells were cut, and all merged into one again"))
      << all.lines[0].second;
  EXPECT_TRUE(all.warning("below min_volume = 0.5 (2.0"));
  EXPECT_EQ(saidOf(12, "min_volume_absolute", 3, absolute)->pieces.size(), 1u);
  EXPECT_TRUE(absolute.warning("below min_volume_absolute = 3 m³"));
  EXPECT_GT(saidOf(12, "min_volume", 0.05, some)->pieces.size(), 1u);
  EXPECT_TRUE(some.info("below min_volume = 0.05 (0.2")) << some.lines.back().second;
  EXPECT_EQ(saidOf(1, "min_volume", 0.5, none)->pieces.size(), 1u);
  EXPECT_TRUE(none.info("nothing was cut: the body stays one piece"));
}

TEST(Tessellate, SeveralComponentsAreSeveralPieces) {
  TriMesh two = families::joined(families::sphereSurface(Vec3(-2, 0, 0), 1, 16, 8),
                                 families::sphereSurface(Vec3(2, 0, 0), 1, 16, 8));
  const auto tets = families::cagedInBlock(two, 6);
  EXPECT_EQ(breakAt(tets, {Vec3::Zero()}).pieces.size(), 2u);
  const Fragments f = breakAt(tets, {Vec3(-2, 0.3, 0), Vec3(-2, -0.4, 0.1), Vec3(2, 0, 0)});
  EXPECT_EQ(f.pieces.size(), 3u);
  expectPromises(f);
}

TEST(Tessellate, AttributesOfCutTrianglesAreInterpolated) {
  TriMesh torus = families::torusSurface(1, 0.4, 24, 12);
  for (const Triangle& t : torus.triangles)
    for (const Index v : t)
      torus.normals.push_back(torus.positions[at(v)]);  // linear in place: exact to interpolate
  const auto tets = families::cagedInBlock(torus, 7);
  const Fragments f = breakAt(tets, randomSites(*tets, 12, 5));
  expectPromises(f);
  for (const Piece& p : f.pieces)
    for (std::size_t t = 0; t < p.surface.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_LT((cornerAttribute(f, p, t, c, torus.normals) - f.positions[at(p.surface[t][c])]).norm(),
                  1e-12);
}

TEST(Tessellate, RandomCellsKeepEveryPromise) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TriMesh surface = seed % 3 == 0 ? families::torusSurface(1, 0.35, 30, 14)
                            : seed % 3 == 1
                                ? families::sphereSurface(Vec3(10, -20, 5), 1, 30, 15)
                                : families::boxSurface(Vec3(0, 0, 0), Vec3(1, 0.6, 0.1), 10, 6, 2);
    const auto tets = families::cagedInBlock(surface, 4 + static_cast<int>(seed % 4));
    const Fragments f = breakAt(tets, randomSites(*tets, 3 + 4 * seed, seed));
    SCOPED_TRACE(seed);
    expectPromises(f);
  }
}

TEST(Tessellate, ScaleAndPlaceDoNotMatter) {
  const TriMesh unit = families::torusSurface(1, 0.4, 20, 10);
  for (const double scale : {1e-6, 1.0, 1e6})
    for (const double shift : {0.0, 1e3}) {
      TriMesh moved = unit;
      for (Vec3& p : moved.positions) p = scale * (p + Vec3::Constant(shift));
      const auto tets = families::cagedInBlock(moved, 5);
      SCOPED_TRACE(testing::Message() << scale << " " << shift);
      const Fragments f = breakAt(tets, randomSites(*tets, 10, 2));
      expectPromises(f);
      EXPECT_GE(f.pieces.size(), 10u);
    }
}

TEST(Tessellate, SameBitsForAnyNumberOfThreads) {
  const auto tets = families::cagedInBlock(families::torusSurface(1, 0.4, 60, 30), 8);
  const Partition cells = partitionBySites(tets, randomSites(*tets, 30, 9));
  std::vector<Digest> digests;
  for (const int threads : {1, 2, 4}) {
    setThreadLimit(threads);
    const auto f = tessellate(cells, {}, Exec{});
    ASSERT_TRUE(f.ok());
    digests.push_back(digestOf(*f));
  }
  setThreadLimit(0);
  EXPECT_EQ(digests[0], digests[1]);
  EXPECT_EQ(digests[0], digests[2]);
}

TEST(Tessellate, PermutingSitesPermutesNamesOnly) {
  const auto tets = families::cagedInBlock(families::torusSurface(1, 0.4, 24, 12), 6);
  std::vector<Vec3> sites = randomSites(*tets, 9, 4);
  const Fragments f = breakAt(tets, sites);
  std::reverse(sites.begin(), sites.end());
  const Fragments g = breakAt(tets, sites);
  ASSERT_EQ(f.pieces.size(), g.pieces.size());
  for (std::size_t i = 0; i < f.pieces.size(); ++i) {
    EXPECT_NEAR(f.pieces[i].volume, g.pieces[i].volume, 1e-12);
    EXPECT_LT((f.pieces[i].centreOfMass - g.pieces[i].centreOfMass).norm(), 1e-9);
  }
}

TEST(Tessellate, CancelledBeforeItBegins) {
  const auto tets = families::cagedInBlock(families::sphereSurface(Vec3::Zero(), 1, 24, 12), 3);
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto result = tessellate(partitionBySites(tets, {Vec3(0.5, 0, 0), Vec3(-0.5, 0, 0)}), {}, exec);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sherd
