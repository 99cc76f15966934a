// Embeddings with few modes against those with all, and what the steps of one take.
#include <fmt/format.h>
#include <Eigen/CholmodSupport>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "bench/embed_parts.h"
#include "bench/marks.h"
#include "bench/measured_table.h"
#include "bench/or_exit.h"
#include "bench/plot.h"
#include "embed/embed.h"
#include "embed/extension.h"
#include "embed/landmarks.h"
#include "embed/part.h"
#include "embed/spectrum.h"
#include "embed/unfold.h"
#include "geometry/surface_tree.h"
#include "support/prepared_cells.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;
using P = EmbedParams;
using Mesh = std::shared_ptr<const TetMesh>;

struct Model {
  const char* name;
  const char* file;
  int tets, modes;
};

constexpr Model kModels[] = {{"horse", "../shared/meshes/horse.obj", 5256, 74},
                             {"bunny", "../shared/meshes/bunny.obj", 5301, 147}};

/// Null, and said, where the file is absent.
Mesh cageOf(const Model& model, std::string& report) {
  const std::string file = std::string(SHERD_SOURCE_DIR "/") + model.file;
  if (fs::exists(file))
    return orExit(test::prepareCells(file, {.tets = model.tets, .counts = {7}}, test::defaultStore()))
        .embedding->tets;
  report += fmt::format("{} is left out: {} is absent.\n\n", model.name, model.file);
  return nullptr;
}

// Few modes and all.

struct Choice {
  std::string name;
  P params;  ///< with all modes
};

std::vector<Choice> choices() {
  const auto with = [](P::Source source, P::Filter filter, double time) {
    return P{.metric = P::Metric::Interior,
             .source = source,
             .filter = filter,
             .dimensions = 1 << 20,
             .tolerance = 0,
             .time = time};
  };
  return {{"unfolded, solid", with(P::Source::Solid, P::Filter::Unfolded, 0.5)},
          {"diffusion, time 0.5, solid", with(P::Source::Solid, P::Filter::Diffusion, 0.5)},
          {"diffusion, time 0.5, surface", with(P::Source::Surface, P::Filter::Diffusion, 0.5)},
          {"diffusion, time 0.01, surface", with(P::Source::Surface, P::Filter::Diffusion, 0.01)}};
}

/// Root mean square difference of distances over that of the second's, over every 25th node and all.
double difference(const Embedding& a, const Embedding& b) {
  constexpr Eigen::Index kEvery = 25;
  double error = 0, size = 0;
  for (Eigen::Index i = 0; i < a.coordinates.cols(); i += kEvery)
    for (Eigen::Index j = 0; j < a.coordinates.cols(); ++j) {
      const double one = (a.coordinates.col(i) - a.coordinates.col(j)).norm(),
                   other = (b.coordinates.col(i) - b.coordinates.col(j)).norm();
      error += (one - other) * (one - other);
      size += other * other;
    }
  return std::sqrt(error / size);
}

struct Timed {
  Embedding embedding;
  double ms;
};

Timed embedded(const Mesh& mesh, const P& params, int runs) {
  Timed timed;
  timed.ms = leastProcessorMs(runs, [&] { timed.embedding = orExit(embed(mesh, params, Exec{})); });
  return timed;
}

/// One curve; the point of the default number of modes and tolerance is marked on the default's.
void compare(const Model& model, const Mesh& mesh, const Choice& choice, Table& table, Plot& plot,
             std::vector<Series>& marks) {
  const Timed all = embedded(mesh, choice.params, 1);
  Series series{choice.name, {}, {}};
  const auto row = [&](const std::string& modes, const P& params, bool isDrawn) {
    const Timed some = embedded(mesh, params, 2);
    const double error = difference(some.embedding, all.embedding);
    table.row({model.name, choice.name, modes, number(params.tolerance),
               count(static_cast<std::size_t>(some.embedding.coordinates.rows())), scientific(error),
               number(some.ms), number(all.ms)});
    if (!isDrawn) return;
    series.x.push_back(some.ms);
    series.y.push_back(error);
  };
  P params = choice.params;
  for (const int modes : {8, 16, 32, 64, 128}) {
    params.dimensions = modes;
    row(count(static_cast<std::size_t>(modes)), params, true);
    if (modes == P{}.dimensions && params.filter == P{}.filter)
      marks.push_back(crossAt("the default: unfolded, solid, 32 modes", series.x.back(), series.y.back()));
  }
  params.dimensions = P{}.dimensions;
  params.tolerance = P{}.tolerance;
  row(fmt::format("{} (default)", params.dimensions), params, false);
  plot.series.push_back(std::move(series));
}

// What each step takes.

/// Factoring the shift-inverted problem, as lowestModes does.
void factor(const Laplacian& laplacian) {
  const auto n = static_cast<double>(laplacian.mass.size());
  const double shift = -1e-4 * laplacian.stiffness.diagonal().sum() / laplacian.mass.sum() / n;
  Eigen::SparseMatrix<double> shifted = laplacian.stiffness;
  for (Eigen::Index i = 0; i < laplacian.mass.size(); ++i)
    shifted.coeffRef(i, i) -= shift * laplacian.mass[i];
  const Eigen::CholmodSimplicialLDLT<Eigen::SparseMatrix<double>> factored(shifted);
  if (factored.info() != Eigen::Success) fmt::print(stderr, "the Laplacian could not be factored\n");
}

/// A surface whose modes are carried to the nodes of a part.
struct Outer {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
};

/// Rows of nodes that are on the border or outside of the fine surface are given.
struct Given {
  std::vector<char> given;
  Eigen::MatrixXd values;
};

Given onBorder(const BodyPart& part, const Eigen::MatrixXd& functions) {
  Given out{std::vector<char>(part.node.size(), 0),
            Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(part.node.size()), functions.cols())};
  for (std::size_t v = 0; v < part.borderNode.size(); ++v) {
    out.values.row(part.borderNode[v]) = functions.row(static_cast<Eigen::Index>(v));
    out.given[at(part.borderNode[v])] = 1;
  }
  return out;
}

Given fromClosest(const BodyPart& part, const Outer& outer, const Eigen::MatrixXd& functions) {
  Given out{std::vector<char>(part.node.size(), 0),
            Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(part.node.size()), functions.cols())};
  const SurfaceTree tree(outer.positions, outer.triangles);
  for (std::size_t n = 0; n < part.node.size(); ++n) {
    if (tree.contains(part.positions[n])) continue;
    const SurfacePoint nearest = tree.closest(part.positions[n]);
    for (Eigen::Index c = 0; c < 3; ++c)
      out.values.row(static_cast<Eigen::Index>(n)) +=
          nearest.barycentric[c] *
          functions.row(outer.triangles[at(nearest.triangle)][static_cast<std::size_t>(c)]);
    out.given[n] = 1;
  }
  return out;
}

void byMeanValues(const BodyPart& part, const Outer& outer, const Eigen::MatrixXd& functions, Given& at) {
  parallelFor(Exec{}, part.node.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (!at.given[n])
        at.values.row(static_cast<Eigen::Index>(n)) =
            meanValueCoordinates(part.positions[n], outer.positions, outer.triangles).transpose() * functions;
  });
}

void stepsOf(const Model& model, const Mesh& mesh, P::Source source, Table& table) {
  const BodyPart part = bodyParts(*mesh, {mesh->nodes, {}})[0];
  const bool isSolid = source == P::Source::Solid, isFine = source == P::Source::Fine;
  const Outer outer = isFine ? Outer{mesh->surface->positions, mesh->surface->triangles}
                             : Outer{part.borderPositions, part.borderTriangles};
  const int runs = isFine ? 1 : 3;
  Laplacian laplacian;
  const double assembling = leastProcessorMs(runs, [&] {
    laplacian = isSolid ? solidLaplacian(part.positions, part.tets)
                        : surfaceLaplacian(outer.positions, outer.triangles);
  });
  const double factoring = leastProcessorMs(runs, [&] { factor(laplacian); });
  Modes modes;
  const double both =
      leastProcessorMs(runs, [&] { modes = orExit(lowestModes(laplacian, model.modes, Exec{})); });
  Given given;
  double closest = 0, harmonic = 0, meanValues = 0;
  if (!isSolid) {
    closest = leastProcessorMs(runs, [&] {
      given = isFine ? fromClosest(part, outer, modes.functions) : onBorder(part, modes.functions);
    });
    Given copy = given;
    meanValues = closest + leastProcessorMs(runs, [&] { byMeanValues(part, outer, modes.functions, copy); });
    harmonic = closest + leastProcessorMs(runs, [&] {
                 const auto done = extendHarmonically(part.positions, part.tets, given.given, given.values);
                 if (!done.ok()) fmt::print(stderr, "{}\n", done.error().text());
               });
  }
  const Eigen::MatrixXd& functions = isSolid ? modes.functions : given.values;
  const double lengths = leastProcessorMs(3, [&] { orExit(landmarksOf(part, Exec{})); });
  const double unfolding = leastProcessorMs(3, [&] { orExit(unfolded(part, functions, Exec{})); }) - lengths;
  table.row({model.name,
             isSolid  ? "solid"
             : isFine ? "fine"
                      : "surface",
             count(static_cast<std::size_t>(laplacian.mass.size())),
             count(static_cast<std::size_t>(model.modes)), number(assembling), number(factoring),
             number(both - factoring), isSolid ? "" : number(harmonic), isSolid ? "" : number(meanValues),
             number(lengths), number(unfolding), number(assembling + both + harmonic + lengths + unfolding)});
}

}  // namespace

void spectrum(const Options& options, std::string& report) {
  Table table(
      {"model", "choice", "modes", "tolerance", "dimensions", "off by", "cpu ms", "all modes, cpu ms"});
  std::vector<Plot> plots;
  for (const Model& model : kModels) {
    const Mesh mesh = cageOf(model, report);
    if (!mesh) continue;
    Plot plot{fmt::format("{}, {} nodes", model.name, mesh->nodes.size()), "cpu ms", "off by", {}};
    std::vector<Series> marks;
    for (const Choice& choice : choices()) compare(model, mesh, choice, table, plot, marks);
    for (Series& mark : marks) plot.series.push_back(std::move(mark));
    plots.push_back(std::move(plot));
  }
  table.write(options.out / "spectrum.csv");
  writePlots(options.out / "spectrum.svg", plots);
  report +=
      "### Against the full spectrum\n\nDistances with some modes against those with all (a dense "
      "eigenproblem): "
      "root mean square difference over the root mean square distance.\n\n" +
      table.markdown() + "\n";
}

void steps(const Options& options, std::string& report) {
  Table table({"model", "source", "vertices", "modes", "assembling", "factoring", "eigenproblem",
               "extension, harmonic", "extension, mean values", "lengths of ways", "unfolding",
               "sum (harmonic)"});
  for (const Model& model : kModels)
    if (const Mesh mesh = cageOf(model, report))
      for (const auto source : {P::Source::Solid, P::Source::Surface, P::Source::Fine})
        stepsOf(model, mesh, source, table);
  table.write(options.out / "steps.csv");
  report +=
      "### Where the time goes\n\nProcessor ms, of the filter `unfolded`; the least of three runs (of source "
      "fine one run).\n\n" +
      table.markdown() + "\n";
}

}  // namespace sherd::bench
