// The columns of Tables 1 and 2 of Schvartzman and Otaduy (2014) (learn_parts.h).
#include <fmt/format.h>

#include "bench/learn_parts.h"
#include "bench/measured_table.h"
#include "cvd/cvd.h"
#include "simulate/simulate.h"
#include "tessellate/tessellate.h"
#include "weights/weights.h"

namespace sherd::bench {
namespace {

constexpr int kRuns = 10;

struct PaperModel {
  const char* name;
  const char* file;
  int triangles, tets, nodes;
  const char *dimensions, *centres;
  double gamma;  ///< J·m², of the network's drops, as the other parts have it; 0: for about 20 pieces
  struct Fracture {
    int degree, iterations;
    double cells, cutting;  ///< ms
  } fractures[2];
};

const PaperModel kModels[] = {
    {"horse",
     "../shared/meshes/horse.obj",
     38016,
     5256,
     1595,
     "74",
     "38",
     1e-3,
     {{7, 4, 15, 65}, {67, 15, 37, 233}}},
    {"wall", "assets/wall.obj", 4800, 1408, 582, "-", "18", 0, {{3, 7, 7, 24}, {18, 3, 7, 58}}},
    {"bunny",
     "../shared/meshes/bunny.obj",
     163584,
     5301,
     1477,
     "147",
     "45",
     7.252,
     {{3, 13, 49, 213}, {48, 18, 67, 272}}},
    {"mushroom",
     "assets/mushroom.obj",
     768,
     1309,
     433,
     "250",
     "90",
     1e-4,
     {{5, 10, 26, 23}, {81, 18, 21, 45}}}};

std::string both(const std::string& ours, const std::string& paper) { return ours + " / " + paper; }
std::string both(std::size_t ours, int paper) { return both(count(ours), std::to_string(paper)); }

/// Centres of the paper's network on the paper's protocol.
std::size_t centresOf(const Body& body, const TrainDegreeParams& params) {
  return orExit(learnFromDrops(dropsOf(body, params), *body.embedding, paperMethod(), Exec{}))
      .model.centres.size();
}

WeightField hitOf(const Body& body) {
  SimulateParams drop;
  drop.orientation = Vec3(25, 0, 15);
  return orExit(weights(orExit(simulate(body.tets, drop, Exec{})).energy, nullptr, {}, Exec{}));
}

void addModel(const PaperModel& paper, Table& resolution, Table& times) {
  const std::string file = std::string(SHERD_SOURCE_DIR) + "/" + paper.file;
  if (!std::filesystem::exists(file)) {
    fmt::print("{} is not there: {} is left out\n", file, paper.name);
    return;
  }
  const Body body = bodyOf(file, paper.tets);
  const bool isStraight = body.embedding->metric == Embedding::Metric::Euclidean;
  TrainDegreeParams params;
  params.gamma = paper.gamma > 0 ? paper.gamma : gammaFor(body, params, 20);
  resolution.row({paper.name, both(body.tets->surface->triangles.size(), paper.triangles),
                  both(body.tets->tets.size(), paper.tets), both(body.tets->nodes.size(), paper.nodes),
                  both(isStraight ? "-" : count(static_cast<std::size_t>(body.embedding->coordinates.rows())),
                       paper.dimensions),
                  fmt::format("{:.4g}", params.gamma), both(count(centresOf(body, params)), paper.centres)});
  const WeightField hit = hitOf(body);
  for (const PaperModel::Fracture& f : paper.fractures) {
    Partition cells;
    Fragments pieces;
    const double cellsMs = 1000 * leastSecondsOf(kRuns, [&] {
                             cells = orExit(cvd(body.embedding, hit, nullptr, {.degree = f.degree}, Exec{}));
                           });
    const double cuttingMs =
        1000 * leastSecondsOf(kRuns, [&] { pieces = orExit(tessellate(cells, {}, Exec{})); });
    times.row({paper.name, count(cells.siteCount()), count(pieces.pieces.size()),
               both(count(static_cast<std::size_t>(cells.iterations)), std::to_string(f.iterations)),
               both(number(cellsMs), number(f.cells)), both(number(cuttingMs), number(f.cutting)),
               fmt::format("{:.0f} ×", f.cells / cellsMs), fmt::format("{:.0f} ×", f.cutting / cuttingMs)});
  }
}

}  // namespace

std::string paperPart() {
  Table resolution({"model", "triangles", "tetrahedra", "nodes", "dimensions", "γ, J·m²", "centres"});
  Table times({"model", "degree", "pieces", "iterations", "CVD ms", "cutting ms", "CVD", "cutting"});
  for (const PaperModel& model : kModels) addModel(model, resolution, times);
  return "Ours / the paper's, which ran on eight threads of an i7-2600; ours are the least of ten runs. "
         "Dimensions: "
         "of the space in which cells are found; centres: of the paper's network, made of the paper's 1,152 "
         "drops at γ. CVD: growing to that degree and Lloyd's iteration to its end, whose passes are "
         "counted. "
         "Cutting: "
         "exact cells.\n\n" +
         resolution.markdown() + "\n" + times.markdown();
}

}  // namespace sherd::bench
