// An artist's β grid, from the file to the cells.
#include <gtest/gtest.h>

#include <filesystem>

#include "beta/read_vdb.h"
#include "cvd/cvd.h"
#include "embed/embed.h"
#include "predict_degree/predict_degree.h"
#include "support/tet_families.h"
#include "types/scalar_grid_vdb.h"
#include "weights/weights.h"

namespace sherd {
namespace {

/// β = 4 for x > 0.5 m, 1 elsewhere, voxels of 2 cm.
std::string writeHalfFragile() {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(1.0f);
  grid->setName("beta");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.02));
  grid->fill(openvdb::CoordBBox(openvdb::Coord(26, -10, -10), openvdb::Coord(70, 40, 40)), 4.0f);
  const std::string path = (std::filesystem::path(testing::TempDir()) / "sherd_half_fragile.vdb").string();
  openvdb::io::File(path).write({grid});
  return path;
}

TEST(Toughness, AFragileHalfBreaksIntoMorePieces) {
  ReadVdbParams read;
  read.file = writeHalfFragile();
  const auto beta = readVdb(read, Exec{});
  ASSERT_TRUE(beta.ok()) << beta.error().text();

  const auto tets = families::shared(families::box(20, 6, 6, Vec3(1, 0.3, 0.3)));
  EnergyField energy;
  energy.tets = tets;
  energy.tetEnergy.assign(tets->tets.size(), 1e-3);
  energy.nodeEnergy.assign(tets->nodes.size(), 0);
  for (const Tetra& t : tets->tets)
    for (const Index n : t) energy.nodeEnergy[at(n)] += 0.25e-3;
  const auto e = embed(tets, {}, Exec{});
  ASSERT_TRUE(e.ok());
  const auto shared = std::make_shared<const Embedding>(*e);

  auto share = [&](const ScalarGrid* field) {
    const auto w = weights(energy, field, {}, Exec{});
    EXPECT_TRUE(w.ok()) << (w.ok() ? "" : w.error().text());
    PredictDegreeParams search;
    search.degree = 40;
    const auto sites = predictDegree(*w, *shared, search, Exec{});
    EXPECT_TRUE(sites.ok());
    const auto cells = cvd(shared, *w, &*sites, {}, Exec{});
    EXPECT_TRUE(cells.ok());
    std::vector<double> volume(40, 0), moment(40, 0);
    for (std::size_t n = 0; n < tets->nodes.size(); ++n) {
      volume[at(cells->label[n])] += w->volume[n];
      moment[at(cells->label[n])] += w->volume[n] * tets->nodes[n].x();
    }
    int fragile = 0;
    for (std::size_t c = 0; c < 40; ++c) fragile += moment[c] > 0.5 * volume[c];
    return fragile / 40.0;
  };
  EXPECT_NEAR(share(nullptr), 0.5, 0.08);
  // Cells of equal energy times squared size: their density goes with β^(3/5), so 4^0.6 / (1 + 4^0.6) of
  // them.
  EXPECT_NEAR(share(&*beta), 0.70, 0.08);
}

}  // namespace
}  // namespace sherd
