// Centroidal Voronoi diagrams: time beside E_D for ways to label and ways to start, and how the time grows.
//
//   bench_cvd [--part paper|scaling]… [--out DIRECTORY] [--results FILE.md]
//
// paper    the paper's models and numbers of sites, weights by volume and by distance from a corner (a
// stand-in
//          for an impact): exact labels and flooding; sites grown one at a time (the default), drawn all at
//          once like k-means++, drawn as in the paper (∝ w), and the best of 50 uniform draws
// scaling  over nodes up to a million, and over sites up to 10,000
// Times are medians of 20 (5 beyond 100 ms). Writes CSV and Markdown into the directory (default
// build/bench_cvd), and both tables into sections of FILE.md. Other arguments are Google Benchmark's.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/rng.h"
#include "bench/measured_table.h"
#include "bench/parts.h"
#include "cvd/cvd.h"
#include "support/prepared_cells.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;

struct Body {
  std::shared_ptr<const Embedding> embedding;
  WeightField weights;
};

/// What a run ended with.
struct Outcome {
  double energy = 0;
  int iterations = 0;
  std::vector<Index> labels;
};

constexpr std::uint64_t kStream = 0x62656e63;

template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "bench_cvd: {}\n", result.error().text());
  std::exit(1);
}

/// Nodes drawn with probability ∝ amount, each on its own.
Lloyd drawnAtOnce(const Body& body, const std::vector<double>& amount, int count, std::uint64_t seed) {
  Lloyd lloyd(*body.embedding, body.weights);
  double total = 0;
  for (const double a : amount) total += a;
  for (int k = 0; k < count; ++k) {
    double left = total * Rng(seed, kStream).uniformAt(static_cast<std::uint64_t>(k));
    std::size_t n = 0;
    while (n + 1 < amount.size() && left >= amount[n]) left -= amount[n++];
    lloyd.addSite(body.embedding->coordinates.col(static_cast<Eigen::Index>(n)), Exec{});
  }
  return lloyd;
}

/// Each ∝ w d² to those before, without an iteration between.
Lloyd drawnApart(const Body& body, int count, std::int64_t seed) {
  Lloyd lloyd(*body.embedding, body.weights);
  lloyd.addSite(bodyCentroid(*body.embedding, body.weights), Exec{});
  for (int k = 1; k < count; ++k)
    if (const auto node = drawSite(lloyd, *body.embedding, body.weights, Growth::ByVolume, seed))
      lloyd.addSite(body.embedding->coordinates.col(*node), Exec{});
  return lloyd;
}

Outcome outcomeOf(const Lloyd& lloyd, int iterations) { return {lloyd.energy(), iterations, lloyd.labels()}; }

Outcome iterated(Lloyd lloyd, Labels labels = Labels::Exact) {
  const LloydLimits limits;
  const auto end =
      orExit(labels == Labels::Exact ? lloyd.run(limits, Exec{}) : lloyd.runFlood(limits, Exec{}));
  return outcomeOf(lloyd, end.iterations);
}

Outcome grown(const Body& body, int count, std::int64_t seed) {
  Lloyd lloyd(*body.embedding, body.weights);
  lloyd.addSite(bodyCentroid(*body.embedding, body.weights), Exec{});
  int steps = 0;
  while (static_cast<int>(lloyd.siteCount()) < count &&
         orExit(growSite(lloyd, *body.embedding, body.weights, Growth::ByVolume, seed, Exec{})))
    ++steps;
  return iterated(std::move(lloyd));
}

/// Strain energy falls off from where a body is hit: weights by distance from the first corner of its box.
WeightField hitAtACorner(const WeightField& volumes) {
  WeightField field = volumes;
  const Box box = boxOf(volumes.tets->nodes);
  for (std::size_t n = 0; n < field.weight.size(); ++n) {
    const double r = (volumes.tets->nodes[n] - box.low).norm() / box.diagonal();
    field.weight[n] = volumes.volume[n] / std::pow(0.02 + r, 4);
  }
  return field;
}

struct PaperCase {
  const char* name;
  const char* file;
  int tets, sites;
  double goal;  ///< ms
};

const PaperCase kPaper[] = {
    {"horse", "../shared/meshes/horse.obj", 5256, 7, 1}, {"horse", "../shared/meshes/horse.obj", 5256, 67, 4},
    {"bunny", "../shared/meshes/bunny.obj", 5301, 3, 1}, {"bunny", "../shared/meshes/bunny.obj", 5301, 48, 4},
    {"mushroom", "assets/mushroom.obj", 1309, 5, 2},     {"mushroom", "assets/mushroom.obj", 1309, 81, 3},
    {"wall", "assets/wall.obj", 1408, 3, 0.5},           {"wall", "assets/wall.obj", 1408, 18, 0.5},
};

double shareOfDifferent(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) different += a[i] != b[i];
  return static_cast<double>(different) / static_cast<double>(a.size());
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
  const std::string name = fmt::format("{}-{}/{}", c.name, c.sites, weights);
  const auto lloyd = timed(name + "/lloyd", [&] { return iterated(drawnApart(body, c.sites, 1)); });
  const auto flood =
      timed(name + "/flood", [&] { return iterated(drawnApart(body, c.sites, 1), Labels::Flood); });
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
             number(processorMedianOf(lloyd.name)),
             count(static_cast<std::size_t>(lloyd.outcome->iterations)), number(flood.ms()),
             number(100 * shareOfDifferent(lloyd.outcome->labels, flood.outcome->labels)),
             number(flood.outcome->energy / lloyd.outcome->energy), number(growth.ms()),
             number(processorMedianOf(growth.name) / processorMedianOf(lloyd.name)), number(grownMean / best),
             number(apart / best), number(paper / best)});
}

void paper(const Options& options, std::string& report) {
  Table table({"model", "nodes", "dimensions", "sites", "weights", "lloyd ms", "goal ms", "lloyd cpu ms",
               "passes", "flood ms", "labels that differ, %", "E_D flood / exact", "grown ms",
               "grown / lloyd, cpu", "E_D grown", "E_D apart", "E_D ∝ w"});
  for (const PaperCase& c : kPaper) {
    const std::string file = std::string(SHERD_SOURCE_DIR "/") + c.file;
    if (!fs::exists(file)) {
      report += fmt::format("{}-{} is left out: {} is absent.\n\n", c.name, c.sites, c.file);
      continue;
    }
    const auto prepared =
        orExit(test::prepareCells(file, {.tets = c.tets, .counts = {c.sites}}, test::defaultStore()));
    Body body{prepared.embedding, test::volumeWeights(prepared.embedding->tets)};
    paperCase(c, body, "volume", table);
    body.weights = hitAtACorner(body.weights);
    paperCase(c, body, "hit", table);
  }
  table.write(options.out / "paper.csv");
  report +=
      "### The paper's cases\n\nLloyd: from sites drawn apart (∝ w d²) to the end of the iteration; grown: "
      "from one site to N, a few passes after each. The last three columns are means over ten seeds, "
      "over the best of 50 uniform draws.\n\n" +
      table.markdown() + "\n";
}

/// Points in a box of five dimensions, two of which bend.
Body cloud(std::size_t nodes) {
  auto embedding = std::make_shared<Embedding>();
  embedding->tets = std::make_shared<TetMesh>();
  embedding->coordinates.resize(5, static_cast<Eigen::Index>(nodes));
  const Rng rng(7, kStream);
  for (std::size_t n = 0; n < nodes; ++n) {
    const double x = rng.uniformAt(3 * n), y = rng.uniformAt(3 * n + 1), z = rng.uniformAt(3 * n + 2);
    embedding->coordinates.col(static_cast<Eigen::Index>(n)) << x, y, z, 0.3 * std::sin(2 * x + z),
        0.3 * y * z;
  }
  embedding->diameter = 2;
  Body body{embedding, {}};
  body.weights.weight.assign(nodes, 1.0);
  body.weights.volume.assign(nodes, 1.0);
  return body;
}

/// Time of ten passes, which is what a pass costs before it has little left to do.
void scalingRow(std::size_t nodes, int sites, Table& table) {
  const Body body = cloud(nodes);
  const LloydLimits ten{.tolerance = 0, .maxIterations = 10};
  const std::string name = fmt::format("{}/{}", nodes, sites);
  const auto start = std::make_shared<Lloyd>(drawnAtOnce(body, body.weights.weight, sites, 3));
  const Eigen::MatrixXd at = start->sites();
  timeOf(
      name, nodes * static_cast<std::size_t>(sites) > 10'000'000 ? 3 : 10,
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
       number(processorMedianOf(name)),
       number(1e6 * processorMedianOf(name) / static_cast<double>(nodes) / static_cast<double>(sites))});
}

void scaling(const Options& options, std::string& report) {
  Table table({"nodes", "sites", "ms", "cpu ms", "cpu ns a node and site"});
  for (const std::size_t nodes : {1000u, 10'000u, 100'000u, 1'000'000u}) scalingRow(nodes, 30, table);
  for (const int sites : {10, 100, 1000, 10'000}) scalingRow(50'000, sites, table);
  table.write(options.out / "scaling.csv");
  report +=
      "### Scaling\n\nAdding all sites and ten passes, in five dimensions.\n\n" + table.markdown() + "\n";
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  using namespace sherd::bench;
  return runParts(argc, argv, "bench_cvd", SHERD_BINARY_DIR, {}, {},
                  {{"paper", paper}, {"scaling", scaling}});
}
