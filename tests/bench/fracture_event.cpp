// One fracture event, preprocessing given: statics, cells and cutting, with what each gets wrong beside its
// time.
//
//   bench_fracture_event                          own models
//   bench_fracture_event MESH.obj [MESH.obj …]    these as well
//
// Counters: pieces; volume_error, relative, of the pieces' sum; area_error, the same for the outer skin; E_D
// in J·m². The floor beside the cutting is one plain copy of the surface and its attributes.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "base/memory.h"
#include "cvd/cvd.h"
#include "embed/embed.h"
#include "load_mesh/load_mesh.h"
#include "predict_degree/predict_degree.h"
#include "simulate/simulate.h"
#include "support/promises.h"
#include "tessellate/tessellate.h"
#include "tetrahedralize/tetrahedralize.h"
#include "weights/weights.h"

namespace sherd {
namespace {

template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  std::fprintf(stderr, "bench_fracture_event: %s\n", result.error().text().c_str());
  std::exit(1);
}

/// A body with all that is computed once.
struct Body {
  std::shared_ptr<const TetMesh> tets;
  std::shared_ptr<const Embedding> embedding;
  SimulateParams drop;
};

Body prepare(const std::string& file, int tetCount) {
  Body body;
  LoadMeshParams load;
  load.file = file;
  auto surface = std::make_shared<const TriMesh>(orExit(loadMesh(load, Exec{})));
  TetrahedralizeParams params;
  params.tets = tetCount;
  body.tets = std::make_shared<const TetMesh>(orExit(tetrahedralize(surface, params, Exec{})));
  body.embedding = std::make_shared<const Embedding>(orExit(embed(body.tets, {}, Exec{})));
  body.drop.orientation = Vec3(25, 0, 15);
  return body;
}

void statics(benchmark::State& state, const Body& body) {
  SimulateOutput out;
  for (auto _ : state) benchmark::DoNotOptimize(out = orExit(simulate(body.tets, body.drop, Exec{})));
  state.counters["work_J"] = totalEnergy(out.energy);
}

struct Prepared {
  WeightField weights;
  Sites sites;
  Partition cells;
};

Prepared cellsOf(const Body& body, int degree) {
  Prepared p;
  p.weights = orExit(weights(orExit(simulate(body.tets, body.drop, Exec{})).energy, nullptr, {}, Exec{}));
  PredictDegreeParams search;
  search.degree = degree;
  p.sites = orExit(predictDegree(p.weights, *body.embedding, search, Exec{}));
  p.cells = orExit(cvd(body.embedding, p.weights, &p.sites, {}, Exec{}));
  return p;
}

void growing(benchmark::State& state, const Body& body) {
  const Prepared p = cellsOf(body, static_cast<int>(state.range(0)));
  PredictDegreeParams search;
  search.degree = static_cast<int>(state.range(0));
  Sites sites;
  for (auto _ : state)
    benchmark::DoNotOptimize(sites = orExit(predictDegree(p.weights, *body.embedding, search, Exec{})));
  state.counters["E_D"] = sites.energy;
}

void cells(benchmark::State& state, const Body& body) {
  const Prepared p = cellsOf(body, static_cast<int>(state.range(0)));
  Partition result;
  for (auto _ : state)
    benchmark::DoNotOptimize(result = orExit(cvd(body.embedding, p.weights, &p.sites, {}, Exec{})));
  state.counters["E_D"] = result.energy;
  state.counters["passes"] = result.iterations;
}

void cutting(benchmark::State& state, const Body& body) {
  const Prepared p = cellsOf(body, static_cast<int>(state.range(0)));
  Fragments result;
  for (auto _ : state) benchmark::DoNotOptimize(result = orExit(tessellate(p.cells, {}, Exec{})));
  const PromiseReport report = measurePromises(result);
  state.counters["pieces"] = static_cast<double>(result.pieces.size());
  state.counters["open_edges"] = static_cast<double>(report.openEdges);
  state.counters["volume_error"] = report.volumeError;
  state.counters["area_error"] = report.areaError;
}

void copying(benchmark::State& state, const Body& body) {
  for (auto _ : state) {
    TriMesh copy = *body.tets->surface;
    benchmark::DoNotOptimize(copy.positions.data());
  }
  state.counters["triangles"] = static_cast<double>(body.tets->surface->triangles.size());
}

void add(const std::string& file, int tetCount, std::vector<int> degrees) {
  static std::map<std::string, Body> bodies;
  const Body& body = bodies[file] = prepare(file, tetCount);
  const std::string name = std::filesystem::path(file).stem().string();
  auto timed = [&](const std::string& what, auto f) {
    return benchmark::RegisterBenchmark((name + "/" + what).c_str(), f, body)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  timed("copy", copying);
  timed("statics", statics);
  for (const int degree : degrees) {
    timed("grow", growing)->Arg(degree);
    timed("cells", cells)->Arg(degree);
    timed("cut", cutting)->Arg(degree);
  }
}

}  // namespace
}  // namespace sherd

int main(int argc, char** argv) {
  sherd::keepFreedMemory();  // as the launcher does
  benchmark::Initialize(&argc, argv);
  const std::string assets = SHERD_SOURCE_DIR "/assets/";
  sherd::add(assets + "wall.obj", 1400, {3, 18});
  sherd::add(assets + "mushroom.obj", 1300, {5, 81});
  sherd::add(assets + "vase.obj", 5000, {7, 48});
  for (int i = 1; i < argc; ++i) sherd::add(argv[i], 5000, {7, 67});
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
