// Centroidal Voronoi diagrams: time beside E_D for ways to label and ways to start, and how the time grows.
//
//   bench_cvd [--part paper|scaling|choices|precision]… [--out DIRECTORY] [--results FILE.md]
//
// paper    the paper's models and numbers of sites, in the paper's number of dimensions and in the default
//          embedding, weights by volume and by distance from a corner (a stand-in for an impact): exact
//          labels and flooding; sites grown one at a time (the default), drawn all at once like k-means++,
//          drawn as in the paper (∝ w), and the best of 50 uniform draws
// scaling  over nodes up to a million, and over sites up to 10,000
// choices  E_D beside time of labels, starts, tolerances and relaxations; precision: of float and double
// (cvd_choices.cpp,
//          cvd_precision.cpp)
// Times are medians of 20 (5 beyond 100 ms). Writes CSV, JSON, SVG and Markdown into the directory
// (default build/bench_cvd), and the tables into sections of FILE.md. Other arguments are Google Benchmark's.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/cvd_parts.h"
#include "bench/cvd_runs.h"
#include "bench/measured_table.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;

template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "bench_cvd: {}\n", result.error().text());
  std::exit(1);
}

/// Mean over ten seeds, of E_D over that of the best known.
double meanEnergy(const std::function<Outcome(std::int64_t)>& run) {
  double sum = 0;
  for (std::int64_t seed = 1; seed <= 10; ++seed) sum += run(seed).energy;
  return sum / 10;
}

struct Timed {
  std::string name;
  std::shared_ptr<Outcome> outcome = std::make_shared<Outcome>();
  double ms() const { return medianOf(name); }
};

Timed timed(const std::string& name, const std::function<Outcome()>& run) {
  Timed result{name};
  *result.outcome = run();
  timeOf(name, 20, run, std::function<void(const Outcome&)>{});
  return result;
}

void paperCase(const PaperCase& c, const Body& body, const char* weights, Table& table) {
  const std::string name =
      fmt::format("{}-{}/{}/{}", c.name, c.sites, body.embedding->coordinates.rows(), weights);
  const auto lloyd = timed(name + "/lloyd", [&] { return iterated(drawnApart(body, c.sites, 1)); });
  const auto flood =
      timed(name + "/flood", [&] { return iterated(drawnApart(body, c.sites, 1), Labels::Flood); });
  timeOf(
      name + "/drawn", 20, [&] { return drawnApart(body, c.sites, 1); }, std::function<void(const Lloyd&)>{});
  const auto growth = timed(name + "/grown", [&] { return grown(body, c.sites, 1); });
  runMeasured();
  const double grownMean = meanEnergy([&](std::int64_t s) { return grown(body, c.sites, s); });
  const double apart = meanEnergy([&](std::int64_t s) { return iterated(drawnApart(body, c.sites, s)); });
  const double paper = meanEnergy([&](std::int64_t s) {
    return iterated(drawnAtOnce(body, body.weights.weight, c.sites, static_cast<std::uint64_t>(s)));
  });
  double best = 1e300;
  for (std::uint64_t s = 1; s <= 50; ++s)
    best = std::min(
        best,
        iterated(drawnAtOnce(body, std::vector<double>(body.weights.weight.size(), 1), c.sites, s)).energy);
  table.row({c.name, count(static_cast<std::size_t>(body.embedding->coordinates.cols())),
             count(static_cast<std::size_t>(body.embedding->coordinates.rows())),
             count(static_cast<std::size_t>(c.sites)), weights, number(lloyd.ms()), number(c.goal),
             number(medianOf(name + "/drawn")), number(processorMedianOf(lloyd.name)),
             count(static_cast<std::size_t>(lloyd.outcome->iterations)), number(flood.ms()),
             number(100 * shareOfDifferent(lloyd.outcome->labels, flood.outcome->labels)),
             number(flood.outcome->energy / lloyd.outcome->energy), number(growth.ms()),
             number(processorMedianOf(growth.name) / processorMedianOf(lloyd.name)), number(grownMean / best),
             number(apart / best), number(paper / best)});
}

Table paperTable() {
  return Table({"model", "nodes", "dimensions", "sites", "weights", "lloyd ms", "goal ms",
                "of these drawing, ms", "lloyd cpu ms", "passes", "flood ms", "labels that differ, %",
                "E_D flood / exact", "grown ms", "grown / lloyd, cpu", "E_D grown", "E_D apart", "E_D ∝ w"});
}

void paper(const Options& options, std::string& report) {
  Table byDefault = paperTable(), asPaper = paperTable();
  for (const PaperCase& c : paperCases()) {
    if (!fs::exists(c.path())) {
      report += fmt::format("{}-{} is left out: {} is absent.\n\n", c.name, c.sites, c.file);
      continue;
    }
    for (const bool isDefault : {true, false}) {
      Body body = isDefault ? bodyOf(c) : bodyInPaperDimensions(c);
      Table& table = isDefault ? byDefault : asPaper;
      paperCase(c, body, "volume", table);
      body.weights = hitAtACorner(body.weights);
      paperCase(c, body, "hit", table);
    }
  }
  byDefault.write(options.out / "paper.csv");
  asPaper.write(options.out / "paper_dimensions.csv");
  report +=
      "### The paper's cases\n\nLloyd: from sites drawn apart (∝ w d²) to the end of the iteration; grown: "
      "from one site to N, a few passes after each. The last three columns are means over ten seeds, "
      "over the best of 50 uniform draws. In as many dimensions as the paper's embedding had (modes of the "
      "cage's surface, mean value coordinates, a diffusion of time 0.01 and tolerance 0; walls are convex, "
      "and have their positions):\n\n" +
      asPaper.markdown() + "\nIn the embedding that graphs have by default:\n\n" + byDefault.markdown() +
      "\n";
}

/// Time of ten passes, which is what a pass costs before it has little left to do.
void scalingRow(std::size_t nodes, int sites, Table& table) {
  const Body body = cloud(nodes, 5);
  const LloydLimits ten{.tolerance = 0, .maxIterations = 10};
  const std::string name = fmt::format("{}/{}", nodes, sites);
  const auto start = std::make_shared<Lloyd>(drawnAtOnce(body, body.weights.weight, sites, 3));
  const Eigen::MatrixXd at = start->sites();
  timeOf(
      name,
      nodes * static_cast<std::size_t>(sites) > 10'000'000 ? (nodes > 1'000'000'000u / sites ? 2 : 3) : 10,
      [&] {
        Lloyd lloyd(*body.embedding, body.weights);
        for (Eigen::Index j = 0; j < at.cols(); ++j) lloyd.addSite(at.col(j), Exec{});
        orExit(lloyd.run(ten, Exec{}));
        return lloyd.energy();
      },
      std::function<void(const double&)>{});
  runMeasured();
  table.row(
      {count(nodes), count(static_cast<std::size_t>(sites)), number(medianOf(name)),
       number(processorMedianOf(name)), number(1e3 * processorMedianOf(name) / static_cast<double>(nodes)),
       number(1e6 * processorMedianOf(name) / static_cast<double>(nodes) / static_cast<double>(sites))});
}

void scaling(const Options& options, std::string& report) {
  Table table({"nodes", "sites", "ms", "cpu ms", "cpu µs a node", "cpu ns a node and site"});
  for (const std::size_t nodes : {1000u, 10'000u, 100'000u, 1'000'000u}) scalingRow(nodes, 30, table);
  for (const int sites : {10, 100, 1000, 10'000}) scalingRow(50'000, sites, table);
  scalingRow(1'000'000, 10'000, table);
  table.write(options.out / "scaling.csv");
  report +=
      "### Scaling\n\nAdding all sites and ten passes, in five dimensions.\n\n" + table.markdown() + "\n";
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  using namespace sherd::bench;
  return runParts(argc, argv, "bench_cvd", SHERD_BINARY_DIR, {}, {},
                  {{"paper", paper}, {"scaling", scaling}, {"choices", choices}, {"precision", precision}});
}
