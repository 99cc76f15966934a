// Trainings: how they go with two threads, and what is computed when one is changed.
//
//   bench_training [--mesh FILE] [--tets N] [--gamma G] [--results FILE.md]
//
// Six heights, 64 orientations with three searches each. Times are of the processor, so that other processes
// beside this one don't matter: of all threads, and of the thread that calls, which takes part in all that is
// parallel and does alone what isn't.
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "base/parallel.h"
#include "bench/measured_table.h"
#include "embed/embed.h"
#include "load_mesh/load_mesh.h"
#include "tetrahedralize/tetrahedralize.h"
#include "train_degree/train_degree.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;

/// Of which the one counts in which the calling thread was busy for the least time: where others keep the
/// second thread from running, it does more than its half.
constexpr int kRounds = 5;

using Arguments = std::map<std::string, std::string>;

template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "bench_training: {}\n", result.error().text());
  std::exit(1);
}

struct Body {
  std::shared_ptr<const TetMesh> tets;
  std::shared_ptr<const Embedding> embedding;
};

Body bodyOf(const Arguments& arguments) {
  LoadMeshParams load;
  load.file = arguments.at("mesh");
  TetrahedralizeParams params;
  params.tets = std::stoi(arguments.at("tets"));
  const auto mesh = std::make_shared<const TriMesh>(orExit(loadMesh(load, Exec{})));
  Body body;
  body.tets = std::make_shared<const TetMesh>(orExit(tetrahedralize(mesh, params, Exec{})));
  body.embedding = std::make_shared<const Embedding>(orExit(embed(body.tets, {}, Exec{})));
  return body;
}

/// Keeps parts in memory.
class Kept : public Memo {
 public:
  std::optional<std::string> find(const Digest& key) override {
    const std::lock_guard lock(mutex_);
    const auto found = parts_.find(key);
    return found == parts_.end() ? std::nullopt : std::optional(found->second);
  }
  void keep(const Digest& key, std::string_view bytes, double) override {
    const std::lock_guard lock(mutex_);
    parts_[key] = bytes;
  }
  double megabytes() const {
    double sum = 0;
    for (const auto& [key, bytes] : parts_) sum += static_cast<double>(bytes.size());
    return 1e-6 * sum;
  }

 private:
  std::mutex mutex_;
  std::map<Digest, std::string> parts_;
};

/// Seconds of the processor.
struct Spent {
  double all = 0, calling = 0;
};
Spent spent() {
  const auto seconds = [](clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  return {seconds(CLOCK_PROCESS_CPUTIME_ID), seconds(CLOCK_THREAD_CPUTIME_ID)};
}

DropExamples examplesOf(const Body& body, const TrainDegreeParams& params, Memo* memo = nullptr) {
  return orExit(dropExamples(body.tets, body.embedding, nullptr, params, Exec{}, memo));
}

struct Training {
  DropExamples examples;
  DegreeModel model;
  Spent examplesTook, learningTook;
};

Training train(const Body& body, const TrainDegreeParams& params, Memo* memo = nullptr) {
  Training t;
  const Spent start = spent();
  t.examples = examplesOf(body, params, memo);
  const Spent middle = spent();
  t.model = orExit(learnFromDrops(t.examples, *body.embedding, params.learn, Exec{})).model;
  const Spent end = spent();
  t.examplesTook = {middle.all - start.all, middle.calling - start.calling};
  t.learningTook = {end.all - middle.all, end.calling - middle.calling};
  return t;
}

std::string onReuse(const Body& body, const TrainDegreeParams& params) {
  Kept kept;
  Table table({"training", "impacts", "solutions", "paths", "examples cpu s", "learning cpu s", "kept MB"});
  const auto row = [&](const char* name, const TrainDegreeParams& changed) {
    const Training t = train(body, changed, &kept);
    table.row({name, count(t.examples.impacts), count(t.examples.solves), count(t.examples.paths),
               number(t.examplesTook.all), number(t.learningTook.all), number(kept.megabytes())});
  };
  row("the first", params);
  row("the same", params);
  TrainDegreeParams changed = params;
  changed.gamma = 1.5 * params.gamma;
  row("γ · 1.5", changed);
  changed.gamma = 0.8 * params.gamma;
  row("γ · 0.8", changed);
  changed = params;
  changed.heights = kDropHeights;
  changed.heights.push_back(4);
  row("one more height", changed);
  changed = params;
  changed.orientations += 8;
  row("eight more orientations", changed);
  return table.markdown();
}

std::string onThreads(const Body& body, const TrainDegreeParams& params) {
  Table table({"part", "one thread cpu s", "two threads cpu s", "of these calling", "one / calling"});
  std::vector<Spent> examples, learning;
  for (const int threads : {1, 2}) {
    setThreadLimit(threads);
    Spent least[2] = {{1e9, 1e9}, {1e9, 1e9}};
    for (int round = 0; round < kRounds; ++round)
      inArena([&] {
        const Training t = train(body, params);
        if (t.examplesTook.calling < least[0].calling) least[0] = t.examplesTook;
        if (t.learningTook.calling < least[1].calling) least[1] = t.learningTook;
      });
    examples.push_back(least[0]), learning.push_back(least[1]);
  }
  const auto row = [&](const char* name, const Spent& one, const Spent& two) {
    table.row({name, number(one.all), number(two.all), number(two.calling),
               fmt::format("{:.2f}", one.all / two.calling)});
  };
  row("examples", examples[0], examples[1]);
  row("learning", learning[0], learning[1]);
  row("both", {examples[0].all + learning[0].all, 0},
      {examples[1].all + learning[1].all, examples[1].calling + learning[1].calling});
  return table.markdown();
}

void measure(const Arguments& arguments) {
  const Body body = bodyOf(arguments);
  TrainDegreeParams params;
  params.gamma = std::stod(arguments.at("gamma"));
  const std::string name = fs::path(arguments.at("mesh")).stem().string();
  std::string report =
      fmt::format("{}: {} tetrahedra, γ = {:.4g} J·m²\n\n", name, body.tets->tets.size(), params.gamma);
  report += onThreads(body, params) + '\n';
  report += onReuse(body, params);
  fmt::print("{}", report);
  if (!arguments.at("results").empty())
    writeSection(arguments.at("results"), "bench_training " + name, report);
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  sherd::bench::Arguments arguments{{"mesh", SHERD_SOURCE_DIR "/../shared/meshes/horse.obj"},
                                    {"tets", "5256"},
                                    {"gamma", "1e-3"},
                                    {"results", ""}};
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (!name.starts_with("--") || !arguments.contains(name.substr(2))) {
      fmt::print(stderr, "bench_training: there is no {}\n", name);
      return 2;
    }
    arguments[name.substr(2)] = argv[i + 1];
  }
  sherd::bench::measure(arguments);
  return 0;
}
