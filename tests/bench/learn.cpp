// Learning the degree: how far off models are on orientations that they were not made of, by the protocol of
// Schvartzman and Otaduy (2014), section 3.2.
//
//   bench_learn [--mesh FILE] [--tets N] [--orientations N] [--tests N] [--repeats N] [--pieces N] [--gamma
//   G]
//               [--threads N] [--out DIRECTORY] [--results FILE.md]
//
// Six heights, 64 orientations with three searches each to learn from, 18 others to test on. Without a γ, one
// is taken from the whole body's E_D as if that fell as N^(-2/3) to the median drop's `pieces` (20). A line
// per method: mean absolute error and R² on the test set, the noise that no model can foretell, time to fit
// and (median) to foretell; then means per height of the first two. Writes CSV and Markdown into the
// directory (default build/bench_learn), and the tables into a section of FILE.md.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
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

struct Arguments {
  std::map<std::string, std::string> text{{"mesh", SHERD_SOURCE_DIR "/../shared/meshes/horse.obj"},
                                          {"tets", "5256"},
                                          {"orientations", "64"},
                                          {"tests", "18"},
                                          {"repeats", "3"},
                                          {"pieces", "20"},
                                          {"gamma", "0"},
                                          {"threads", "0"},
                                          {"out", SHERD_BINARY_DIR "/bench_learn"},
                                          {"results", ""}};
  int integer(const char* name) const { return std::stoi(text.at(name)); }
  double number(const char* name) const { return std::stod(text.at(name)); }
};

template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "bench_learn: {}\n", result.error().text());
  std::exit(1);
}

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Body {
  std::shared_ptr<const TetMesh> tets;
  std::shared_ptr<const Embedding> embedding;
};

Body bodyOf(const Arguments& arguments) {
  LoadMeshParams load;
  load.file = arguments.text.at("mesh");
  TetrahedralizeParams params;
  params.tets = arguments.integer("tets");
  Body body;
  const auto mesh = std::make_shared<const TriMesh>(orExit(loadMesh(load, Exec{})));
  body.tets = std::make_shared<const TetMesh>(orExit(tetrahedralize(mesh, params, Exec{})));
  body.embedding = std::make_shared<const Embedding>(orExit(embed(body.tets, {}, Exec{})));
  fmt::print("{}: {} tetrahedra, {} nodes, {} dimensions\n", fs::path(load.file).stem().string(),
             body.tets->tets.size(), body.tets->nodes.size(), body.embedding->coordinates.rows());
  return body;
}

DropExamples dropsOf(const Body& body, const TrainDegreeParams& params) {
  return orExit(dropExamples(body.tets, body.embedding, nullptr, params, Exec{}));
}

/// γ for which the median of a few drops gives about so many pieces.
double gammaFor(const Body& body, TrainDegreeParams params, double pieces) {
  params.orientations = 9;
  params.repeats = params.maxDegree = 1;
  params.gamma = 1;
  std::vector<double> energy;
  for (const DropExample& drop : dropsOf(body, params).drops) energy.push_back(drop.wholeEnergy);
  std::nth_element(energy.begin(), energy.begin() + static_cast<std::ptrdiff_t>(energy.size() / 2),
                   energy.end());
  return energy[energy.size() / 2] / std::pow(pieces, 2.0 / 3);
}

struct Moments {
  double n = 0, sum = 0, squares = 0;
  void add(double v) { n += 1, sum += v, squares += v * v; }
  double mean() const { return sum / n; }
  double deviation() const { return std::sqrt(std::max(0.0, squares / n - mean() * mean())); }
};

/// What a model says of drops, beside what was searched.
struct Comparison {
  double absolute = 0, squared = 0, noise = 0, outside = 0, microseconds = 0;
  Moments searched;
  std::map<double, std::pair<Moments, Moments>> perHeight;  ///< searched, foretold

  double share() const { return absolute / searched.n / searched.mean(); }
  double rSquared() const { return 1 - squared / (searched.squares - searched.sum * searched.mean()); }
};

Comparison compare(const Body& body, const DropExamples& drops, const DegreeModel& model) {
  Comparison c;
  std::vector<double> seconds;
  for (const DropExample& drop : drops.drops) {
    if (drop.example.degree.empty()) continue;
    const WeightField field{body.tets, {}, drop.example.weight, drops.volume};
    DegreeEstimate estimate;
    seconds.push_back(secondsOf([&] { estimate = estimateDegree(model, field, *body.embedding); }));
    c.outside += estimate.isOutside;
    double mean = 0;
    for (const int degree : drop.example.degree) mean += degree;
    mean /= static_cast<double>(drop.example.degree.size());
    auto& [searched, foretold] = c.perHeight[drop.height];
    foretold.add(estimate.degree);
    for (const int degree : drop.example.degree) {
      c.searched.add(degree);
      searched.add(degree);
      c.absolute += std::abs(estimate.degree - degree);
      c.squared += std::pow(estimate.degree - degree, 2);
      c.noise += std::abs(degree - mean);
    }
  }
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  c.microseconds = 1e6 * *middle;
  return c;
}

struct Method {
  const char* name;
  LearnDegreeParams params;
};
const Method kMethods[] = {
    {"best", {}},
    {"paper", {DegreeMethod::Network, 0.02, 0.01}},
    {"paper, PCA to 0.1 %", {DegreeMethod::Network, 0.001, 0.01}},
    {"paper, PCA to 1 %", {DegreeMethod::Network, 0.01, 0.01}},
    {"paper, PCA to 5 %", {DegreeMethod::Network, 0.05, 0.01}},
    {"paper, PCA to 10 %", {DegreeMethod::Network, 0.10, 0.01}},
    {"exact", {DegreeMethod::Exact, 0.02, 0.01}},
    {"exact, PCA to 0.1 %", {DegreeMethod::Exact, 0.001, 0.01}},
};

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

void measure(const Arguments& arguments) {
  setThreadLimit(arguments.integer("threads"));
  const Body body = bodyOf(arguments);
  TrainDegreeParams params;
  params.orientations = arguments.integer("orientations");
  params.repeats = arguments.integer("repeats");
  params.gamma = arguments.number("gamma");
  if (params.gamma == 0) params.gamma = gammaFor(body, params, arguments.number("pieces"));
  DropExamples training, tests;
  const double seconds = secondsOf([&] { training = dropsOf(body, params); });
  TrainDegreeParams unseen = params;
  unseen.orientations = arguments.integer("tests");
  unseen.seed = 1001;
  tests = dropsOf(body, unseen);
  const double examples = static_cast<double>(training.drops.size()) * params.repeats;
  std::string report = fmt::format(
      "{}: {} examples in {:.1f} s with {} threads ({:.1f} a second), {} searches, γ = {:.4g} J·m²\n\n",
      fs::path(arguments.text.at("mesh")).stem().string(), examples, seconds, threadLimit(),
      examples / seconds, training.paths, params.gamma);

  Table table({"method", "components", "centres", "error on tests", "share of mean", "R²", "noise", "outside",
               "error left out", "error on training", "fit s", "foretell µs"});
  Table heights({"method", "height m", "searched mean", "searched deviation", "foretold mean",
                 "foretold deviation", "difference / deviation"});
  for (const Method& method : kMethods) {
    DegreeModel model;
    const double fit = secondsOf(
        [&] { model = orExit(learnFromDrops(training, *body.embedding, method.params, Exec{})).model; });
    const Comparison test = compare(body, tests, model), known = compare(body, training, model);
    table.row({method.name, count(static_cast<std::size_t>(model.basis.rows())), count(model.centres.size()),
               number(test.absolute / test.searched.n), percent(test.share()),
               fmt::format("{:.4f}", test.rSquared()), percent(test.noise / test.searched.sum),
               percent(test.outside / static_cast<double>(tests.drops.size())),
               percent(model.errors.meanAbsolute / model.errors.meanDegree), percent(known.share()),
               number(fit), number(test.microseconds)});
    const bool isShown = std::string(method.name) == "best" || std::string(method.name) == "paper";
    for (const auto& [height, both] : test.perHeight) {
      if (!isShown) continue;
      const auto& [searched, foretold] = both;
      heights.row({method.name, number(height), number(searched.mean()), number(searched.deviation()),
                   number(foretold.mean()), number(foretold.deviation()),
                   fmt::format("{:.2f}", (foretold.mean() - searched.mean()) / searched.deviation())});
    }
    fmt::print("{}: {} (R² {:.4f}, noise {})\n", method.name, percent(test.share()), test.rSquared(),
               percent(test.noise / test.searched.sum));
  }
  report += table.markdown() + "\n" + heights.markdown();
  const fs::path out = arguments.text.at("out");
  fs::create_directories(out);
  table.write(out / "methods.csv");
  heights.write(out / "heights.csv");
  fmt::print("\n{}", report);
  if (!arguments.text.at("results").empty())
    writeSection(arguments.text.at("results"),
                 "bench_learn " + fs::path(arguments.text.at("mesh")).stem().string(), report);
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  sherd::bench::Arguments arguments;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (!name.starts_with("--") || !arguments.text.contains(name.substr(2))) {
      fmt::print(stderr, "bench_learn: there is no {}\n", name);
      return 2;
    }
    arguments.text[name.substr(2)] = argv[i + 1];
  }
  sherd::inArena([&] { sherd::bench::measure(arguments); });
  return 0;
}
