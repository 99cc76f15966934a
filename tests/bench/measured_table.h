// Google Benchmark with the medians at hand afterwards, and tables of them.
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstddef>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sherd::bench {

/// The counter that holds the processor time of all threads, ms: what is left to compare on a machine that
/// others use as well.
inline constexpr const char* kProcessorTime = "cpu_ms";

/// Registers a benchmark of `make`; releasing what it returns is not timed. `made` is called with the last
/// one.
template <class Make, class Made>
void timeOf(const std::string& name, int repetitions, Make make, std::function<void(const Made&)> made) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 for (auto _ : state) {
                                   const std::clock_t cpuStart = std::clock();
                                   const auto start = std::chrono::steady_clock::now();
                                   auto result = make();
                                   const auto end = std::chrono::steady_clock::now();
                                   const auto cpu = static_cast<double>(std::clock() - cpuStart);
                                   state.counters[kProcessorTime] = 1000 * cpu / CLOCKS_PER_SEC;
                                   state.SetIterationTime(std::chrono::duration<double>(end - start).count());
                                   benchmark::DoNotOptimize(result);
                                   if (made) made(result);
                                 }
                               })
      ->UseManualTime()
      ->Iterations(1)
      ->Repetitions(repetitions)
      ->ReportAggregatesOnly()
      ->Unit(benchmark::kMillisecond);
}

/// Runs what was registered since the last call, and forgets it.
void runMeasured();

/// ms, of a benchmark that has run; 0 where there is none.
double medianOf(const std::string& name);
/// ms of processor time, of all threads together.
double processorMedianOf(const std::string& name);

/// ms of processor time, of all threads together: the least of so many runs.
double leastProcessorMs(int runs, const std::function<void()>& work);

std::string number(double value);      ///< three digits that count
std::string scientific(double value);  ///< 1.2e-09
std::string count(std::size_t value);

class Table {
 public:
  explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// And the same rows as JSON, as objects by the head's names, beside it.
  void write(const std::filesystem::path& csv) const;
  std::string markdown() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// Replaces the section of a Markdown file between two comments that name it, or appends it.
void writeSection(const std::filesystem::path& file, const std::string& name, const std::string& text);

}  // namespace sherd::bench
