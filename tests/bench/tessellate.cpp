// Cutting into pieces, from labels to finished pieces in memory: time beside its floor and a peer, how it
// scales, and time beside error.
//
//   bench_tessellate [--part paper|uncut|subdivided|pieces|error]… [--out DIRECTORY] [--results FILE.md]
//                    [--no-peer] [--largest N]
//
// paper       the paper's models and numbers of pieces; exact and canonical cells, one plain copy of the mesh
//             and one of the pieces (the floors), and CGAL's corefinement with convex cells in space (the
//             peer, one run)
// uncut       over triangles that no sheet crosses
// subdivided  over all triangles with the sheets fixed
// pieces      over numbers of sites
// error       distance of crack vertices from the cells' exact borders, and volumes, over four resolutions of
//             the tetrahedra
// Times are medians of 20 (or of N). Writes one CSV, Markdown table and SVG plot per part into the directory
// (default build/bench_tessellate), and all tables into sections of FILE.md. Other arguments are Google
// Benchmark's. Models of ../shared/meshes that are absent are left out, and said.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "bench/clipping_peer.h"
#include "bench/marks.h"
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

/// One plain copy: what it costs to write so much.
template <class T>
void timeCopy(const std::string& name, std::shared_ptr<const T> original, int repetitions) {
  timeOf(
      name, repetitions, [original] { return T(*original); }, std::function<void(const T&)>{});
}

/// Times a copy of what comes out of an exact cut.
std::shared_ptr<const Fragments> timeCopyOfPieces(const std::string& name, const Partition& cells,
                                                  int repetitions) {
  auto pieces = std::make_shared<const Fragments>(cutOrExit(cells, CellMode::Exact));
  timeCopy(name, pieces, repetitions);
  return pieces;
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
               "canonical ms", "canonical cpu ms", "copy of mesh ms", "copy of pieces ms",
               "exact / copy of pieces", "peer ms", "peer cpu ms", "peer / exact", "peer: cells failed"});
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
    timeCut(name + "/exact", cells, CellMode::Exact, options.repetitions);
    timeCut(name + "/canonical", cells, CellMode::Canonical, options.repetitions);
    timeCopy(name + "/copy", surface, options.repetitions);
    const auto pieces = timeCopyOfPieces(name + "/pieces", *cells, options.repetitions);
    fill.push_back([=, &table] {
      const PeerCut peer = options.peer ? cutByCorefinement(*surface, sitesInSpace(*cells)) : PeerCut{};
      const double exact = medianOf(name + "/exact"), copy = medianOf(name + "/pieces");
      table.row({c.name, count(surface->triangles.size()), count(cells->embedding->tets->tets.size()),
                 count(cells->siteCount()), count(pieces->pieces.size()), number(exact),
                 c.goal > 0 ? number(c.goal) : "", number(processorMedianOf(name + "/exact")),
                 number(medianOf(name + "/canonical")), number(processorMedianOf(name + "/canonical")),
                 number(medianOf(name + "/copy")), number(copy), number(exact / copy),
                 options.peer ? number(peer.milliseconds) : "",
                 options.peer ? number(peer.processorMilliseconds) : "",
                 options.peer ? number(peer.milliseconds / exact) : "",
                 options.peer ? count(peer.failed) : ""});
    });
  }
  runMeasured();
  for (const auto& f : fill) f();
  table.write(options.out / "paper.csv");
  report +=
      "### The paper's cases\n\nMedians, in ms; cpu ms is the processor time of all threads. The floors are "
      "plain "
      "copies of the mesh that goes in, and of all that comes out.\n\n" +
      table.markdown() + "\n";
}

// Scaling.

constexpr int kFewRepetitions = 5;  ///< of cuts that take a good part of a second

/// One family of bodies over what grows.
struct Family {
  std::string name, abscissa, about;
  std::vector<double> xs;
  std::function<Cells(double)> make;
};

/// Times the cuts of a family, one after the other, so that only one body is in memory.
void measureFamily(const Family& family, const Options& options, std::string& report) {
  Table table({family.abscissa, "pieces", "cut triangles", "crack triangles", "exact ms", "exact cpu ms",
               "canonical ms", "copy of mesh ms", "copy of pieces ms", "exact / copy of pieces",
               "cpu less that copy, ms", "µs per cut triangle"});
  Series exact{"exact", {}, {}}, canonical{"canonical", {}, {}}, mesh{"copy of the mesh", {}, {}},
      out{"copy of the pieces", {}, {}};
  for (const double x : family.xs) {
    const Cells cells = family.make(x);
    const std::string name = fmt::format("{}/{:g}", family.name, x);
    const bool isLarge = x > 2e6 || cells->siteCount() >= 10'000;
    const int repetitions = isLarge ? std::min(kFewRepetitions, options.repetitions) : options.repetitions;
    timeCut(name + "/exact", cells, CellMode::Exact, repetitions);
    timeCut(name + "/canonical", cells, CellMode::Canonical, repetitions);
    timeCopy(name + "/copy", cells->embedding->tets->surface, repetitions);
    const auto f = timeCopyOfPieces(name + "/pieces", *cells, repetitions);
    runMeasured();
    std::size_t cracks = 0;
    for (const Piece& p : f->pieces) cracks += p.crack.size();
    cracks /= 2;
    const std::size_t cut = f->counts.cutSurfaceTriangles;
    const double e = medianOf(name + "/exact"), floor = medianOf(name + "/pieces");
    const double work = processorMedianOf(name + "/exact") - processorMedianOf(name + "/pieces");
    table.row({count(static_cast<std::size_t>(x)), count(f->pieces.size()), count(cut), count(cracks),
               number(e), number(processorMedianOf(name + "/exact")), number(medianOf(name + "/canonical")),
               number(medianOf(name + "/copy")), number(floor), number(e / floor), number(work),
               number(1000 * work / static_cast<double>(cut + cracks))});
    for (Series* s : {&exact, &canonical, &mesh, &out}) s->x.push_back(x);
    exact.y.push_back(e);
    canonical.y.push_back(medianOf(name + "/canonical"));
    mesh.y.push_back(medianOf(name + "/copy"));
    out.y.push_back(floor);
  }
  table.write(options.out / (family.name + ".csv"));
  writePlots(options.out / (family.name + ".svg"),
             {{"over " + family.abscissa, family.abscissa, "ms", {exact, canonical, mesh, out}}});
  report += fmt::format("#### Over {}\n\n{}\n\n{}\n", family.abscissa, family.about, table.markdown());
}

std::vector<double> sizesUpTo(std::size_t largest) {
  std::vector<double> sizes;
  for (double n = 1e4; n <= static_cast<double>(largest); n *= 10) sizes.push_back(n);
  return sizes;
}

void uncut(const Options& options, std::string& report) {
  measureFamily(
      {"uncut", "uncut triangles", "One ball is cut into 20 cells, another grows beside it.",
       sizesUpTo(options.largest),
       [](double n) {
         const TriMesh both = families::joined(roundedCube(Vec3(-2, 0, 0), 1, 10000),
                                               roundedCube(Vec3(2, 0, 0), 1, static_cast<std::size_t>(n)));
         std::vector<Vec3> sites = sitesInBall(Vec3(-2, 0, 0), 0.9, 20, 1);
         sites.push_back(Vec3(2, 0, 0));
         return std::make_shared<const Partition>(test::euclideanCells(blockAround(both, 30), sites));
       }},
      options, report);
}

void subdivided(const Options& options, std::string& report) {
  measureFamily({"subdivided", "triangles, sheets fixed",
                 "A ball of ever smaller triangles: those cut and their cracks grow with the square root.",
                 sizesUpTo(options.largest),
                 [](double n) {
                   const TriMesh ball = roundedCube(Vec3::Zero(), 1, static_cast<std::size_t>(n));
                   return std::make_shared<const Partition>(
                       test::euclideanCells(blockAround(ball, 12), sitesInBall(Vec3::Zero(), 0.95, 40, 2)));
                 }},
                options, report);
}

void pieces(const Options& options, std::string& report) {
  measureFamily(
      {"pieces",
       "sites",
       "A ball of 160,000 triangles.",
       {10, 100, 1000, 10000},
       [](double n) {
         const TriMesh ball = roundedCube(Vec3::Zero(), 1, 160000);
         return std::make_shared<const Partition>(test::euclideanCells(
             blockAround(ball, 24), sitesInBall(Vec3::Zero(), 0.98, static_cast<std::size_t>(n), 3)));
       }},
      options, report);
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
  std::vector<double> reference;  ///< volumes of cells, found another way
  std::string against;            ///< how, and how exactly
};

constexpr int kSampledPerAxis = 160;
constexpr int kDefaultTets = 5000;

std::vector<ErrorCase> errorCases() {
  std::vector<ErrorCase> cases;
  const std::vector<Vec4> cube{{1, 0, 0, 1},  {-1, 0, 0, 1}, {0, 1, 0, 1},
                               {0, -1, 0, 1}, {0, 0, 1, 1},  {0, 0, -1, 1}};
  for (const int n : {4, 8, 16, 24}) {
    const auto tets = blockAround(families::boxSurface(-Vec3::Ones(), Vec3::Ones(), 16, 16, 16), n);
    const auto cells = std::make_shared<const Partition>(test::nearestCells(
        tets, bent(tets->nodes), bent(sitesInBall(Vec3::Zero(), 1.2, 30, 4)), Embedding::Metric::Interior));
    cases.push_back({"bent box", cells, convexReference(*cells, cube), "convex clipping"});
  }
  std::optional<SamplePoints> points;
  for (const int tets : {1250, 2500, kDefaultTets, 20000}) {
    test::PrepareParams params{.tets = tets, .counts = {48}};
    const auto prepared =
        test::prepareCells(SHERD_SOURCE_DIR "/assets/vase.obj", params, test::defaultStore());
    if (!prepared.ok()) continue;
    const Cells& cells = prepared->cells[0];
    if (!points) points = pointsWithin(*cells->embedding->tets->surface, kSampledPerAxis);
    const SampledVolumes sampled = sampledVolumes(*cells, *points);
    cases.push_back({"vase", cells, sampled.volumes,
                     fmt::format("{} points, ± {}", sampled.points, scientific(sampled.bar))});
  }
  return cases;
}

/// Time over the largest distance of a crack vertex from where it should be.
class ErrorPlots {
 public:
  void add(const std::string& body, const std::string& cells, double ms, double distance) {
    constexpr double kRounding = 1e-17;  // where no distance at all is drawn
    Plot& plot = plots_[body];
    plot.title = body + ", four resolutions";
    plot.xLabel = "ms";
    plot.yLabel = "largest distance / diameter";
    auto series = std::ranges::find_if(plot.series, [&](const Series& s) { return s.name == cells; });
    if (series == plot.series.end()) series = plot.series.insert(plot.series.end(), {cells, {}, {}});
    series->x.push_back(ms);
    series->y.push_back(std::max(distance, kRounding));
  }
  void markDefault(const std::string& body, double ms, double distance) {
    marks_.emplace_back(body, crossAt("the default: exact, 5,000 tetrahedra", ms, distance));
  }
  void write(const fs::path& file) {
    for (auto& [body, mark] : marks_) plots_[body].series.push_back(std::move(mark));
    std::vector<Plot> all;
    for (auto& [body, plot] : plots_) all.push_back(std::move(plot));
    writePlots(file, all);
  }

 private:
  std::map<std::string, Plot> plots_;
  std::vector<std::pair<std::string, Series>> marks_;
};

void error(const Options& options, std::string& report) {
  Table table({"body", "tets", "sites", "cells", "pieces", "ms", "cpu ms", "rms distance", "max distance",
               "largest volume error", "volumes against"});
  ErrorPlots plots;
  int number_ = 0;
  for (const ErrorCase& c : errorCases()) {
    const std::size_t tets = c.cells->embedding->tets->tets.size();
    for (const CellMode mode : {CellMode::Exact, CellMode::Canonical}) {
      const std::string modeName = mode == CellMode::Exact ? "exact" : "canonical";
      const std::string name = fmt::format("error/{}/{}/{}", number_, c.name, modeName);
      timeCut(name, c.cells, mode, options.repetitions);
      runMeasured();
      const Fragments f = cutOrExit(*c.cells, mode);
      const CrackError distance = crackError(f, *c.cells);
      table.row({c.name, count(tets), count(c.cells->siteCount()), modeName, count(f.pieces.size()),
                 number(medianOf(name)), number(processorMedianOf(name)), scientific(distance.rms),
                 scientific(distance.maximum), scientific(largestDifference(cellVolumes(f), c.reference)),
                 c.against});
      plots.add(c.name, modeName, medianOf(name), distance.maximum);
      if (c.name == "vase" && mode == CellMode::Exact && tets > 0.8 * kDefaultTets &&
          tets < 1.2 * kDefaultTets)
        plots.markDefault(c.name, medianOf(name), distance.maximum);
    }
    ++number_;
  }
  table.write(options.out / "error.csv");
  plots.write(options.out / "error.svg");
  report +=
      "### Error beside time\n\nDistances of crack vertices from the cells' exact borders, over the diameter "
      "of the embedding; volumes of cells over the body's: against cells clipped in another way, or against "
      "points drawn in the body, each counted for the site that is nearest in the embedding (± : by how much "
      "two sets of points differ at most, halved).\n\n" +
      table.markdown() + "\n";
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  using namespace sherd::bench;
  return runParts(
      argc, argv, "bench_tessellate", SHERD_BINARY_DIR, {}, {"--largest", "--repetitions", "--no-peer"},
      {{"paper", paper}, {"uncut", uncut}, {"subdivided", subdivided}, {"pieces", pieces}, {"error", error}});
}
