// The metric: how far distances are from the lengths of shortest ways inside, what that costs, and where the
// time goes.
//
//   bench_embed [--part geodesics|spectrum|models|steps]… [--out DIRECTORY] [--results FILE.md]
//
// geodesics  bodies whose shortest ways are known exactly (L, U, ring, spiral): straight distances, both
//            filters and sources, over the number of modes; a plot of error over time
// spectrum   horse and bunny: distances with some modes against those with all (embed_spectrum.cpp)
// models     horse with 74 modes and bunny with 147: every source and extension, against paths through the
//            tetrahedra; a plot of both extensions
// steps      the same models: assembling, factoring, eigenproblem, extension, unfolding, each on its own
// Error is stress: root mean square error of distances over that of lengths, after the best scaling. Times
// are medians of 3. Writes CSV, SVG and Markdown into the directory (default build/bench_embed), and the
// tables into sections of FILE.md. Other arguments are Google Benchmark's.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/embed_parts.h"
#include "bench/marks.h"
#include "bench/measured_table.h"
#include "bench/parts.h"
#include "bench/plot.h"
#include "embed/embed.h"
#include "embed/paths.h"
#include "support/plan_geodesics.h"
#include "support/prepared_cells.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;
using P = EmbedParams;
using Mesh = std::shared_ptr<const TetMesh>;

template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "bench_embed: {}\n", result.error().text());
  std::exit(1);
}

struct Pair {
  Index a, b;
  double length;  ///< of the shortest way
};

double stress(const Embedding& e, const std::vector<Pair>& pairs) {
  double product = 0, square = 0, size = 0;
  for (const Pair& p : pairs) {
    const double d = (e.coordinates.col(p.a) - e.coordinates.col(p.b)).norm();
    product += d * p.length;
    square += d * d;
    size += p.length * p.length;
  }
  return std::sqrt(std::max(0.0, 1 - product * product / (square * size)));
}

std::string nameOf(const P& p) {
  if (p.metric == P::Metric::Euclidean) return "straight";
  const char* source = p.source == P::Source::Solid  ? "solid"
                       : p.source == P::Source::Fine ? "fine"
                                                     : "surface";
  const char* filter = p.filter == P::Filter::Unfolded ? "unfolded"
                       : p.filter == P::Filter::Fitted ? "fitted"
                                                       : "diffusion";
  const char* extension = p.source == P::Source::Solid            ? ""
                          : p.extension == P::Extension::Harmonic ? ", harmonic"
                                                                  : ", mvc";
  return fmt::format("{}, {}{}", filter, source, extension);
}

/// Embeddings of one body, timed together.
struct Measured {
  std::string name;
  P params;
  std::shared_ptr<Embedding> embedding = std::make_shared<Embedding>();
  double ms() const { return medianOf(name); }
  double processorMs() const { return processorMedianOf(name); }
};

std::vector<Measured> measured(const std::string& body, const Mesh& mesh, const std::vector<P>& choices) {
  std::vector<Measured> all;
  for (const P& params : choices) {
    Measured m{fmt::format("{}/{}/{}", body, nameOf(params), params.dimensions), params};
    timeOf(
        m.name, params.source == P::Source::Fine ? 2 : 3, [=] { return orExit(embed(mesh, params, Exec{})); },
        std::function<void(const Embedding&)>([kept = m.embedding](const Embedding& e) { *kept = e; }));
    all.push_back(std::move(m));
  }
  runMeasured();
  return all;
}

struct Body {
  std::string name;
  families::Plan plan;
};

std::vector<Body> bodies() {
  return {
      {"L", families::refined({{"#..", "#..", "###"}, 1}, 3)},
      {"U", families::refined({{"#.#", "#.#", "#.#", "###"}, 1}, 3)},
      {"ring", families::refined({{"####", "#..#", "#..#", "####"}, 1}, 3)},
      {"spiral", families::refined(
                     {{"#######", "......#", "#####.#", "#...#.#", "#.###.#", "#.....#", "#######"}, 1}, 2)}};
}

std::vector<Pair> exactPairs(const families::Plan& plan, const TetMesh& mesh) {
  const families::PlanGeodesics geodesics(plan);
  std::vector<std::vector<double>> reach;
  for (const Vec3& p : mesh.nodes) reach.push_back(geodesics.reach(p));
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < mesh.nodes.size(); a += 3)
    for (std::size_t b = a + 1; b < mesh.nodes.size(); b += 2)
      pairs.push_back({static_cast<Index>(a), static_cast<Index>(b),
                       geodesics.length(mesh.nodes[a], reach[a], mesh.nodes[b], reach[b])});
  return pairs;
}

std::vector<P> choicesOverModes() {
  std::vector<P> all{{.metric = P::Metric::Euclidean}};
  for (const auto filter : {P::Filter::Unfolded, P::Filter::Fitted, P::Filter::Diffusion})
    for (const auto source : {P::Source::Solid, P::Source::Surface})
      for (const int modes : {4, 8, 16, 32, 64, 128})
        all.push_back(
            {.metric = P::Metric::Interior, .source = source, .filter = filter, .dimensions = modes});
  return all;
}

constexpr const char* kDefaultName = "default: unfolded, solid, 32 modes";

bool isDefault(const P& p) {
  return p.metric != P::Metric::Euclidean && p.source == P{}.source && p.filter == P{}.filter &&
         p.dimensions == P{}.dimensions;
}

void geodesics(const Options& options, std::string& report) {
  Table table({"body", "nodes", "choice", "modes", "dimensions", "stress", "ms", "cpu ms"});
  std::vector<Plot> plots;
  for (const Body& body : bodies()) {
    const Mesh mesh = families::shared(body.plan.mesh());
    const std::vector<Pair> pairs = exactPairs(body.plan, *mesh);
    Plot plot{.title = body.name, .xLabel = "processor ms", .yLabel = "stress", .series = {}};
    Series byDefault;
    for (const Measured& m : measured(body.name, mesh, choicesOverModes())) {
      const double error = stress(*m.embedding, pairs);
      const bool straight = m.params.metric == P::Metric::Euclidean;
      table.row({body.name, count(mesh->nodes.size()), nameOf(m.params),
                 straight ? "" : count(static_cast<std::size_t>(m.params.dimensions)),
                 count(static_cast<std::size_t>(m.embedding->coordinates.rows())), number(error),
                 number(m.ms()), number(m.processorMs())});
      if (plot.series.empty() || plot.series.back().name != nameOf(m.params))
        plot.series.push_back({.name = nameOf(m.params), .x = {}, .y = {}});
      plot.series.back().x.push_back(m.processorMs());
      plot.series.back().y.push_back(error);
      if (isDefault(m.params)) byDefault = crossAt(kDefaultName, m.processorMs(), error);
    }
    plot.series.push_back(std::move(byDefault));
    plots.push_back(std::move(plot));
  }
  writePlots(options.out / "geodesics.svg", plots);
  table.write(options.out / "geodesics.csv");
  report +=
      "### Against exact shortest ways\n\nBodies of cubes over a plan. Stress: root mean square error of "
      "distances "
      "over that of lengths, after the best scaling.\n\n" +
      table.markdown() + "\n";
}

std::vector<Pair> pathPairs(const TetMesh& mesh) {
  const PathGraph graph(mesh.nodes, mesh.tets, mesh.neighbours);
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < mesh.nodes.size(); a += 1 + mesh.nodes.size() / 60) {
    const std::vector<double> lengths = graph.lengthsFrom(static_cast<Index>(a));
    for (std::size_t b = 0; b < lengths.size(); ++b)
      if (b != a && std::isfinite(lengths[b]))
        pairs.push_back({static_cast<Index>(a), static_cast<Index>(b), lengths[b]});
  }
  return pairs;
}

struct ModelCase {
  const char* name;
  const char* file;
  int tets, modes;
  double goal, fineGoal;  ///< s
};

std::vector<P> choicesOf(int modes) {
  std::vector<P> all{{.metric = P::Metric::Euclidean, .dimensions = modes}};
  for (const auto filter : {P::Filter::Unfolded, P::Filter::Fitted, P::Filter::Diffusion})
    for (const auto source : {P::Source::Solid, P::Source::Surface, P::Source::Fine})
      for (const auto extension : {P::Extension::Harmonic, P::Extension::MeanValue})
        if (source != P::Source::Solid || extension == P::Extension::Harmonic)
          all.push_back({.metric = P::Metric::Interior,
                         .source = source,
                         .filter = filter,
                         .extension = extension,
                         .dimensions = modes});
  return all;
}

/// Each extension's points, over sources and filters; the default is crossed.
void addToExtensions(Plot& plot, const P& p, double seconds, double error) {
  const char* name = p.metric == P::Metric::Euclidean        ? "straight"
                     : p.source == P::Source::Solid          ? "solid: none needed"
                     : p.extension == P::Extension::Harmonic ? "harmonic"
                                                             : "mean value coordinates";
  auto found =
      std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
  if (found == plot.series.end())
    found = plot.series.insert(found, {.name = name, .x = {}, .y = {}, .style = Series::Style::Points});
  found->x.push_back(seconds);
  found->y.push_back(error);
}

void models(const Options& options, std::string& report) {
  Table table(
      {"model", "triangles", "nodes", "choice", "modes", "dimensions", "stress", "s", "goal s", "cpu s"});
  std::vector<Plot> plots;
  for (const ModelCase& c : {ModelCase{"horse", "../shared/meshes/horse.obj", 5256, 74, 1, 5},
                             ModelCase{"bunny", "../shared/meshes/bunny.obj", 5301, 147, 1, 35}}) {
    const std::string file = std::string(SHERD_SOURCE_DIR "/") + c.file;
    if (!fs::exists(file)) {
      report += fmt::format("{} is left out: {} is absent.\n\n", c.name, c.file);
      continue;
    }
    const auto prepared =
        orExit(test::prepareCells(file, {.tets = c.tets, .counts = {7}}, test::defaultStore()));
    const Mesh mesh = prepared.embedding->tets;
    const std::vector<Pair> pairs = pathPairs(*mesh);
    Plot plot{c.name, "cpu s", "stress", {}};
    Series byDefault;
    for (const Measured& m : measured(c.name, mesh, choicesOf(c.modes))) {
      const bool fine = m.params.source == P::Source::Fine;
      const double error = stress(*m.embedding, pairs), seconds = m.processorMs() / 1000;
      table.row({c.name, count(mesh->surface->triangles.size()), count(mesh->nodes.size()), nameOf(m.params),
                 count(static_cast<std::size_t>(c.modes)),
                 count(static_cast<std::size_t>(m.embedding->coordinates.rows())), number(error),
                 number(m.ms() / 1000), number(fine ? c.fineGoal : c.goal), number(seconds)});
      addToExtensions(plot, m.params, seconds, error);
      if (m.params.metric == P::Metric::Interior && m.params.source == P{}.source &&
          m.params.filter == P{}.filter && m.params.extension == P{}.extension)
        byDefault = crossAt("the default's choice, with so many modes", seconds, error);
    }
    plot.series.push_back(std::move(byDefault));
    plots.push_back(std::move(plot));
  }
  writePlots(options.out / "extensions.svg", plots);
  table.write(options.out / "models.csv");
  report +=
      "### Models\n\nStress against paths through the tetrahedra (which are some percent longer than "
      "geodesics).\n\n" +
      table.markdown() + "\n";
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  using namespace sherd::bench;
  return runParts(argc, argv, "bench_embed", SHERD_BINARY_DIR, {}, {},
                  {{"geodesics", geodesics}, {"spectrum", spectrum}, {"models", models}, {"steps", steps}});
}
