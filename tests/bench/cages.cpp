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
constexpr std::size_t kParts = 20;     // of the body, whose shares of the energy are compared
constexpr double kPatches[] = {1, 2};  // times the default
constexpr std::size_t kDrops = 3;

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

/// Needs no tetrahedra.
std::vector<Impact> dropsOf(const std::shared_ptr<const TriMesh>& surface, double patch) {
  TetMesh body;
  body.surface = surface;
  std::vector<Impact> impacts;
  for (const Vec3& turn : {Vec3(25, 10, 40), Vec3(80, 0, 20), Vec3(160, 30, 10)}) {
    SimulateParams params;
    params.orientation = turn;
    impacts.push_back(orExit(dropUntilImpact(body, params, Exec{})));
    for (Contact& contact : impacts.back().contacts) contact.radius *= patch;
  }
  return impacts;
}

/// The cages of one model against a fine mesh.
class Comparison {
 public:
  Comparison(const char* model, const Shared& fine, const std::shared_ptr<const TriMesh>& surface,
             Table& table)
      : model_(model), places_(placesOn(*surface)), table_(table) {
    for (const double patch : kPatches) {
      const std::vector<Impact> drops = dropsOf(surface, patch);
      impacts_.insert(impacts_.end(), drops.begin(), drops.end());
      Plot plot;
      plot.title = fmt::format("{}, patch × {:g}", model, patch);
      plot.xLabel = "error of the energies of three drops, root mean square";
      plot.yLabel = "six drops, cpu ms";
      plots_.push_back(std::move(plot));
    }
    reference_ = energiesOf(fine, ElementOrder::Quadratic, impacts_, places_);
    rows("ends at the surface", *fine, ElementOrder::Quadratic, reference_);
    rows("ends at the surface", *fine, ElementOrder::Linear,
         energiesOf(fine, ElementOrder::Linear, impacts_, places_));
  }

  void add(int asked, const Shared& cage, ElementOrder order) {
    const Drops drops = energiesOf(cage, order, impacts_, places_);
    const std::vector<double> errors = rows("cage", *cage, order, drops);
    for (std::size_t p = 0; p < errors.size(); ++p) {
      point(plots_[p], nameOf(order), errors[p], drops.cpuMs);
      if (p == 0 && order == SimulateParams{}.elements && asked == TetrahedralizeParams{}.tets)
        point(plots_[p], "default", errors[p], drops.cpuMs);
    }
  }
  const std::vector<Plot>& plots() const { return plots_; }

 private:
  static const char* nameOf(ElementOrder order) {
    return order == ElementOrder::Linear ? "linear" : "quadratic";
  }

  /// One per patch; returns their root mean square errors.
  std::vector<double> rows(const char* kind, const TetMesh& mesh, ElementOrder order, const Drops& drops) {
    std::vector<double> errors;
    for (std::size_t p = 0; p < std::size(kPatches); ++p) {
      std::vector<std::string> cells{model_,
                                     fmt::format("× {:g}", kPatches[p]),
                                     kind,
                                     nameOf(order),
                                     count(mesh.tets.size()),
                                     number(drops.cpuMs)};
      double squares = 0;
      for (std::size_t i = p * kDrops; i < (p + 1) * kDrops; ++i) {
        const double error = drops.total[i] / reference_.total[i] - 1;
        squares += error * error / kDrops;
        cells.push_back(fmt::format("{:.4g} J ({:+.1f} %, {:.3f})", drops.total[i], 100 * error,
                                    sumOfDifferences(drops.shares[i], reference_.shares[i])));
      }
      errors.push_back(std::sqrt(squares));
      fmt::print("{}\n", fmt::join(cells, " "));
      std::fflush(stdout);
      table_.row(std::move(cells));
    }
    return errors;
  }
  static void point(Plot& plot, const std::string& name, double x, double y) {
    auto found =
        std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
    if (found == plot.series.end()) found = plot.series.insert(found, Series{name, {}, {}});
    found->x.push_back(x);
    found->y.push_back(y);
  }

  std::string model_;
  std::vector<Vec3> places_;
  Table& table_;
  std::vector<Impact> impacts_;  ///< kDrops per patch
  Drops reference_;
  std::vector<Plot> plots_;  ///< one per patch
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
    const Shared fine = orExit(conformingMesh(*surface, model.edge, model.step));
    Comparison comparison(model.name, fine, surface, table);
    for (const int tets : {1250, 2500, 5000, 10000, 20000}) {
      const auto cage = std::make_shared<const TetMesh>(orExit(tetrahedralize(surface, {tets, 0}, Exec{})));
      for (const ElementOrder order : {ElementOrder::Linear, ElementOrder::Quadratic})
        comparison.add(tets, cage, order);
    }
    plots.insert(plots.end(), comparison.plots().begin(), comparison.plots().end());
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
