#include "bench/cages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <limits>

#include "bench/conforming.h"
#include "bench/measured_table.h"
#include "bench/or_exit.h"
#include "bench/plot.h"
#include "load_mesh/load_mesh.h"
#include "simulate/simulate.h"
#include "tetrahedralize/tetrahedralize.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;
using Shared = std::shared_ptr<const TetMesh>;
constexpr std::size_t kParts = 20;  // of the body, whose shares of the energy are compared
constexpr double kPatches[] = {1, 2};

struct Model {
  const char* name;
  double edge;       ///< of the fine mesh, shares of the bounding box's diagonal
  std::size_t step;  ///< vertices of the surface that it starts from: every one of so many
};

/// Places far from each other on the surface: every node belongs to the nearest.
std::vector<Vec3> placesOn(const TriMesh& surface) {
  std::vector<Vec3> places{surface.positions[0]};
  std::vector<double> distance(surface.positions.size(), std::numeric_limits<double>::infinity());
  while (places.size() < kParts) {
    for (std::size_t i = 0; i < distance.size(); ++i)
      distance[i] = std::min(distance[i], (surface.positions[i] - places.back()).norm());
    const auto farthest = std::max_element(distance.begin(), distance.end()) - distance.begin();
    places.push_back(surface.positions[static_cast<std::size_t>(farthest)]);
  }
  return places;
}

std::vector<double> sharesOf(const TetMesh& mesh, const ImpactEnergy& energy,
                             const std::vector<Vec3>& places) {
  std::vector<double> shares(places.size(), 0.0);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    std::size_t nearest = 0;
    for (std::size_t p = 1; p < places.size(); ++p)
      if ((mesh.nodes[n] - places[p]).squaredNorm() < (mesh.nodes[n] - places[nearest]).squaredNorm())
        nearest = p;
    shares[nearest] += energy.nodeEnergy[n] / energy.total;
  }
  return shares;
}

struct Drops {
  std::vector<double> total;
  std::vector<std::vector<double>> shares;
  double cpuMs;
};

Drops energiesOf(const Shared& mesh, ElementOrder order, const std::vector<Impact>& impacts,
                 const std::vector<Vec3>& places) {
  const std::clock_t start = std::clock();
  const auto energies = orExit(impactEnergies(mesh, impacts, Material{}, order, Exec{}));
  Drops drops{{}, {}, 1000 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC};
  for (const ImpactEnergy& e : energies) {
    drops.total.push_back(e.total);
    drops.shares.push_back(sharesOf(*mesh, e, places));
  }
  return drops;
}

double sumOfDifferences(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum;
}

std::vector<Impact> dropsOf(const TetMesh& cage, double patch) {
  std::vector<Impact> impacts;
  for (const Vec3& turn : {Vec3(25, 10, 40), Vec3(80, 0, 20), Vec3(160, 30, 10)}) {
    SimulateParams params;
    params.orientation = turn;
    impacts.push_back(orExit(dropUntilImpact(cage, params, Exec{})));
    for (Contact& contact : impacts.back().contacts) contact.radius *= patch;
  }
  return impacts;
}

class Comparison {
 public:
  Comparison(const Model& model, double patch, Shared fine, const std::vector<Impact>& impacts,
             const std::vector<Vec3>& places, Table& table)
      : model_(model), patch_(patch), impacts_(impacts), places_(places), table_(table) {
    reference_ = energiesOf(fine, ElementOrder::Quadratic, impacts_, places_);
    plot_.title = fmt::format("{}, patch × {:g}", model.name, patch);
    plot_.xLabel = "error of the energies of three drops, root mean square";
    plot_.yLabel = "three drops, cpu ms";
    row("fine, ends at the surface", *fine, ElementOrder::Quadratic, reference_);
    add("fine, ends at the surface", fine, ElementOrder::Linear);
  }

  void add(const char* kind, const Shared& mesh, ElementOrder order) {
    row(kind, *mesh, order, energiesOf(mesh, order, impacts_, places_));
  }
  Plot plot() const { return plot_; }

 private:
  void row(const char* kind, const TetMesh& mesh, ElementOrder order, const Drops& drops) {
    const char* name = order == ElementOrder::Linear ? "linear" : "quadratic";
    std::vector<std::string> cells{model_.name, fmt::format("× {:g}", patch_), kind,
                                   name,        count(mesh.tets.size()),       number(drops.cpuMs)};
    double squares = 0;
    for (std::size_t i = 0; i < drops.total.size(); ++i) {
      const double error = drops.total[i] / reference_.total[i] - 1;
      squares += error * error;
      cells.push_back(fmt::format("{:.4g} J ({:+.1f} %, {:.3f})", drops.total[i], 100 * error,
                                  sumOfDifferences(drops.shares[i], reference_.shares[i])));
    }
    table_.row(cells);
    fmt::print("{}\n", fmt::join(cells, " "));
    std::fflush(stdout);
    if (std::string(kind) != "cage") return;
    const double error = std::sqrt(squares / static_cast<double>(drops.total.size()));
    point(name, error, drops.cpuMs);
    if (order == SimulateParams{}.elements && TetrahedralizeParams{}.tets == asked_)
      point("default", error, drops.cpuMs);
  }
  void point(const std::string& series, double x, double y) {
    auto found = std::find_if(plot_.series.begin(), plot_.series.end(),
                              [&](const Series& s) { return s.name == series; });
    if (found == plot_.series.end()) found = plot_.series.insert(found, Series{series, {}, {}});
    found->x.push_back(x);
    found->y.push_back(y);
  }

 public:
  int asked_ = 0;  ///< tetrahedra, of the cages that are added next

 private:
  const Model& model_;
  double patch_;
  const std::vector<Impact>& impacts_;
  const std::vector<Vec3>& places_;
  Table& table_;
  Drops reference_;
  Plot plot_;
};

}  // namespace

void cages(const Options& options, std::string& report) {
  Table table({"model", "patch", "mesh", "elements", "tets", "cpu ms", "drop 1", "drop 2", "drop 3"});
  std::vector<Plot> plots;
  for (const Model& model : {Model{"horse", 0.03, 1}, Model{"bunny", 0.04, 6}}) {
    const std::string file = fmt::format(SHERD_SOURCE_DIR "/../shared/meshes/{}.obj", model.name);
    if (!fs::exists(file)) {
      report += fmt::format("{} is left out: it is absent.\n\n", model.name);
      continue;
    }
    LoadMeshParams loading;
    loading.file = file;
    const auto surface = std::make_shared<const TriMesh>(orExit(loadMesh(loading, Exec{})));
    const std::vector<Vec3> places = placesOn(*surface);
    const Shared fine = orExit(conformingMesh(*surface, model.edge, model.step));
    std::vector<std::pair<int, Shared>> all;
    for (const int tets : {1250, 2500, 5000, 10000, 20000})
      all.emplace_back(tets,
                       std::make_shared<const TetMesh>(orExit(tetrahedralize(surface, {tets, 0}, Exec{}))));
    for (const double patch : kPatches) {
      const std::vector<Impact> impacts = dropsOf(*all[0].second, patch);
      Comparison comparison(model, patch, fine, impacts, places, table);
      for (const auto& [tets, mesh] : all) {
        comparison.asked_ = tets;
        comparison.add("cage", mesh, ElementOrder::Linear);
        comparison.add("cage", mesh, ElementOrder::Quadratic);
      }
      plots.push_back(comparison.plot());
    }
  }
  table.write(options.out / "cages.csv");
  writePlots(options.out / "cages.svg", plots);
  report += fmt::format(
      "### Cages against meshes that end at the surface\n\nEnergies of three drops; in brackets the "
      "difference to each group's first row, and the sum of the differences between the shares of the energy "
      "that {} parts of the body hold (0: spread alike; 2: nowhere in common). Patches: Hertz's but at "
      "least 3 % of the body's size (the default), and twice as wide.\n\n{}\n",
      kParts, table.markdown());
}

}  // namespace sherd::bench
