// Benchmark programs in parts: the arguments that they share, and where their results go.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace sherd::bench {

struct Options {
  std::set<std::string> parts;
  std::filesystem::path out;
  std::string results;
  bool peer = true;
  int repetitions = 20;
  std::size_t largest = 10'000'000;
};

struct Part {
  const char* name;
  void (*measure)(const Options&, std::string& report);
};

/// `program`: its name, that of its directory below `build` and of its sections. `takes`: which of --largest,
/// --repetitions and --no-peer it knows beside --part, --out and --results; others end it with exit code 2.
/// Runs the parts asked for (all of them, where none is) and writes each one's report into results.md of the
/// directory, and into the results file where one is given.
int runParts(int argc, char** argv, const std::string& program, const std::string& build, Options options,
             const std::set<std::string>& takes, const std::vector<Part>& parts);

}  // namespace sherd::bench
