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
#include "bench/contact.h"
#include "bench/marks.h"
#include "bench/measured_table.h"
#include "bench/or_exit.h"
#include "bench/parts.h"
#include "bench/plot.h"
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
  bool isExactForQuadratic = false;
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
                     1e12 * 2 / (6 * kYoung * 0.25), true});
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
  std::map<std::string, Series> marks;
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
        if (a.poisson > 0 ? a.poisson < 0.49 : a.isExactForQuadratic) continue;
        Plot& plot = plots[fmt::format("{}, ν = {:g}", a.name, a.poisson)];
        plot.title = fmt::format("{}, ν = {:g}", a.name, a.poisson);
        plot.xLabel = "factor and solve, cpu ms";
        plot.yLabel = "relative error of the energy";
        if (k == 1) plot.series.push_back({nameOf(order), {}, {}});
        plot.series.back().x.push_back(t.factorCpuMs + t.solveCpuMs);
        plot.series.back().y.push_back(error);
        if (order == ElementOrder::Linear && k == 4)
          marks[plot.title] =
              crossAt("the default: linear, here 6,144 tetrahedra", t.factorCpuMs + t.solveCpuMs, error);
      }
    }
  for (auto& [title, mark] : marks) plots[title].series.push_back(std::move(mark));
  table.write(options.out / "answers.csv");
  std::vector<Plot> all;
  for (auto& [name, plot] : plots) all.push_back(std::move(plot));
  writePlots(options.out / "answers.svg", all);
  report +=
      "### Known answers\n\nPlain elements: energy over exact without averaged volume strains, which "
      "locks.\n\n" +
      table.markdown() + "\n";
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
