// Cutting into pieces, from labels to finished pieces in memory: time beside its floor and a peer, how it
// scales, and time beside error.
//
//   bench_tessellate [--part paper|scaling|error]… [--out DIRECTORY] [--results FILE.md] [--no-peer]
//   [--largest N]
//
// paper    the paper's models and numbers of pieces; exact and canonical cells, one plain copy of the mesh
// (the
//          floor), and CGAL's corefinement with convex cells in space (the peer, one run)
// scaling  over triangles that no sheet crosses, over all triangles with the sheets fixed, and over pieces
// error    distance of crack vertices from the cells' exact borders, and volumes, over four resolutions of
// the
//          tetrahedra
// Times are medians of 20 (or of N). Writes one CSV, Markdown table and SVG plot per part into the directory
// (default build/bench_tessellate), and all tables into sections of FILE.md. Other arguments are Google
// Benchmark's. Models of ../shared/meshes that are absent are left out, and said.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "bench/clipping_peer.h"
#include "bench/measured_table.h"
#include "bench/parts.h"
#include "bench/plot.h"
#include "bench/scaled_bodies.h"
#include "bench/tessellate_error.h"
#include "support/nearest_cells.h"
#include "support/prepared_cells.h"
#include "support/surface_families.h"
#include "tessellate/tessellate.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;
using Cells = std::shared_ptr<const Partition>;

TessellateParams paramsOf(CellMode mode) {
  TessellateParams params;
  params.cells = mode;
  return params;
}

Fragments cutOrExit(const Partition& cells, CellMode mode) {
  auto result = tessellate(cells, paramsOf(mode), Exec{});
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "bench_tessellate: {}\n", result.error().text());
  std::exit(1);
}

/// Registers a benchmark of cutting; what it made is told to `made` once.
void timeCut(const std::string& name, Cells cells, CellMode mode, int repetitions,
             std::function<void(const Fragments&)> made = {}) {
  timeOf(
      name, repetitions, [cells, mode] { return cutOrExit(*cells, mode); }, std::move(made));
}

void timeCopy(const std::string& name, std::shared_ptr<const TriMesh> mesh, int repetitions) {
  timeOf(
      name, repetitions, [mesh] { return TriMesh(*mesh); }, std::function<void(const TriMesh&)>{});
}

// The paper's cases.

struct PaperCase {
  const char* name;
  const char* file;
  int tets;
  int sites;
  double goal;  ///< ms
};

const PaperCase kPaper[] = {
    {"horse", "../shared/meshes/horse.obj", 5256, 7, 0},
    {"horse", "../shared/meshes/horse.obj", 5256, 67, 20},
    {"bunny", "../shared/meshes/bunny.obj", 5301, 3, 0},
    {"bunny", "../shared/meshes/bunny.obj", 5301, 48, 30},
    {"wall", "assets/wall.obj", 1408, 3, 0},
    {"wall", "assets/wall.obj", 1408, 18, 3},
    {"mushroom", "assets/mushroom.obj", 1309, 5, 0},
    {"mushroom", "assets/mushroom.obj", 1309, 81, 5},
};

/// Where cells in space would have their sites: the mean of each cell's nodes.
std::vector<Vec3> sitesInSpace(const Partition& cells) {
  std::vector<Vec3> sums(cells.siteCount(), Vec3::Zero());
  std::vector<double> counts(cells.siteCount(), 0);
  for (std::size_t n = 0; n < cells.label.size(); ++n) {
    sums[at(cells.label[n])] += cells.embedding->tets->nodes[n];
    ++counts[at(cells.label[n])];
  }
  std::vector<Vec3> sites;
  for (std::size_t s = 0; s < sums.size(); ++s)
    if (counts[s] > 0) sites.push_back(sums[s] / counts[s]);
  return sites;
}

void paper(const Options& options, std::string& report) {
  Table table({"model", "triangles", "tets", "sites", "pieces", "exact ms", "goal ms", "exact cpu ms",
               "canonical ms", "canonical cpu ms", "copy ms", "exact / copy", "peer ms", "peer cpu ms",
               "peer / exact", "peer: cells failed"});
  std::map<std::string, std::function<void()>> rows;
  std::vector<std::function<void()>> fill;
  for (const PaperCase& c : kPaper) {
    const std::string file = std::string(SHERD_SOURCE_DIR "/") + c.file,
                      name = fmt::format("{}-{}", c.name, c.sites);
    if (!fs::exists(file)) {
      report += fmt::format("{} is left out: {} is absent.\n\n", name, c.file);
      continue;
    }
    test::PrepareParams params{.tets = c.tets, .counts = {c.sites}};
    const auto prepared = test::prepareCells(file, params, test::defaultStore());
    if (!prepared.ok()) {
      report += fmt::format("{} is left out: {}.\n\n", name, prepared.error().text());
      continue;
    }
    const Cells cells = prepared->cells[0];
    const auto surface = cells->embedding->tets->surface;
    const auto pieces = std::make_shared<std::size_t>(0);
    timeCut(name + "/exact", cells, CellMode::Exact, options.repetitions,
            [pieces](const Fragments& f) { *pieces = f.pieces.size(); });
    timeCut(name + "/canonical", cells, CellMode::Canonical, options.repetitions);
    timeCopy(name + "/copy", surface, options.repetitions);
    fill.push_back([=, &table] {
      const PeerCut peer = options.peer ? cutByCorefinement(*surface, sitesInSpace(*cells)) : PeerCut{};
      const double exact = medianOf(name + "/exact"), copy = medianOf(name + "/copy");
      table.row({c.name, count(surface->triangles.size()), count(cells->embedding->tets->tets.size()),
                 count(cells->siteCount()), count(*pieces), number(exact), c.goal > 0 ? number(c.goal) : "",
                 number(processorMedianOf(name + "/exact")), number(medianOf(name + "/canonical")),
                 number(processorMedianOf(name + "/canonical")), number(copy), number(exact / copy),
                 options.peer ? number(peer.milliseconds) : "",
                 options.peer ? number(peer.processorMilliseconds) : "",
                 options.peer ? number(peer.milliseconds / exact) : "",
                 options.peer ? count(peer.failed) : ""});
    });
  }
  runMeasured();
  for (const auto& f : fill) f();
  table.write(options.out / "paper.csv");
  report += "### The paper's cases\n\nMedians, in ms; cpu ms is the processor time of all threads.\n\n" +
            table.markdown() + "\n";
}

// Scaling.

struct Scaled {
  std::string name;
  double x;
  Cells cells;
};

/// Times cuts of one family, one after the other, so that only one body is in memory.
void family(const std::string& title, const std::string& abscissa, const std::vector<double>& xs,
            const std::function<Cells(double)>& make, const Options& options, std::string& report,
            std::vector<Plot>& plots) {
  Table table({abscissa, "pieces", "cut triangles", "crack triangles", "exact ms", "exact cpu ms",
               "canonical ms", "copy ms", "cpu without copy, ms", "µs per cut triangle"});
  Series exact{"exact", {}, {}}, canonical{"canonical", {}, {}}, copy{"copy of the mesh", {}, {}};
  for (const double x : xs) {
    const Cells cells = make(x);
    const std::string name = fmt::format("{}/{:g}", title, x);
    const int repetitions = x > 2e6 ? std::min(5, options.repetitions) : options.repetitions;
    auto counts = std::make_shared<std::array<std::size_t, 3>>();
    timeCut(name + "/exact", cells, CellMode::Exact, repetitions, [counts](const Fragments& f) {
      std::size_t cracks = 0;
      for (const Piece& p : f.pieces) cracks += p.crack.size();
      *counts = {f.pieces.size(), f.counts.cutSurfaceTriangles, cracks / 2};
    });
    timeCut(name + "/canonical", cells, CellMode::Canonical, repetitions);
    timeCopy(name + "/copy", cells->embedding->tets->surface, repetitions);
    runMeasured();
    const double e = medianOf(name + "/exact"), c = medianOf(name + "/copy");
    const double work = processorMedianOf(name + "/exact") - processorMedianOf(name + "/copy");
    const auto [pieces, cut, cracks] = *counts;
    table.row({count(static_cast<std::size_t>(x)), count(pieces), count(cut), count(cracks), number(e),
               number(processorMedianOf(name + "/exact")), number(medianOf(name + "/canonical")), number(c),
               number(work), number(1000 * work / static_cast<double>(cut + cracks))});
    for (Series* s : {&exact, &canonical, &copy}) s->x.push_back(x);
    exact.y.push_back(e);
    canonical.y.push_back(medianOf(name + "/canonical"));
    copy.y.push_back(c);
  }
  table.write(options.out / (title + ".csv"));
  report += fmt::format("#### Over {}\n\n{}\n", abscissa, table.markdown());
  plots.push_back({"over " + abscissa, abscissa, "ms", {exact, canonical, copy}});
}

void scaling(const Options& options, std::string& report) {
  std::vector<Plot> plots;
  report +=
      "### Scaling\n\nµs per cut triangle: processor time without the copy, over surface triangles cut plus "
      "crack "
      "triangles made.\n\n";
  std::vector<double> sizes;
  for (double n = 1e4; n <= static_cast<double>(options.largest); n *= 10) sizes.push_back(n);
  family(
      "uncut", "uncut triangles", sizes,
      [](double n) {
        // One ball is cut into 20 cells, the other grows.
        const TriMesh both = families::joined(roundedCube(Vec3(-2, 0, 0), 1, 10000),
                                              roundedCube(Vec3(2, 0, 0), 1, static_cast<std::size_t>(n)));
        std::vector<Vec3> sites = sitesInBall(Vec3(-2, 0, 0), 0.9, 20, 1);
        sites.push_back(Vec3(2, 0, 0));
        return std::make_shared<const Partition>(test::euclideanCells(blockAround(both, 30), sites));
      },
      options, report, plots);
  family(
      "subdivided", "triangles, sheets fixed", sizes,
      [](double n) {
        const TriMesh ball = roundedCube(Vec3::Zero(), 1, static_cast<std::size_t>(n));
        return std::make_shared<const Partition>(
            test::euclideanCells(blockAround(ball, 12), sitesInBall(Vec3::Zero(), 0.95, 40, 2)));
      },
      options, report, plots);
  family(
      "pieces", "sites", {10, 100, 1000, 10000},
      [](double n) {
        const TriMesh ball = roundedCube(Vec3::Zero(), 1, 160000);
        return std::make_shared<const Partition>(test::euclideanCells(
            blockAround(ball, 24), sitesInBall(Vec3::Zero(), 0.98, static_cast<std::size_t>(n), 3)));
      },
      options, report, plots);
  writePlots(options.out / "scaling.svg", plots);
}

// Error.

/// Places bent into five dimensions, so that borders curve.
Eigen::MatrixXd bent(const std::vector<Vec3>& points) {
  Eigen::MatrixXd x(5, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    x.col(static_cast<Eigen::Index>(i)) << p.x(), p.y(), p.z(), 0.4 * std::sin(2 * p.x() + p.z()),
        0.4 * p.y() * p.z();
  }
  return x;
}

struct ErrorCase {
  std::string name;
  Cells cells;
  std::vector<double> reference;  ///< volumes of cells; empty: those of exact cells
};

std::vector<ErrorCase> errorCases() {
  std::vector<ErrorCase> cases;
  const std::vector<Vec4> cube{{1, 0, 0, 1},  {-1, 0, 0, 1}, {0, 1, 0, 1},
                               {0, -1, 0, 1}, {0, 0, 1, 1},  {0, 0, -1, 1}};
  for (const int n : {4, 8, 16, 24}) {
    const auto tets = blockAround(families::boxSurface(-Vec3::Ones(), Vec3::Ones(), 16, 16, 16), n);
    const auto cells = std::make_shared<const Partition>(test::nearestCells(
        tets, bent(tets->nodes), bent(sitesInBall(Vec3::Zero(), 1.2, 30, 4)), Embedding::Metric::Interior));
    cases.push_back({"bent box", cells, convexReference(*cells, cube)});
  }
  for (const int tets : {1250, 2500, 5000, 20000}) {
    test::PrepareParams params{.tets = tets, .counts = {48}};
    const auto prepared =
        test::prepareCells(SHERD_SOURCE_DIR "/assets/vase.obj", params, test::defaultStore());
    if (prepared.ok()) cases.push_back({"vase", prepared->cells[0], {}});
  }
  return cases;
}

void error(const Options& options, std::string& report) {
  Table table({"body", "tets", "sites", "cells", "pieces", "ms", "cpu ms", "rms distance", "max distance",
               "largest volume error", "volumes against"});
  std::map<std::string, Plot> plots;
  int number_ = 0;
  for (const ErrorCase& c : errorCases()) {
    std::vector<double> reference = c.reference;
    for (const CellMode mode : {CellMode::Exact, CellMode::Canonical}) {
      const std::string modeName = mode == CellMode::Exact ? "exact" : "canonical";
      const std::string name = fmt::format("error/{}/{}/{}", number_, c.name, modeName);
      timeCut(name, c.cells, mode, options.repetitions);
      runMeasured();
      const Fragments f = cutOrExit(*c.cells, mode);
      const CrackError distance = crackError(f, *c.cells);
      const std::vector<double> volumes = cellVolumes(f);
      if (reference.empty()) reference = volumes;
      table.row({c.name, count(c.cells->embedding->tets->tets.size()), count(c.cells->siteCount()), modeName,
                 count(f.pieces.size()), number(medianOf(name)), number(processorMedianOf(name)),
                 scientific(distance.rms), scientific(distance.maximum),
                 scientific(largestDifference(volumes, reference)),
                 c.reference.empty() ? "exact cells" : "convex clipping"});
      Plot& plot = plots[c.name];
      plot.title = c.name + ", four resolutions";
      plot.xLabel = "largest distance / diameter";
      plot.yLabel = "ms";
      auto series = std::find_if(plot.series.begin(), plot.series.end(),
                                 [&](const Series& s) { return s.name == modeName; });
      if (series == plot.series.end()) series = plot.series.insert(plot.series.end(), {modeName, {}, {}});
      series->x.push_back(std::max(distance.maximum, 1e-17));
      series->y.push_back(medianOf(name));
    }
    ++number_;
  }
  table.write(options.out / "error.csv");
  std::vector<Plot> all;
  for (auto& [name, plot] : plots) all.push_back(std::move(plot));
  writePlots(options.out / "error.svg", all);
  report +=
      "### Error beside time\n\nDistances of crack vertices from the cells' exact borders, over the diameter "
      "of the embedding; "
      "volumes of cells over the body's.\n\n" +
      table.markdown() + "\n";
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  using namespace sherd::bench;
  return runParts(argc, argv, "bench_tessellate", SHERD_BINARY_DIR, {},
                  {"--largest", "--repetitions", "--no-peer"},
                  {{"paper", paper}, {"scaling", scaling}, {"error", error}});
}
