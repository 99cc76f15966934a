// A training that is killed: the next run goes on where it was, and ends as if nothing had happened.
#include <signal.h>
#include <sys/stat.h>

#include <fstream>

#include "faults/program_process.h"

namespace sherd::faults {
namespace {

/// A mushroom that is trained on and broken by what was learned.
class Training {
 public:
  explicit Training(const ScratchDirectory& scratch) : scratch_(scratch) {
    writeText(scratch.file("graph.json"), R"({
  "format": 1,
  "vars": { "gamma": 2e-4 },
  "nodes": {
    "mesh":    { "type": "LoadMesh@1", "params": { "file": "${ASSETS}/mushroom.obj", "length": 0.2 } },
    "tets":    { "type": "Tetrahedralize@1", "in": { "mesh": "mesh" }, "params": { "tets": 800 } },
    "embed":   { "type": "Embed@1", "in": { "tets": "tets" }, "params": { "metric": "euclidean" } },
    "model":   { "type": "TrainDegree@1", "in": { "body": "tets", "embedding": "embed" },
                 "params": { "gamma": "${gamma}", "heights": [1, 4], "orientations": 40, "repeats": 2,
                             "contact_radius": 0.01 } },
    "hit":     { "type": "Simulate@1", "in": { "body": "tets" }, "params": { "drop_height": 3, "contact_radius": 0.01 } },
    "weights": { "type": "Weights@1", "in": { "energy": "hit.energy" } },
    "degree":  { "type": "PredictDegree@1",
                 "in": { "weights": "weights", "embedding": "embed", "model": "model" },
                 "params": { "gamma": "${gamma}", "outside": "predict" } },
    "cells":   { "type": "CVD@1", "in": { "weights": "weights", "embedding": "embed", "sites": "degree.sites" } },
    "pieces":  { "type": "Tessellate@1", "in": { "cells": "cells" } },
    "crack":   { "type": "ExportCrackSurface@1", "in": { "pieces": "pieces" }, "params": { "directory": "out" } }
  }
})");
  }
  std::vector<std::string> arguments(const std::string& cache,
                                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", scratch_.file("graph.json"), "--json", "--cache",
                                 scratch_.file(cache)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::map<std::string, std::string> run(const std::string& cache,
                                         const std::vector<std::string>& more = {}) const {
    const Ended ended = runSherd(arguments(cache, more), scratch_.file(""), "");
    EXPECT_EQ(ended.exitCode, 0) << ended.out << ended.err;
    return filesBelow(scratch_.file("out"));
  }
  /// The parts in a cache, by name, with what tells whether a file is still the same one.
  std::map<std::string, std::uint64_t> parts(const std::string& cache) const {
    std::map<std::string, std::uint64_t> found;
    std::error_code problem;
    for (fs::recursive_directory_iterator at(scratch_.file(cache + "/objects"), problem), end; at != end;
         at.increment(problem)) {
      struct stat info {};
      char head[120] = {};
      std::ifstream file(at->path(), std::ios::binary);
      if (!file.read(head, sizeof head) || ::stat(at->path().c_str(), &info) != 0) continue;
      if (std::string_view(head, sizeof head).find("(part of a result)") != std::string_view::npos)
        found[at->path().filename()] = info.st_ino;
    }
    return found;
  }

 private:
  const ScratchDirectory& scratch_;
};

TEST(KilledTraining, GoesOnWhereItWas) {
  const ScratchDirectory scratch;
  const Training training(scratch);
  const auto expected = training.run("whole");
  const auto whole = training.parts("whole");
  ASSERT_EQ(whole.size(), 80u + 40 + 80);
  for (const std::size_t moment : {10u, 100u, 140u}) {  // among drops, deformations, searches
    const std::string cache = "killed" + std::to_string(moment);
    Process process(training.arguments(cache), scratch.file(""), "");
    const auto start = std::chrono::steady_clock::now();
    while (training.parts(cache).size() < moment && secondsSince(start) < 100) sleepSeconds(0.002);
    process.signal(SIGKILL);
    process.wait();
    const auto before = training.parts(cache);
    EXPECT_GE(before.size(), moment);
    EXPECT_LT(before.size(), whole.size()) << "it was killed too late";
    expectSameFiles(training.run(cache), expected, cache);
    const auto after = training.parts(cache);
    EXPECT_EQ(after.size(), whole.size());
    for (const auto& [name, file] : before) EXPECT_EQ(after.at(name), file) << "computed again";
  }
}

TEST(KilledTraining, AnotherGammaTakesNoDropAndNoSolution) {
  const ScratchDirectory scratch;
  const Training training(scratch);
  training.run("cache");
  const auto before = training.parts("cache");
  training.run("cache", {"--var", "gamma=4e-4"});
  EXPECT_EQ(training.parts("cache"), before);
  training.run("cache", {"--set", "model.heights=[1, 2, 4]"});
  const auto after = training.parts("cache");
  EXPECT_EQ(after.size(), before.size() + 40);  // the drops alone
  for (const auto& [name, file] : before) EXPECT_EQ(after.at(name), file);
}

}  // namespace
}  // namespace sherd::faults
