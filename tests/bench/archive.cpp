// What it costs to keep each value: bytes, and time to hash, save and load, parts not counted (they are kept
// apart, and only once).
//
//   bench_archive                          assets/vase.obj
//   bench_archive MESH.obj [MESH.obj …]    these as well
//
// Counter: bytes on disk. The floor beside loading is one copy of those bytes.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "base/value_type.h"
#include "cvd/cvd.h"
#include "embed/embed.h"
#include "load_mesh/load_mesh.h"
#include "predict_degree/predict_degree.h"
#include "simulate/simulate.h"
#include "tessellate/tessellate.h"
#include "tetrahedralize/tetrahedralize.h"
#include "weights/weights.h"

namespace sherd {
namespace {

constexpr int kTets = 5000, kPieces = 48;

template <class T>
std::shared_ptr<const T> orExit(Result<T> result) {
  if (result.ok()) return std::make_shared<const T>(std::move(result).value());
  std::fprintf(stderr, "bench_archive: %s\n", result.error().text().c_str());
  std::exit(1);
}

struct Kept {
  std::string bytes;
  std::vector<ArchivePart> parts;

  std::shared_ptr<const void> part(const ValueType& type, const Digest& digest) const {
    for (const ArchivePart& p : parts)
      if (p.digest == digest && p.type->name == type.name) return p.data;
    return nullptr;
  }
};

template <class T>
void add(const std::string& model, const std::shared_ptr<const T>& value) {
  const ValueType& type = valueType<T>();
  ArchiveWriter to;
  type.save(to, value.get());
  const auto kept = std::make_shared<const Kept>(Kept{to.bytes(), to.parts()});
  const auto timed = [&](const char* what, auto body) {
    benchmark::RegisterBenchmark((model + "/" + type.name + "/" + what).c_str(),
                                 [=](benchmark::State& state) {
                                   for (auto _ : state) body();
                                   state.counters["bytes"] = static_cast<double>(kept->bytes.size());
                                 })
        ->Unit(benchmark::kMicrosecond)
        ->MinTime(0.1);
  };
  timed("digest", [=, &type] { benchmark::DoNotOptimize(type.digest(value.get())); });
  timed("save", [=, &type] {
    ArchiveWriter writer;
    type.save(writer, value.get());
    benchmark::DoNotOptimize(writer.bytes().data());
  });
  timed("load", [=, &type] {
    ArchiveReader from(kept->bytes, [&](const ValueType& t, const Digest& d) { return kept->part(t, d); });
    if (type.load(from) == nullptr) std::abort();
  });
  timed("copy", [=] {
    std::string copy = kept->bytes;
    benchmark::DoNotOptimize(copy.data());
  });
}

void addModel(const std::string& file) {
  LoadMeshParams load;
  load.file = file;
  const auto surface = orExit(loadMesh(load, Exec{}));
  TetrahedralizeParams params;
  params.tets = kTets;
  const auto tets = orExit(tetrahedralize(surface, params, Exec{}));
  const auto embedding = orExit(embed(tets, {}, Exec{}));
  SimulateParams drop;
  drop.orientation = Vec3(25, 0, 15);
  const auto hit = orExit(simulate(tets, drop, Exec{}));
  const auto weight = orExit(weights(hit->energy, nullptr, {}, Exec{}));
  PredictDegreeParams search;
  search.degree = kPieces;
  const auto sites = orExit(predictDegree(*weight, *embedding, search, Exec{}));
  const auto cells = orExit(cvd(embedding, *weight, sites.get(), {}, Exec{}));

  const std::string model = std::filesystem::path(file).stem().string();
  add(model, surface);
  add(model, tets);
  add(model, embedding);
  add(model, std::make_shared<const Impact>(hit->impact));
  add(model, std::make_shared<const EnergyField>(hit->energy));
  add(model, weight);
  add(model, sites);
  add(model, cells);
  add(model, orExit(tessellate(*cells, {}, Exec{})));
}

}  // namespace
}  // namespace sherd

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  sherd::addModel(SHERD_SOURCE_DIR "/assets/vase.obj");
  for (int i = 1; i < argc; ++i) sherd::addModel(argv[i]);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
