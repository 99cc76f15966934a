// What the runtime itself costs: nodes that do next to nothing, wide and deep, cold and warm, with the cache
// on disk, beside a bare oneTBB flow graph that adds the same numbers. Each row is also checked: the sum at
// the end must be what it has to be ("error").
#include <benchmark/benchmark.h>
#include <tbb/flow_graph.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "base/parallel.h"
#include "eval/plan.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

/// A chain of `count` additions of 1, or as many of 1 to the same number.
std::string nodesText(int count, bool deep) {
  std::string text = R"("n0": {"type": "Constant@1", "params": {"value": 1}})";
  for (int i = 1; i < count; ++i)
    text += ",\n\"n" + std::to_string(i) + R"(": {"type": "Add@1", "in": {"a": "n)" +
            std::to_string(deep ? i - 1 : 0) + R"("}, "params": {"offset": )" +
            (deep ? "1" : numberText(i * 1e-6)) + "}}";
  return text;
}

Graph graphWith(int count, bool deep, const Registry& registry) {
  return check("{\"format\": 1, \"nodes\": {" + nodesText(count, deep) + "}}", registry).graph;
}

std::vector<int> wantedOf(const Graph& graph, bool deep) {
  std::vector<int> wanted;
  for (int i = deep ? static_cast<int>(graph.nodes.size()) - 1 : 1; i < static_cast<int>(graph.nodes.size());
       ++i)
    wanted.push_back(i);
  return wanted;
}

double expected(int count, bool deep) { return deep ? count : 1 + (count - 1) * 1e-6; }

class Bench {
 public:
  explicit Bench(benchmark::State& state)
      : count(static_cast<int>(state.range(0))),
        deep(state.range(1) == 1),
        graph(graphWith(count, deep, registry)),
        wanted(wantedOf(graph, deep)),
        directory(fs::temp_directory_path() / ("sherd_bench_eval_" + std::to_string(::getpid()))) {}
  ~Bench() { fs::remove_all(directory); }

  std::unique_ptr<DiskStore> open() const { return DiskStore::open(directory.string()).value(); }
  EvalReport run(DiskStore& store, bool values) const {
    Cache cache;
    CancelToken token;
    return evaluate(graph, wanted, cache, token, {.values = values, .disk = &store});
  }
  void tell(benchmark::State& state, double error) const {
    state.SetItemsProcessed(state.iterations() * count);
    state.counters["error"] = error;
  }
  double errorOf(const EvalReport& report) const {
    return std::abs(*report.outputs.at(count - 1).at(0).value.as<double>() - expected(count, deep));
  }

  const int count;
  const bool deep;
  const Registry registry = madeUpNodes();
  const Graph graph;
  const std::vector<int> wanted;
  const fs::path directory;
};

void evaluateCold(benchmark::State& state) {
  const Bench bench(state);
  double error = 0;
  for (auto _ : state) {
    state.PauseTiming();
    fs::remove_all(bench.directory);
    auto store = bench.open();
    state.ResumeTiming();
    const EvalReport report = bench.run(*store, true);
    store->flush();
    state.PauseTiming();
    error = std::max(error, bench.errorOf(report));
    store.reset();
    state.ResumeTiming();
  }
  bench.tell(state, error);
}

void evaluateWarm(benchmark::State& state) {
  const Bench bench(state);
  bench.run(*bench.open(), true);
  const auto store = bench.open();
  double missed = 0;
  for (auto _ : state) missed += bench.count - bench.run(*store, false).count(NodeState::Hit);
  if (bench.deep) missed = bench.run(*store, false).count(NodeState::Run);
  bench.tell(state, missed);
}

void planWarm(benchmark::State& state) {
  const Bench bench(state);
  bench.run(*bench.open(), true);
  const auto store = bench.open();
  double missed = 0;
  for (auto _ : state) {
    Cache cache;
    for (const PlanEntry& entry :
         planRun(bench.graph, bench.wanted, cache, {.values = false, .disk = store.get()}, {}))
      missed += entry.state == PlanState::Hit ? 0 : 1;
  }
  bench.tell(state, missed);
}

void loadAndCheck(benchmark::State& state) {
  const Registry registry = madeUpNodes();
  const std::string text =
      "{\"format\": 1, \"nodes\": {" + nodesText(static_cast<int>(state.range(0)), true) + "}}";
  double errors = 0;
  for (auto _ : state) errors += static_cast<double>(check(text, registry).errors.size());
  state.counters["error"] = errors;
}

/// The peer: a graph that is built beforehand and only passes numbers on.
void flowGraph(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const bool deep = state.range(1) == 1;
  using Node = tbb::flow::function_node<double, double>;
  tbb::flow::graph graph;
  std::vector<std::unique_ptr<Node>> nodes;
  std::vector<double> sums(static_cast<std::size_t>(count), 0);
  for (int i = 0; i < count; ++i)
    nodes.push_back(std::make_unique<Node>(graph, 1, [&sums, i, deep](double v) {
      return sums[static_cast<std::size_t>(i)] = i == 0 ? 1 : v + (deep ? 1 : i * 1e-6);
    }));
  for (int i = 1; i < count; ++i)
    tbb::flow::make_edge(*nodes[static_cast<std::size_t>(deep ? i - 1 : 0)],
                         *nodes[static_cast<std::size_t>(i)]);
  for (auto _ : state) {
    nodes[0]->try_put(0);
    graph.wait_for_all();
  }
  state.SetItemsProcessed(state.iterations() * count);
  state.counters["error"] = std::abs(sums.back() - expected(count, deep));
}

/// Two branches that have nothing to do with each other, by the number of threads: the ratio of the times is
/// what counts, at most 0.6.
void branches(benchmark::State& state) {
  struct None {};
  Registry registry = madeUpNodes();
  const auto added = registry.add(NodeBuilder<None>("Busy", 1, "")
                                      .optionalInput<double>("a", "")
                                      .output<double>("out", "")
                                      .run([](const None&, NodeIo& io) -> Result<void> {
                                        const auto a = io.in<double>("a");
                                        double sum = a ? *a : 1;
                                        for (int i = 0; i < 5000000; ++i) sum = std::sin(sum) + 1;
                                        // The iteration forgets where it began; equal results would be one
                                        // key.
                                        io.out("out", sum + (a ? 0.1 * *a : 0));
                                        return {};
                                      }));
  std::string text =
      R"("p": {"type": "Constant@1", "params": {"value": 1}}, "q": {"type": "Constant@1", "params": {"value": 2}})";
  for (const char* root : {"p", "q"})
    for (int i = 0; i < 4; ++i)
      text += std::string(",\"") + root + std::to_string(i) + R"(": {"type": "Busy@1", "in": {"a": ")" +
              root + (i == 0 ? "" : std::to_string(i - 1)) + "\"}}";
  const Graph graph = check("{\"format\": 1, \"nodes\": {" + text + "}}", registry).graph;
  setThreadLimit(static_cast<int>(state.range(0)));
  double failed = added.ok() ? 0 : 1;
  for (auto _ : state) {
    Cache cache;
    CancelToken token;
    failed += evaluate(graph, nodesOf(graph, {"p3", "q3"}), cache, token).ok() ? 0 : 1;
  }
  setThreadLimit(0);
  state.counters["error"] = failed;
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->ArgNames({"nodes", "deep"})->UseRealTime();
  for (const int count : {10000, 100000})
    for (const int deep : {0, 1}) benchmark->Args({count, deep});
}

BENCHMARK(evaluateCold)->Apply(sizes);
BENCHMARK(evaluateWarm)->Apply(sizes);
BENCHMARK(planWarm)->Apply(sizes);
BENCHMARK(flowGraph)->Apply(sizes);
BENCHMARK(branches)->Unit(benchmark::kMillisecond)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(loadAndCheck)->Unit(benchmark::kMillisecond)->Arg(1000);

}  // namespace
}  // namespace sherd::test

BENCHMARK_MAIN();
