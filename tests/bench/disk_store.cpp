// What the cache on disk costs: per record, per look-up, per opening, per value. Run with TMPDIR on the disk
// that matters; the directory is made anew and removed.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "runtime/disk_values.h"

namespace sherd::test {
namespace {

namespace fs = std::filesystem;

fs::path freshDirectory(const std::string& name) {
  const fs::path path =
      fs::temp_directory_path() / ("sherd_bench_" + name + "_" + std::to_string(::getpid()));
  fs::remove_all(path);
  return path;
}

/// As spread as digests are, and quicker to make.
Digest key(std::uint64_t number) {
  const Rng rng(number);
  return {rng.bitsAt(0), rng.bitsAt(1)};
}

void fill(DiskStore& store, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i)
    store.record({key(i), key(i % 1000), 0.01, {{{i, i}, 8}}, {}, {}});
}

/// A store of `count` quick results, `merged` or as one process left it.
fs::path filled(std::uint64_t count, bool merged) {
  const fs::path path = freshDirectory(std::to_string(count) + (merged ? "m" : "y"));
  fs::path copy = path.string() + "_copy";
  {
    const auto store = openStore(path);
    fill(*store, count);
    store->flush();
    if (!merged) fs::copy(path, copy, fs::copy_options::recursive);
  }
  if (merged) return path;
  fs::remove_all(path);
  return copy;
}

std::vector<Digest> keys(std::uint64_t count, std::uint64_t from) {
  std::vector<Digest> made;
  Rng rng(5);
  for (int i = 0; i < 4096; ++i) made.push_back(key(from + rng.below(count)));
  return made;
}

void record(benchmark::State& state, double ms) {
  const fs::path path = freshDirectory("record");
  {
    const auto store = openStore(path);
    ResultRecord record{{}, digestOf(1), ms, {{digestOf(2), 8}}, {}, {}};
    std::uint64_t i = 0;
    for (auto _ : state) {
      record.key = {i * 0x9E3779B97F4A7C15U, i};
      ++i;
      store->record(record);
    }
  }
  fs::remove_all(path);
}
BENCHMARK_CAPTURE(record, quick, 0.01)->Iterations(100'000);
BENCHMARK_CAPTURE(record, slow, 5.0)->Iterations(20'000);

void findOutputs(benchmark::State& state, bool merged, bool hit) {
  const auto count = static_cast<std::uint64_t>(state.range(0));
  const fs::path path = filled(count, true);
  {
    const auto store = openStore(path);
    if (!merged) fill(*store, count);
    const std::vector<Digest> wanted = keys(count, hit ? 0 : 10'000'000);
    std::vector<OutputRecord> outputs;
    std::size_t i = 0;
    for (auto _ : state)
      if (store->findOutputs(wanted[i++ % wanted.size()], outputs) != hit) state.SkipWithError("wrong");
  }
  fs::remove_all(path);
}
BENCHMARK_CAPTURE(findOutputs, young_hit, false, true)->Arg(10'000)->Arg(1'000'000)->Iterations(1'000'000);
BENCHMARK_CAPTURE(findOutputs, young_miss, false, false)->Arg(10'000)->Arg(1'000'000)->Iterations(1'000'000);
BENCHMARK_CAPTURE(findOutputs, merged_hit, true, true)->Arg(1'000'000)->Iterations(1'000'000);
BENCHMARK_CAPTURE(findOutputs, merged_miss, true, false)->Arg(1'000'000)->Iterations(1'000'000);

void open(benchmark::State& state, bool merged) {
  const fs::path path = filled(static_cast<std::uint64_t>(state.range(0)), merged);
  for (auto _ : state) {
    auto store = openStore(path);
    state.PauseTiming();
    store.reset();
    state.ResumeTiming();
  }
  fs::remove_all(path);
}
BENCHMARK_CAPTURE(open, young, false)->Arg(10'000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(open, merged, true)
    ->Arg(50'000)
    ->Arg(1'000'000)
    ->Iterations(20)
    ->Unit(benchmark::kMillisecond);

void mergeMillion(benchmark::State& state) {
  for (auto _ : state) {
    const fs::path path = freshDirectory("merge");
    auto store = openStore(path);
    state.PauseTiming();
    fill(*store, 1'000'000);
    state.ResumeTiming();
    store.reset();
    state.PauseTiming();
    fs::remove_all(path);
    state.ResumeTiming();
  }
}
BENCHMARK(mergeMillion)->Iterations(2)->Unit(benchmark::kMillisecond);

void refreshNothing(benchmark::State& state) {
  const fs::path path = filled(1000, false);
  const auto store = openStore(path);
  for (auto _ : state) store->refresh();
  fs::remove_all(path);
}
BENCHMARK(refreshNothing);

void load(benchmark::State& state) {
  const fs::path path = freshDirectory("value");
  {
    const auto store = openStore(path);
    const auto count = static_cast<std::size_t>(state.range(0)) / sizeof(double);
    const Leaf content = leaf(1, count);
    const Digest digest = valueOf(content).digest();
    store->save(valueOf(content), digest, 5);
    for (auto _ : state) benchmark::DoNotOptimize(store->load(valueType<Leaf>(), digest));
    state.SetBytesProcessed(state.iterations() * state.range(0));
  }
  fs::remove_all(path);
}
BENCHMARK(load)->Arg(1000)->Arg(10'000'000);

void save(benchmark::State& state) {
  const fs::path path = freshDirectory("save");
  {
    const auto store = openStore(path);
    const Value value = valueOf(leaf(1, static_cast<std::size_t>(state.range(0)) / sizeof(double)));
    std::uint64_t i = 0;
    for (auto _ : state) store->save(value, digestOf(++i), 5);
    state.SetBytesProcessed(state.iterations() * state.range(0));
  }
  fs::remove_all(path);
}
BENCHMARK(save)->Arg(1000)->Arg(1'000'000);

}  // namespace
}  // namespace sherd::test

BENCHMARK_MAIN();
