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
#include "simulate/impact_refinement.h"
#include "simulate/simulate.h"
#include "tetrahedralize/tetrahedralize.h"

namespace sherd::bench {
namespace {

namespace fs = std::filesystem;
using Shared = std::shared_ptr<const TetMesh>;
constexpr std::size_t kParts = 20;     // of the body, whose shares of the energy are compared
constexpr double kPatches[] = {1, 2};  // times the default
constexpr std::size_t kDrops = 3;
constexpr double kAsked = 0.05;                // of error, with the default number of tetrahedra
constexpr double kReferencePatchEdges = 0.25;  // radii

struct Model {
  const char* name;
  double edge;       ///< of the fine mesh, shares of the bounding box's diagonal
  std::size_t step;  ///< vertices of the surface that it starts from: every one of so many
};

/// How energies are found.
struct Choice {
  ElementOrder order;
  bool refine;
  const char* name() const {
    return order == ElementOrder::Linear ? "linear" : refine ? "quadratic, refined" : "quadratic";
  }
};
constexpr Choice kChoices[] = {
    {ElementOrder::Linear, false}, {ElementOrder::Quadratic, false}, {ElementOrder::Quadratic, true}};

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

double msSince(std::clock_t start) {
  return 1000 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

Drops energiesOf(const Shared& mesh, const Choice& choice, const std::vector<Impact>& impacts,
                 const std::vector<Vec3>& places) {
  const std::clock_t start = std::clock();
  const auto energies =
      orExit(impactEnergies(mesh, impacts, Material{}, choice.order, choice.refine, Exec{}));
  Drops drops{{}, {}, msSince(start)};
  for (const ImpactEnergy& e : energies) {
    drops.total.push_back(e.total);
    drops.shares.push_back(sharesOf(*mesh, e, places));
  }
  return drops;
}

/// Quadratic elements, refined in other ways than the default's.
class Refined {
 public:
  explicit Refined(const Shared& mesh)
      : mesh_(mesh),
        statics_(orExit(Statics::factor(mesh, {Material{}.poissonRatio, ElementOrder::Quadratic}, Exec{}))),
        loader_(statics_.elements()) {}

  struct Energy {
    ImpactEnergy energy;
    std::size_t pieces;
    double cpuMs;  ///< of refining alone
  };
  Energy energyOf(const Impact& impact, const RefinementParams& params) const {
    std::vector<PointLoad> points;
    std::vector<Vec3> force(statics_.elements()->nodeCount(), Vec3::Zero());
    for (const Contact& c : impact.contacts) {
      const auto some = orExit(loader_.pointLoads(c.point, kHertzPeak / c.duration * c.impulse, c.radius));
      points.insert(points.end(), some.begin(), some.end());
    }
    loader_.hand(points, force);
    StaticSolution solution = statics_.solve(force, Material{}.youngModulus);
    const ImpactRefinement refinement(statics_, params);
    const std::clock_t start = std::clock();
    Energy out{};
    out.pieces = orExit(refinement.refine(impact, force, points, Material{}.youngModulus, solution, Exec{}));
    out.cpuMs = msSince(start);
    out.energy.nodeEnergy.assign(mesh_->nodes.size(), 0.0);
    for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
      out.energy.total += solution.tetEnergy[t];
      for (const Index n : mesh_->tets[t]) out.energy.nodeEnergy[at(n)] += solution.tetEnergy[t] / 4;
    }
    return out;
  }

 private:
  Shared mesh_;
  Statics statics_;
  PatchLoader loader_;
};

/// Of a mesh all of which is inside, with a patch resolved whatever its size.
Drops referenceOf(const Shared& fine, const std::vector<Impact>& impacts, const std::vector<Vec3>& places) {
  const std::clock_t start = std::clock();
  const Refined refined(fine);
  Drops drops{};
  for (const Impact& impact : impacts) {
    const ImpactEnergy energy = refined.energyOf(impact, {kReferencePatchEdges, kLargestShare}).energy;
    drops.total.push_back(energy.total);
    drops.shares.push_back(sharesOf(*fine, energy, places));
  }
  drops.cpuMs = msSince(start);
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
    reference_ = referenceOf(fine, impacts_, places_);
    rows("ends at the surface", *fine, kChoices[2], reference_);
    for (const Choice& choice : {kChoices[1], kChoices[0]})
      rows("ends at the surface", *fine, choice, energiesOf(fine, choice, impacts_, places_));
  }

  void add(int asked, const Shared& cage, const Choice& choice) {
    const Drops drops = energiesOf(cage, choice, impacts_, places_);
    const std::vector<double> errors = rows("cage", *cage, choice, drops, asked);
    const bool isDefault = choice.order == SimulateParams{}.elements && asked == TetrahedralizeParams{}.tets;
    for (std::size_t p = 0; p < errors.size(); ++p) {
      point(plots_[p], choice.name(), errors[p], drops.cpuMs);
      if (p == 0 && isDefault) point(plots_[p], "default", errors[p], drops.cpuMs);
    }
  }

  /// Over how far is refined, at the default patch.
  void addRefinements(const Shared& cage, Table& table, Plot& plot) {
    const Refined refined(cage);
    for (const RefinementParams& params : {RefinementParams{2, 1},
                                           {1, 1},
                                           {0.5, 1},
                                           {0.5, 0.01},
                                           {0.5, 0.005},
                                           {},
                                           {0.5, 0.001},
                                           {0.35, 0.0025},
                                           {0.25, 0.001}}) {
      const bool isDefault = params.patchEdges == kPatchEdges && params.largestShare == kLargestShare;
      std::vector<std::string> cells{
          model_, fmt::format("{:g}", params.patchEdges),
          fmt::format("{:g}{}", params.largestShare, isDefault ? " (default)" : "")};
      double squares = 0, worst = 0, ms = 0;
      std::size_t pieces = 0;
      std::vector<std::string> errors;
      for (std::size_t i = 0; i < kDrops; ++i) {
        const Refined::Energy e = refined.energyOf(impacts_[i], params);
        const double error = e.energy.total / reference_.total[i] - 1;
        errors.push_back(fmt::format("{:+.1f} %", 100 * error));
        squares += error * error / kDrops;
        worst = std::max(worst, std::abs(error));
        ms += e.cpuMs / kDrops;
        pieces += e.pieces / kDrops;
      }
      cells.insert(cells.end(), {count(pieces), number(ms)});
      cells.insert(cells.end(), errors.begin(), errors.end());
      cells.push_back(fmt::format("{:.1f} %", 100 * worst));
      fmt::print("{}\n", fmt::join(cells, " "));
      table.row(std::move(cells));
      point(plot, model_, std::sqrt(squares), ms);
      if (isDefault) point(plot, "default", std::sqrt(squares), ms);
    }
  }
  const std::vector<Plot>& plots() const { return plots_; }

 private:
  /// One per patch; returns their root mean square errors.
  std::vector<double> rows(const char* kind, const TetMesh& mesh, const Choice& choice, const Drops& drops,
                           int asked = 0) {
    std::vector<double> errors;
    for (std::size_t p = 0; p < std::size(kPatches); ++p) {
      std::vector<std::string> cells{model_,
                                     fmt::format("× {:g}", kPatches[p]),
                                     kind,
                                     choice.name(),
                                     count(mesh.tets.size()),
                                     number(drops.cpuMs)};
      double squares = 0, worst = 0;
      for (std::size_t i = p * kDrops; i < (p + 1) * kDrops; ++i) {
        const double error = drops.total[i] / reference_.total[i] - 1;
        squares += error * error / kDrops;
        worst = std::max(worst, std::abs(error));
        cells.push_back(fmt::format("{:.4g} J ({:+.1f} %, {:.3f})", drops.total[i], 100 * error,
                                    sumOfDifferences(drops.shares[i], reference_.shares[i])));
      }
      errors.push_back(std::sqrt(squares));
      const bool isAsked = choice.refine && asked == TetrahedralizeParams{}.tets;
      cells.push_back(isAsked ? fmt::format("{:.0f} %", 100 * kAsked) : "");
      cells.push_back(fmt::format("{:.1f} %", 100 * worst));
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
  Table table({"model", "patch", "mesh", "elements", "tets", "cpu ms", "drop 1", "drop 2", "drop 3", "asked",
               "reached"});
  Table refinements({"model", "edges in the patch, radii", "largest share", "pieces", "cpu ms a drop",
                     "drop 1", "drop 2", "drop 3", "largest"});
  Plot refinementPlot;
  refinementPlot.title = "5,000 quadratic tetrahedra, refined";
  refinementPlot.xLabel = "error of the energies of three drops, root mean square";
  refinementPlot.yLabel = "refining a drop, cpu ms";
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
      for (const Choice& choice : kChoices) comparison.add(tets, cage, choice);
      if (tets == TetrahedralizeParams{}.tets) comparison.addRefinements(cage, refinements, refinementPlot);
    }
    plots.insert(plots.end(), comparison.plots().begin(), comparison.plots().end());
  }
  table.write(options.out / "cages.csv");
  refinements.write(options.out / "refinements.csv");
  plots.push_back(std::move(refinementPlot));
  writePlots(options.out / "cages.svg", plots);
  report += fmt::format(
      "### Cages against meshes that end at the surface\n\nEnergies of three drops; in brackets the "
      "difference to each group's first row, and the sum of the differences between the shares of the energy "
      "that {} parts of the body hold (0: spread alike; 2: nowhere in common). Asked and reached: the "
      "largest difference of the three. Patches: Hertz's but at least 3 % of the body's size (the default), "
      "and twice as wide. cpu ms: factoring and all six drops. In each group's first row the patches are "
      "resolved to {:g} of their radius.\n\n{}\n"
      "What is refined, in the cages of {} tetrahedra at the default patch: edges in the patch, and the "
      "largest share of the energy that a tetrahedron may keep (1: contacts alone are refined).\n\n{}\n",
      kParts, kReferencePatchEdges, table.markdown(), TetrahedralizeParams{}.tets, refinements.markdown());
}

}  // namespace sherd::bench
