// Strain energies of impacts: time beside error.
//
//   bench_simulate [--part answers|contact|solver|cages]… [--out DIRECTORY] [--results FILE.md]
//                  [--largest N] [--repetitions N]
//
// answers  a bar, a cantilever and a bent bar near ν = ½ against their known energies, over meshes and
//          elements
// contact  the energy of an impact over the time step, the mesh and the elements, at two patches of given
//          size, and over the quadrature of the patch
// solver   factoring, one load, a block of loads and a thousand impacts, from 1,700 to 50,000 nodes (N at
//          most)
// cages    horse and bunny in cages of 1,250 to 20,000 tetrahedra against fine meshes that end at the surface
//
// Times are medians of 10 (or of N repetitions), of factoring 3. Writes one CSV, Markdown table and SVG plot
// per part into the directory (default build/bench_simulate), and all tables into sections of FILE.md. Models
// of ../shared/meshes that are absent are left out, and said.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "base/rng.h"
#include "bench/cages.h"
#include "bench/measured_table.h"
#include "bench/or_exit.h"
#include "bench/parts.h"
#include "bench/plot.h"
#include "simulate/patch_load.h"
#include "simulate/simulate.h"
#include "simulate/statics.h"
#include "simulate/supernodal_solve.h"
#include "support/elastic_loads.h"

namespace sherd::bench {
namespace {

using Shared = std::shared_ptr<const TetMesh>;
constexpr double kYoung = 5e10;
constexpr ElementOrder kOrders[] = {ElementOrder::Linear, ElementOrder::Quadratic};

const char* nameOf(ElementOrder order) { return order == ElementOrder::Linear ? "linear" : "quadratic"; }

std::shared_ptr<const Statics> factored(const Shared& mesh, const StaticsParams& params) {
  return std::make_shared<const Statics>(orExit(Statics::factor(mesh, params, Exec{})));
}

/// Registers factoring and the solution of one load, and runs both.
struct Timed {
  std::shared_ptr<const Statics> statics;
  StaticSolution solution;
  double factorMs, factorCpuMs, solveMs, solveCpuMs;
};

Timed timed(const std::string& name, const Shared& mesh, const StaticsParams& params,
            const std::function<std::vector<Vec3>(const Elements&)>& load, const Options& options) {
  Timed t;
  timeOf<std::function<std::shared_ptr<const Statics>()>, std::shared_ptr<const Statics>>(
      name + "/factor", std::min(3, options.repetitions), [=] { return factored(mesh, params); },
      [&t](const std::shared_ptr<const Statics>& made) { t.statics = made; });
  runMeasured();
  const std::vector<Vec3> force = load(*t.statics->elements());
  timeOf<std::function<StaticSolution()>, StaticSolution>(
      name + "/solve", options.repetitions, [&t, force] { return t.statics->solve(force, kYoung); },
      [&t](const StaticSolution& made) { t.solution = made; });
  runMeasured();
  t.factorMs = medianOf(name + "/factor");
  t.factorCpuMs = processorMedianOf(name + "/factor");
  t.solveMs = medianOf(name + "/solve");
  t.solveCpuMs = processorMedianOf(name + "/solve");
  return t;
}

// Known answers.

struct Answer {
  std::string name;
  double poisson;
  std::function<Shared(int)> mesh;
  std::function<std::vector<Vec3>(const Elements&)> load;
  double energy;
};

std::vector<Answer> knownAnswers() {
  const families::Cantilever beam;
  const families::PureBending bent;
  std::vector<Answer> answers;
  answers.push_back({"bar pushed at one end", 0,
                     [](int k) { return families::shared(families::box(4 * k, k, k, Vec3(2, 0.5, 0.5))); },
                     [](const Elements& e) {
                       return families::tractionOn(e, [](const Vec3& x) {
                         return Mat3(Vec3(x.x() < 1e-9 ? -4e6 : 0, 0, 0).asDiagonal());
                       });
                     },
                     1e12 * 2 / (6 * kYoung * 0.25)});
  answers.push_back({"cantilever", 0, [beam](int k) { return families::shared(beam.mesh(k)); },
                     [beam](const Elements& e) { return beam.load(e); }, beam.energy(kYoung)});
  for (const double poisson : {0.3, 0.45, 0.49, 0.4999})
    answers.push_back({"bent bar", poisson, [bent](int k) { return families::shared(bent.mesh(k)); },
                       [bent](const Elements& e) { return bent.load(e, kYoung); }, bent.energy(kYoung)});
  return answers;
}

void answers(const Options& options, std::string& report) {
  Table table({"body", "ν", "elements", "tets", "nodes", "energy / exact", "error", "order", "plain elements",
               "factor cpu ms", "solve cpu ms"});
  std::map<std::string, Plot> plots;
  for (const Answer& a : knownAnswers())
    for (const ElementOrder order : kOrders) {
      double last = 0;
      for (const int k : {1, 2, 4}) {
        if (order == ElementOrder::Quadratic && k == 4) continue;
        const Shared mesh = a.mesh(k);
        const std::string name = fmt::format("{}/{:g}/{}/{}", a.name, a.poisson, nameOf(order), k);
        const Timed t = timed(name, mesh, {a.poisson, order}, a.load, options);
        const double error = std::abs(t.solution.work / a.energy - 1);
        std::string plain;
        if (a.poisson > 0.4) {
          const StaticsParams locking{a.poisson, order, -1, std::numeric_limits<double>::infinity()};
          const auto statics = factored(mesh, locking);
          plain = fmt::format("{:.4f}", statics->solve(a.load(*statics->elements()), kYoung).work / a.energy);
        }
        table.row({a.name, fmt::format("{:g}", a.poisson), nameOf(order), count(mesh->tets.size()),
                   count(t.statics->elements()->nodeCount()),
                   fmt::format("{:.6f}", t.solution.work / a.energy), scientific(error),
                   last > 1e-9 ? fmt::format("{:.2f}", std::log2(last / error)) : "", plain,
                   number(t.factorCpuMs), number(t.solveCpuMs)});
        last = error;
        if (a.poisson > 0 && a.poisson < 0.49) continue;
        Plot& plot = plots[fmt::format("{}, ν = {:g}", a.name, a.poisson)];
        plot.title = fmt::format("{}, ν = {:g}", a.name, a.poisson);
        plot.xLabel = "relative error of the energy";
        plot.yLabel = "factor and solve, cpu ms";
        if (k == 1) plot.series.push_back({nameOf(order), {}, {}});
        plot.series.back().x.push_back(std::max(error, 1e-14));
        plot.series.back().y.push_back(t.factorCpuMs + t.solveCpuMs);
      }
    }
  table.write(options.out / "answers.csv");
  std::vector<Plot> all;
  for (auto& [name, plot] : plots) all.push_back(std::move(plot));
  writePlots(options.out / "answers.svg", all);
  report +=
      "### Known answers\n\nPlain elements: energy over exact without averaged volume strains, which "
      "locks.\n\n" +
      table.markdown() + "\n";
}

// Contact.

SimulateParams dropped() {
  SimulateParams params;
  params.orientation = Vec3(0, 0, 45);
  params.angularVelocity = Vec3(3, -7, 11);
  return params;
}

double energyOf(const Shared& mesh, const SimulateParams& params) {
  return totalEnergy(orExit(simulate(mesh, params, Exec{})).energy);
}

/// Energy against the points of the patch's quadrature.
Table quadrature() {
  Table table({"pieces, radii", "elements", "points", "energy, J", "against the finest"});
  const Shared cube = families::shared(families::box(8, 8, 8, Vec3(0.2, 0.2, 0.2)));
  SimulateParams params = dropped();
  params.contactRadius = 0.03;
  const Impact impact = orExit(dropUntilImpact(*cube, params, Exec{}));
  for (const ElementOrder order : kOrders) {
    const auto statics = factored(cube, {params.body.poissonRatio, order});
    const auto measured = [&](double piece) {
      const PatchLoader loader(statics->elements(), piece);
      std::vector<Vec3> force(statics->elements()->nodeCount(), Vec3::Zero());
      std::size_t points = 0;
      for (const Contact& c : impact.contacts) {
        const Vec3 peak = kHertzPeak / c.duration * c.impulse;
        points += loader.pointCount(c.point, peak, c.radius);
        if (const auto done = loader.add(c.point, peak, c.radius, force); !done.ok())
          fmt::print(stderr, "{}\n", done.error().text());
      }
      return std::pair(points, statics->solve(force, params.body.youngModulus).work);
    };
    const double finest = measured(1.0 / 64).second;
    for (const double piece : {2.0, 1.0, 0.5, kPatchPiece, 0.125, 0.0625}) {
      const auto [points, energy] = measured(piece);
      table.row({fmt::format("{:g}{}", piece, piece == kPatchPiece ? " (default)" : ""), nameOf(order),
                 count(points), fmt::format("{:.5g}", energy), scientific(std::abs(energy / finest - 1))});
    }
  }
  return table;
}

void contact(const Options& options, std::string& report) {
  Table steps({"time step, s", "energy, J", "against the finest"});
  const Shared cube = families::shared(families::box(8, 8, 8, Vec3(0.2, 0.2, 0.2)));
  SimulateParams params = dropped();
  params.timeStep = 1.0 / 3840;
  const double finest = energyOf(cube, params);
  for (const double perSecond : {24.0, 60.0, 240.0, 960.0, 3840.0}) {
    params.timeStep = 1 / perSecond;
    const double energy = energyOf(cube, params);
    steps.row({fmt::format("1/{:g}", perSecond), fmt::format("{:.8g}", energy),
               scientific(std::abs(energy / finest - 1))});
  }
  Table meshes(
      {"patch radius, m", "elements", "cubes along an edge", "tets", "energy, J", "change", "cpu ms"});
  Plot plot{"energy of a cube dropped on its edge", "tets", "J", {}};
  for (const double radius : {0.03, 0.06})
    for (const ElementOrder order : kOrders) {
      Series series{fmt::format("{}, patch {:g} m", nameOf(order), radius), {}, {}};
      double last = 0;
      for (const int n : {4, 6, 8, 12, 16}) {
        if (order == ElementOrder::Quadratic && n > 12) continue;
        SimulateParams p = dropped();
        p.contactRadius = radius;
        p.elements = order;
        const Shared mesh = families::shared(families::box(n, n, n, Vec3(0.2, 0.2, 0.2)));
        const std::clock_t start = std::clock();
        const double energy = energyOf(mesh, p);
        const double ms = 1000 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        meshes.row({fmt::format("{:g}", radius), nameOf(order), count(static_cast<std::size_t>(n)),
                    count(mesh->tets.size()), fmt::format("{:.5g}", energy),
                    last > 0 ? fmt::format("{:+.1f} %", 100 * (energy / last - 1)) : "", number(ms)});
        last = energy;
        series.x.push_back(static_cast<double>(mesh->tets.size()));
        series.y.push_back(energy);
      }
      plot.series.push_back(std::move(series));
    }
  steps.write(options.out / "contact_steps.csv");
  meshes.write(options.out / "contact_meshes.csv");
  writePlots(options.out / "contact.svg", {plot});
  const Table points = quadrature();
  points.write(options.out / "contact_quadrature.csv");
  report +=
      "### Contact\n\nA cube of 0.2 m, dropped spinning.\n\n" + steps.markdown() + "\n" + meshes.markdown() +
      "\nThe same on 3,072 tetrahedra with a patch of 0.03 m, over the quadrature of its pressure:\n\n" +
      points.markdown() + "\n";
}

// Solver.

std::vector<Impact> impactsOn(const TetMesh& mesh, std::size_t count) {
  Rng rng(5);
  std::vector<Impact> impacts(count);
  for (Impact& impact : impacts) {
    const Triangle& t = mesh.boundary[rng.below(mesh.boundary.size())];
    const Vec3 direction(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
    impact.hit = true;
    impact.contacts.push_back(
        {(mesh.nodes[at(t[0])] + mesh.nodes[at(t[1])] + mesh.nodes[at(t[2])]) / 3, direction, 1e-4, 0.05});
  }
  return impacts;
}

void solver(const Options& options, std::string& report) {
  Table table({"elements", "tets", "nodes", "factor ms", "factor cpu ms", "peak MB", "one load ms", "goal ms",
               "one load cpu ms", "a load in a block ms", "goal ms", "a load in a block cpu ms",
               "1000 impacts' energies ms", "energy − work"});
  for (const ElementOrder order : kOrders)
    for (const int n : {11, 20, 36}) {
      const Shared mesh = families::shared(families::box(n, n, n, Vec3(1, 1, 1)));
      if (mesh->nodes.size() > options.largest || (order == ElementOrder::Quadratic && n > 11)) continue;
      const std::string name = fmt::format("solver/{}/{}", nameOf(order), n);
      const std::vector<Impact> impacts = impactsOn(*mesh, 1000);
      const auto load = [&](const Elements& e) {
        return orExit(impactForces(std::make_shared<const Elements>(e), impacts[0]));
      };
      const Timed t = timed(name, mesh, {0.2, order}, load, options);
      std::vector<std::vector<Vec3>> forces;
      for (std::size_t i = 0; i < kSolveWidth; ++i)
        forces.push_back(orExit(impactForces(t.statics->elements(), impacts[i])));
      timeOf<std::function<std::size_t()>, std::size_t>(
          name + "/block", options.repetitions,
          [&] { return orExit(t.statics->solveAll(forces, kYoung, Exec{})).size(); }, {});
      if (n == 11)
        timeOf<std::function<std::size_t()>, std::size_t>(
            name + "/thousand", 3,
            [&] { return orExit(impactEnergies(mesh, impacts, Material{}, order, false, Exec{})).size(); }, {});
      runMeasured();
      double energy = 0;
      for (const double e : t.solution.tetEnergy) energy += e;
      const bool hasGoals = order == ElementOrder::Linear && n != 20;
      const double width = static_cast<double>(kSolveWidth);
      table.row({nameOf(order), count(mesh->tets.size()), count(t.statics->elements()->nodeCount()),
                 number(t.factorMs), number(t.factorCpuMs),
                 number(1e-6 * static_cast<double>(t.statics->peakBytes())), number(t.solveMs),
                 hasGoals ? (n == 11 ? "2" : "200") : "", number(t.solveCpuMs),
                 number(medianOf(name + "/block") / width), hasGoals && n == 36 ? "40" : "",
                 number(processorMedianOf(name + "/block") / width),
                 n == 11 ? number(medianOf(name + "/thousand")) : "",
                 scientific(std::abs(energy / t.solution.work - 1))});
    }
  table.write(options.out / "solver.csv");
  report += fmt::format("### Factoring and solving\n\nSolid blocks; a block of loads is {} of them.\n\n{}\n",
                        kSolveWidth, table.markdown());
}

}  // namespace
}  // namespace sherd::bench

int main(int argc, char** argv) {
  using namespace sherd::bench;
  Options options;
  options.repetitions = 10;
  options.largest = 51'000;
  return runParts(argc, argv, "bench_simulate", SHERD_BINARY_DIR, options, {"--largest", "--repetitions"},
                  {{"answers", answers}, {"contact", contact}, {"solver", solver}, {"cages", cages}});
}
