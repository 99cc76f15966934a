// What the steps make of real models, saved and loaded.
#include <gtest/gtest.h>

#include <filesystem>

#include "cvd/cvd.h"
#include "embed/embed.h"
#include "load_mesh/load_mesh.h"
#include "nodes/types/memory_store.h"
#include "nodes/types/value_fields.h"
#include "predict_degree/predict_degree.h"
#include "simulate/simulate.h"
#include "tessellate/tessellate.h"
#include "tetrahedralize/tetrahedralize.h"
#include "weights/weights.h"

namespace sherd {
namespace {

template <class T>
std::shared_ptr<const T> made(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().text());
  return std::make_shared<const T>(std::move(result).value());
}

class PipelineArchive : public testing::Test {
 protected:
  template <class T>
  void expectRoundTrip(const std::shared_ptr<const T>& given) {
    const Digest digest = store.keep(given);
    store.restart();
    const auto loaded = store.load<T>(digest);
    ASSERT_NE(loaded, nullptr) << valueType<T>().name;
    EXPECT_TRUE(fields::sameBits(*loaded, *given)) << valueType<T>().name;
  }

  void fracture(const std::string& file, int tetCount, int degree) {
    LoadMeshParams load;
    load.file = file;
    const auto surface = made(loadMesh(load, Exec{}));
    TetrahedralizeParams tetParams;
    tetParams.tets = tetCount;
    const auto tets = made(tetrahedralize(surface, tetParams, Exec{}));
    const auto embedding = made(embed(tets, {}, Exec{}));
    SimulateParams drop;
    drop.orientation = Vec3(25, 0, 15);
    const auto hit = made(simulate(tets, drop, Exec{}));
    const auto energy = std::make_shared<const EnergyField>(hit->energy);
    const auto weight = made(weights(*energy, nullptr, {}, Exec{}));
    PredictDegreeParams search;
    search.degree = degree;
    const auto sites = made(predictDegree(*weight, *embedding, search, Exec{}));
    const auto cells = made(cvd(embedding, *weight, sites.get(), {}, Exec{}));
    const auto pieces = made(tessellate(*cells, {}, Exec{}));
    ASSERT_GE(pieces->pieces.size(), 2u);
    ASSERT_TRUE(hit->impact.hit);

    expectRoundTrip(surface);
    expectRoundTrip(tets);
    expectRoundTrip(embedding);
    expectRoundTrip(std::make_shared<const Impact>(hit->impact));
    expectRoundTrip(energy);
    expectRoundTrip(weight);
    expectRoundTrip(sites);
    expectRoundTrip(cells);
    expectRoundTrip(pieces);
    EXPECT_EQ(store.entries(), 9u);
  }

  MemoryStore store;
};

TEST_F(PipelineArchive, Vase) { fracture(SHERD_SOURCE_DIR "/assets/vase.obj", 1000, 7); }

class PipelineArchiveSlow : public PipelineArchive, public testing::WithParamInterface<const char*> {};

TEST_P(PipelineArchiveSlow, SharedModel) {
  const std::string file = std::string(SHERD_SOURCE_DIR "/../shared/meshes/") + GetParam() + ".obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  fracture(file, 5000, 48);
}

INSTANTIATE_TEST_SUITE_P(Meshes, PipelineArchiveSlow, testing::Values("bunny", "spot", "horse", "knight"));

}  // namespace
}  // namespace sherd
