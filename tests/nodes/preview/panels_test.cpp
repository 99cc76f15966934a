// What the panels beside the pieces show: painted fields on the surface, cells and energy on the tetrahedra.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include "base/rng.h"
#include "preview/cage_soups.h"
#include "preview/field_soup.h"
#include "preview/preview.h"
#include "support/fragment_families.h"
#include "support/tet_families.h"
#include "types/scalar_grid_vdb.h"

namespace sherd {
namespace {

/// 4 where x > `border`, 1 elsewhere, within a few metres of the origin; voxels of 2 cm.
ScalarGrid twoHalves(double border) {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(1.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.02));
  const int first = static_cast<int>(std::lround(border / 0.02)) + 1;
  grid->fill(openvdb::CoordBBox(openvdb::Coord(first, -150, -150), openvdb::Coord(150, 150, 150)), 4.0f);
  return scalarGridOf(grid, "beta", FileFrame{});
}

Vec3f corner(const Soup& soup, std::size_t triangle, std::size_t c) { return soup.corners[3 * triangle + c]; }

/// m², of the triangles that `wanted` wants.
template <class Wanted>
double areaOf(const Soup& soup, const PictureSpace& space, const Wanted& wanted) {
  double sum = 0;
  for (std::size_t t = 0; t < soup.corners.size() / 3; ++t) {
    if (!wanted(t)) continue;
    const Vec3f a = corner(soup, t, 0);
    sum += 0.5 * static_cast<double>((corner(soup, t, 1) - a).cross(corner(soup, t, 2) - a).norm());
  }
  return sum * space.size * space.size;
}
double areaOf(const Soup& soup, const PictureSpace& space) {
  return areaOf(soup, space, [](std::size_t) { return true; });
}

Vec3 placeOf(const Vec3f& corner, const PictureSpace& space) {
  return corner.cast<double>() * space.size + space.centre;
}

TEST(FieldSoup, TwoHalvesHaveTwoColoursOnAModelOfTwelveTriangles) {
  const TriMesh box = test::boxMesh(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const PictureSpace space = PictureSpace::of(box);
  const auto field = fieldSoup(box, shadingNormals(box), twoHalves(0.3), space);
  ASSERT_TRUE(field.ok()) << field.error().text();
  EXPECT_EQ(field->scale.low, 1);
  EXPECT_EQ(field->scale.high, 4);
  EXPECT_NEAR(areaOf(field->soup, space), 24, 1e-4);
  ASSERT_EQ(field->soup.values.size(), field->soup.corners.size());
  ASSERT_EQ(field->soup.normals.size(), field->soup.corners.size());
  for (std::size_t i = 0; i < field->soup.corners.size(); ++i) {
    const double x = placeOf(field->soup.corners[i], space).x();
    if (std::abs(x - 0.31) > 0.011) {
      EXPECT_EQ(field->soup.values[i], x > 0.3 ? 1.f : 0.f) << x;
    }
  }
  EXPECT_GT((energyColour(1) - energyColour(0)).norm(), 0.5f);
}

TEST(FieldSoup, OneValueIsSaidAndNoneRefused) {
  const TriMesh box = test::boxMesh(Vec3::Zero(), Vec3::Ones());
  const auto one = fieldSoup(box, shadingNormals(box), ScalarGrid::constant(2), PictureSpace::of(box));
  ASSERT_TRUE(one.ok());
  EXPECT_TRUE(one->scale.isOne());
  EXPECT_EQ(one->scale.low, 2);
  EXPECT_TRUE(one->soup.values.empty());
  ASSERT_EQ(one->soup.paint.size(), one->soup.corners.size() / 3);
  ASSERT_EQ(one->soup.palette.size(), 1u);
  EXPECT_LT(one->soup.palette[0].maxCoeff() - one->soup.palette[0].minCoeff(), 0.06f) << "a grey";
  const auto none = fieldSoup(box, shadingNormals(box), ScalarGrid::constant(NAN), PictureSpace::of(box));
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().port, "beta");
}

/// Cells of sites in the tetrahedra themselves.
Partition cellsOf(std::shared_ptr<const TetMesh> tets, const std::vector<Vec3>& sites) {
  auto embedding = std::make_shared<Embedding>();
  embedding->tets = tets;
  embedding->coordinates.resize(3, static_cast<Eigen::Index>(tets->nodes.size()));
  Partition cells;
  cells.sites.resize(3, static_cast<Eigen::Index>(sites.size()));
  for (std::size_t j = 0; j < sites.size(); ++j) cells.sites.col(static_cast<Eigen::Index>(j)) = sites[j];
  for (std::size_t n = 0; n < tets->nodes.size(); ++n) {
    embedding->coordinates.col(static_cast<Eigen::Index>(n)) = tets->nodes[n];
    std::size_t nearest = 0;
    for (std::size_t j = 1; j < sites.size(); ++j)
      if ((tets->nodes[n] - sites[j]).norm() < (tets->nodes[n] - sites[nearest]).norm()) nearest = j;
    cells.label.push_back(static_cast<Index>(nearest));
  }
  cells.embedding = std::move(embedding);
  return cells;
}

std::shared_ptr<const TetMesh> beam() { return families::shared(families::box(8, 4, 4, Vec3(1, 0.5, 0.5))); }

TEST(CellsSoup, TwoCellsShareTheFacesByTheirBisector) {
  const Partition cells =
      cellsOf(beam(), {Vec3(0.2, 0.25, 0.25), Vec3(0.7, 0.25, 0.25)});  // meet at x = 0.45
  const PictureSpace space = PictureSpace::of(*cells.embedding->tets->surface);
  const Soup soup = cellsSoup(cells, {}, space);
  const auto painted = [&](Index cell) {
    return areaOf(soup, space, [&](std::size_t t) { return soup.paint[t] == cell; });
  };
  EXPECT_NEAR(painted(0), 0.25 + 4 * 0.45 * 0.5, 1e-6);
  EXPECT_NEAR(painted(1), 0.25 + 4 * 0.55 * 0.5, 1e-6);
  EXPECT_EQ(soup.palette.size(), 2u);
  EXPECT_NE(soup.palette[0], soup.palette[1]);
  for (std::size_t t = 0; t < soup.paint.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const double x = placeOf(corner(soup, t, c), space).x();
      EXPECT_TRUE(soup.paint[t] == 0 ? x < 0.45 + 1e-6 : x > 0.45 - 1e-6) << x;
    }
}

TEST(CellsSoup, ASliceTakesAwayWhatLiesBeyondAndShowsTheSection) {
  const Partition cells = cellsOf(beam(), {Vec3(0.2, 0.25, 0.25), Vec3(0.7, 0.25, 0.25)});
  const PictureSpace space = PictureSpace::of(*cells.embedding->tets->surface);
  for (const double z : {0.3, 0.25, 0.01}) {  // at 0.25 there are nodes
    const Soup soup = cellsSoup(cells, SlicePlane{2, z}, space);
    const auto isSection = [&](std::size_t t) {
      for (std::size_t c = 0; c < 3; ++c)
        if (placeOf(corner(soup, t, c), space).z() < z - 1e-6) return false;
      return true;
    };
    EXPECT_NEAR(areaOf(soup, space, isSection), 0.5, 1e-6) << z;
    EXPECT_NEAR(areaOf(soup, space, [&](auto t) { return isSection(t) && soup.paint[t] == 0; }), 0.225, 1e-6);
    EXPECT_NEAR(areaOf(soup, space), 0.5 + 0.5 + 3 * z, 1e-6) << z;
    for (const Vec3f& p : soup.corners) ASSERT_LT(placeOf(p, space).z(), z + 1e-6);
  }
}

TEST(CellsSoup, ASectionThroughAVoidHasAHole) {
  const auto hollow = families::shared(families::hollowBox(6, 2, 0.1));
  const Partition cells = cellsOf(hollow, {Vec3(0.3, 0.3, 0.3)});
  const PictureSpace space = PictureSpace::of(*hollow->surface);
  for (int axis = 0; axis < 3; ++axis) {
    const Soup soup = cellsSoup(cells, SlicePlane{axis, 0.27}, space);
    const double section = areaOf(soup, space, [&](std::size_t t) {
      for (std::size_t c = 0; c < 3; ++c)
        if (placeOf(corner(soup, t, c), space)[axis] < 0.27 - 1e-6) return false;
      return true;
    });
    EXPECT_NEAR(section, 0.36 - 0.04, 1e-6);
  }
}

TEST(CellsSoup, ASectionsCellsAreTheNearestSites) {
  const Rng random(5, 1);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    std::vector<Vec3> sites;
    for (std::uint64_t j = 0; j < 6; ++j)
      sites.emplace_back(random.uniformAt(30 * seed + 3 * j), 0.5 * random.uniformAt(30 * seed + 3 * j + 1),
                         0.5 * random.uniformAt(30 * seed + 3 * j + 2));
    const Partition cells = cellsOf(families::shared(families::box(16, 8, 8, Vec3(1, 0.5, 0.5))), sites);
    const PictureSpace space = PictureSpace::of(*cells.embedding->tets->surface);
    const Soup soup = cellsSoup(cells, SlicePlane{1, 0.23}, space);
    double wrong = 0;
    for (std::size_t t = 0; t < soup.paint.size(); ++t) {
      const Vec3 centre = placeOf((corner(soup, t, 0) + corner(soup, t, 1) + corner(soup, t, 2)) / 3, space);
      std::size_t nearest = 0;
      for (std::size_t j = 1; j < sites.size(); ++j)
        if ((centre - sites[j]).norm() < (centre - sites[nearest]).norm()) nearest = j;
      if (soup.paint[t] != static_cast<Index>(nearest))
        wrong += areaOf(soup, space, [&](std::size_t other) { return other == t; });
    }
    EXPECT_LT(wrong, 0.01 * areaOf(soup, space)) << seed;  // sites that win at no corner are not seen
  }
}

TEST(EnergySoup, IsLinearOnTheSection) {
  EnergyField energy;
  energy.tets = beam();
  const std::vector<double> volumes = lumpedVolumes(*energy.tets);
  const auto density = [](const Vec3& p) { return 1 + 9 * p.x() + 2 * p.z(); };
  for (std::size_t n = 0; n < volumes.size(); ++n)
    energy.nodeEnergy.push_back(volumes[n] * density(energy.tets->nodes[n]));
  const EnergyScale scale{1, 11};
  const PictureSpace space = PictureSpace::of(*energy.tets->surface);
  const Soup soup = energySoup(energy, scale, SlicePlane{1, 0.3}, space);
  ASSERT_EQ(soup.values.size(), soup.corners.size());
  EXPECT_NEAR(areaOf(soup, space), 2 * 0.5 + 2 * (1 + 0.5) * 0.3, 1e-6);
  for (std::size_t i = 0; i < soup.values.size(); ++i)
    EXPECT_NEAR(soup.values[i], scale.place(density(placeOf(soup.corners[i], space))), 1e-5f);
}

// The pictures.

PreviewParams small() {
  PreviewParams params;
  params.width = 400;
  params.height = 96;
  params.samples = 2;
  return params;
}

Picture mustRender(const PreviewInput& input, const PreviewParams& params) {
  auto picture = renderPreview(input, params, Exec{});
  EXPECT_TRUE(picture.ok()) << (picture.ok() ? "" : picture.error().text());
  return picture.ok() ? std::move(*picture) : Picture{};
}

/// Mean brightness of what is coloured in columns [begin, end).
double brightness(const Picture& picture, int begin, int end) {
  double sum = 0, count = 0;
  for (int y = 16; y < 70; ++y)  // above the legend
    for (int x = begin; x < end; ++x) {
      const std::uint8_t* p = &picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x)];
      const auto [low, high] = std::minmax({p[0], p[1], p[2]});
      if (high - low < 40) continue;
      sum += 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
      count += 1;
    }
  EXPECT_GT(count, 20) << begin;
  return sum / count;
}

/// Pixels of a strong colour in columns [begin, end).
std::size_t colouredIn(const Picture& picture, int begin, int end) {
  std::size_t count = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = begin; x < end; ++x) {
      const std::uint8_t* p = &picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x)];
      const auto [low, high] = std::minmax({p[0], p[1], p[2]});
      count += high - low >= 40;
    }
  return count;
}

TEST(PreviewPanels, BetaOfTwoHalvesIsDarkOnOneSideAndBrightOnTheOther) {
  const Fragments f = test::slices(test::boxMesh(Vec3(-1, -0.5, -0.5), Vec3(1, 0.5, 0.5)), {0.1});
  const ScalarGrid halves = twoHalves(0), one = ScalarGrid::constant(1);
  const Picture two = mustRender({.pieces = &f, .beta = &halves}, small()),
                same = mustRender({.pieces = &f, .beta = &one}, small());
  const int left = 400 * 2 / 3, middle = left + 67;
  EXPECT_GT(brightness(two, middle + 15, 400), brightness(two, left, middle - 15) + 60);
  EXPECT_EQ(colouredIn(same, left, 400), 0u) << "one value has no colour of the scale";
  EXPECT_GT(colouredIn(two, left, 400), 500u);
}

TEST(PreviewPanels, OneFragilityStandsInTheLegend) {
  const Fragments f = test::slicedBox(2);
  const ScalarGrid one = ScalarGrid::constant(1), four = ScalarGrid::constant(4);
  const Picture low = mustRender({.pieces = &f, .beta = &one}, small()),
                high = mustRender({.pieces = &f, .beta = &four}, small());
  ASSERT_EQ(low.rgb.size(), high.rgb.size());
  std::size_t differing = 0;
  for (std::size_t i = 0; i < low.rgb.size(); ++i) {
    if (low.rgb[i] == high.rgb[i]) continue;
    ++differing;
    EXPECT_GT(static_cast<int>(i / 3) / low.width, 70) << "above the legend";
    if (differing > 300) break;
  }
  EXPECT_GT(differing, 5u);
}

TEST(PreviewPanels, EachHasItsPlaceAndTheSliceItsOwn) {
  const Fragments f = test::slices(test::boxMesh(Vec3::Zero(), Vec3(1, 0.5, 0.5)), {0.45});
  const Partition cells = cellsOf(beam(), {Vec3(0.2, 0.25, 0.25), Vec3(0.7, 0.25, 0.25)});
  PreviewParams params = small();
  const Picture plain = mustRender({.pieces = &f}, params);
  EXPECT_EQ(plain.rgb, renderPreview(f, nullptr, params, Exec{})->rgb);
  const Picture whole = mustRender({.pieces = &f, .cells = &cells}, params);
  EXPECT_NE(whole.rgb, plain.rgb);
  params.slice = Slice::Z;
  const Picture open = mustRender({.pieces = &f, .cells = &cells}, params);
  EXPECT_NE(open.rgb, whole.rgb);
  params.sliceAt = 0.2;
  EXPECT_NE(mustRender({.pieces = &f, .cells = &cells}, params).rgb, open.rgb);
  // Left of the cells' panel nothing has changed but for the frame's last column.
  for (int y = 0; y < params.height; ++y)
    for (int x = 0; x < 400 / 3 - 1; ++x) {
      const std::size_t i = 3 * static_cast<std::size_t>(y * params.width + x);
      ASSERT_EQ(open.rgb[i], whole.rgb[i]) << x << ' ' << y;
    }
}

TEST(PreviewPanels, RefusesWhatItCannotShow) {
  const Fragments f = test::slicedBox(2);
  const auto portOf = [&](const PreviewInput& input, const PreviewParams& params) {
    const auto picture = renderPreview(input, params, Exec{});
    return picture.ok() ? std::string("ok") : picture.error().port;
  };
  PreviewParams params = small();
  EXPECT_EQ(portOf({}, params), "pieces");
  const Partition none;
  EXPECT_EQ(portOf({.pieces = &f, .cells = &none}, params), "cells");
  const ScalarGrid undefined = ScalarGrid::constant(NAN);
  EXPECT_EQ(portOf({.pieces = &f, .beta = &undefined}, params), "beta");
  params.slice = Slice::X;
  EXPECT_EQ(portOf({.pieces = &f}, params), "slice");
  const Partition cells = cellsOf(beam(), {Vec3(0.2, 0.25, 0.25)});
  EXPECT_EQ(portOf({.pieces = &f, .cells = &cells}, params), "ok");
  for (const double wrong : {-0.1, 1.1, double(NAN)}) {
    params.sliceAt = wrong;
    EXPECT_EQ(portOf({.pieces = &f, .cells = &cells}, params), "slice_at");
  }
}

}  // namespace
}  // namespace sherd
