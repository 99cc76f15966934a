#include "bench/parts.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>

#include "base/memory.h"
#include "base/parallel.h"
#include "bench/measured_table.h"

namespace sherd::bench {
namespace {

void read(int argc, char** argv, const std::string& program, const std::set<std::string>& takes,
          Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool more = i + 1 < argc, taken = takes.count(word) > 0;
    if (word == "--part" && more)
      options.parts.insert(argv[++i]);
    else if (word == "--out" && more)
      options.out = argv[++i];
    else if (word == "--results" && more)
      options.results = argv[++i];
    else if (word == "--largest" && taken && more)
      options.largest = std::stoul(argv[++i]);
    else if (word == "--repetitions" && taken && more)
      options.repetitions = std::stoi(argv[++i]);
    else if (word == "--no-peer" && taken)
      options.peer = false;
    else {
      fmt::print(stderr, "{}: unknown argument '{}'\n", program, word);
      std::exit(2);
    }
  }
}

}  // namespace

int runParts(int argc, char** argv, const std::string& program, const std::string& build, Options options,
             const std::set<std::string>& takes, const std::vector<Part>& parts) {
  keepFreedMemory();  // as the launcher does
  benchmark::Initialize(&argc, argv);
  options.out = build + "/" + program;
  read(argc, argv, program, takes, options);
  std::filesystem::create_directories(options.out);
  for (const Part& part : parts) {
    if (!options.parts.empty() && options.parts.count(part.name) == 0) continue;
    std::string report;
    inArena([&] { part.measure(options, report); });  // as the evaluator does
    const std::string section = program + " " + part.name;
    writeSection(options.out / "results.md", section, report);
    if (!options.results.empty()) writeSection(options.results, section, report);
    fmt::print("{}", report);
  }
  return 0;
}

}  // namespace sherd::bench
