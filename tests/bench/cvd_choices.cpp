// How cells are labelled, started and ended: E_D beside time.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>

#include "bench/cvd_parts.h"
#include "bench/cvd_runs.h"
#include "bench/marks.h"
#include "bench/measured_table.h"
#include "bench/plot.h"

namespace sherd::bench {
namespace {

constexpr std::int64_t kSeeds = 10;
constexpr int kRuns = 5;

using Run = std::function<Outcome(std::int64_t seed)>;

/// Means over the seeds; processor time is the least of several runs, since others use the machine as well.
struct Means {
  double ms = std::numeric_limits<double>::infinity();
  double energy = 0, best = std::numeric_limits<double>::infinity();
  double passes = 0;
};

Means meansOf(const Run& run) {
  Means means;
  for (std::int64_t seed = 1; seed <= kSeeds; ++seed) {
    double least = std::numeric_limits<double>::infinity();
    Outcome out;
    for (int k = 0; k < kRuns; ++k) {
      const std::clock_t start = std::clock();
      out = run(seed);
      least = std::min(least, 1000 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    means.ms = (seed == 1 ? 0 : means.ms) + least / kSeeds;
    means.energy += out.energy / kSeeds;
    means.passes += static_cast<double>(out.iterations) / kSeeds;
    means.best = std::min(means.best, out.energy);
  }
  return means;
}

Outcome bestOf(const Body& body, int count, std::uint64_t draws, std::int64_t seed) {
  const std::vector<double> even(body.weights.weight.size(), 1.0);
  Outcome best{std::numeric_limits<double>::infinity(), 0, {}};
  for (std::uint64_t k = 0; k < draws; ++k) {
    Outcome out = iterated(drawnAtOnce(body, even, count, 1000 * static_cast<std::uint64_t>(seed) + k));
    if (out.energy < best.energy) best = std::move(out);
  }
  return best;
}

struct Choice {
  std::string name, curve;  ///< points of a curve are drawn as one
  Run run;
};

/// The first is the default.
std::vector<Choice> starts(const Body& body, int count) {
  const auto drawn = [&body, count](std::int64_t seed) {
    return drawnAtOnce(body, body.weights.weight, count, static_cast<std::uint64_t>(seed));
  };
  const auto best = [&body, count](std::uint64_t draws) {
    return [&body, count, draws](std::int64_t s) { return bestOf(body, count, draws, s); };
  };
  const char* uniform = "best of 1, 5, 50 uniform";
  return {{"grown, exact", "grown, exact", [&body, count](std::int64_t s) { return grown(body, count, s); }},
          {"apart, exact", "apart, exact",
           [&body, count](std::int64_t s) { return iterated(drawnApart(body, count, s)); }},
          {"apart, flood", "apart, flood",
           [&body, count](std::int64_t s) { return iterated(drawnApart(body, count, s), Labels::Flood); }},
          {"∝ w, exact", "∝ w, exact", [drawn](std::int64_t s) { return iterated(drawn(s)); }},
          {"∝ w, flood", "∝ w, flood", [drawn](std::int64_t s) { return iterated(drawn(s), Labels::Flood); }},
          {"uniform, 1", uniform, best(1)},
          {"best of 5", uniform, best(5)},
          {"best of 50", uniform, best(50)}};
}

struct Bodies {
  std::string name;
  Body body;
  int sites;
};

/// The larger number of sites of each of the paper's models, hit at a corner.
std::vector<Bodies> hitBodies(std::string& report) {
  std::vector<Bodies> all;
  for (const PaperCase& c : paperCases()) {
    if (c.sites < 18) continue;
    if (!std::filesystem::exists(c.path())) {
      report += fmt::format("{}-{} is left out: {} is absent.\n\n", c.name, c.sites, c.file);
      continue;
    }
    Body body = bodyOf(c);
    body.weights = hitAtACorner(body.weights);
    all.push_back({fmt::format("{}-{}", c.name, c.sites), std::move(body), c.sites});
  }
  return all;
}

Plot startsOf(const Bodies& b, Table& table) {
  const std::vector<Choice> choices = starts(b.body, b.sites);
  std::vector<Means> means;
  double best = std::numeric_limits<double>::infinity();
  for (const Choice& choice : choices) {
    means.push_back(meansOf(choice.run));
    best = std::min(best, means.back().best);
  }
  Plot plot{b.name, "processor ms", "E_D above the best known, %", {}};
  const auto above = [&](const Means& m) { return 100 * (m.energy / best - 1); };
  for (std::size_t k = 0; k < choices.size(); ++k) {
    table.row(
        {b.name, choices[k].name, number(means[k].ms), number(above(means[k])), number(means[k].passes)});
    if (plot.series.empty() || plot.series.back().name != choices[k].curve)
      plot.series.push_back({choices[k].curve, {}, {}});
    plot.series.back().x.push_back(means[k].ms);
    plot.series.back().y.push_back(above(means[k]));
  }
  plot.series.push_back(crossAt("the default", means[0].ms, above(means[0])));
  return plot;
}

constexpr double kTolerances[] = {0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5, 1e-7, 0};

Plot tolerancesOf(const Bodies& b, Table& table) {
  const auto runTo = [&](double tolerance) {
    return meansOf([&](std::int64_t s) {
      return iterated(drawnApart(b.body, b.sites, s), Labels::Exact, {.tolerance = tolerance});
    });
  };
  constexpr double kLowest = 1e-4;  // where an end that is the very same is drawn
  Plot plot{b.name, "processor ms", "E_D above that at the end, %", {{"tolerances", {}, {}}}};
  const double end = runTo(0).energy;
  for (const double tolerance : kTolerances) {
    const Means m = runTo(tolerance);
    const double above = std::max(0.0, 100 * (m.energy / end - 1)), drawn = std::max(above, kLowest);
    table.row({b.name, fmt::format("{:g}", tolerance), number(m.ms), scientific(above), number(m.passes)});
    plot.series[0].x.push_back(m.ms);
    plot.series[0].y.push_back(drawn);
    if (tolerance == LloydLimits{}.tolerance)
      plot.series.push_back(crossAt("the default: 1e-7", m.ms, drawn));
  }
  return plot;
}

constexpr double kRelaxations[] = {1, 1.2, 1.4, 1.6, 1.7, 1.8, 1.9, 1.95};

Plot relaxationsOf(const Bodies& b, Table& table) {
  std::vector<Means> means;
  double best = std::numeric_limits<double>::infinity();
  for (const double relaxation : kRelaxations) {
    means.push_back(meansOf([&](std::int64_t s) {
      return iterated(drawnApart(b.body, b.sites, s), Labels::Exact, {.relaxation = relaxation});
    }));
    best = std::min(best, means.back().best);
  }
  Plot plot{b.name, "processor ms", "E_D above the best known, %", {{"relaxations, 1 to 1.95", {}, {}}}};
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double above = 100 * (means[k].energy / best - 1);
    table.row({b.name, fmt::format("{:g}", kRelaxations[k]), number(means[k].ms), number(above),
               number(means[k].passes)});
    plot.series[0].x.push_back(means[k].ms);
    plot.series[0].y.push_back(above);
    if (kRelaxations[k] == LloydLimits{}.relaxation)
      plot.series.push_back(crossAt("the default: 1.8", means[k].ms, above));
  }
  return plot;
}

}  // namespace

void choices(const Options& options, std::string& report) {
  Table startTable({"case", "choice", "cpu ms", "E_D above the best known, %", "passes at the end"});
  Table toleranceTable({"case", "tolerance", "cpu ms", "E_D above that at the end, %", "passes"});
  Table relaxationTable({"case", "relaxation", "cpu ms", "E_D above the best known, %", "passes"});
  std::vector<Plot> byStart, byTolerance, byRelaxation;
  for (const Bodies& b : hitBodies(report)) {
    byStart.push_back(startsOf(b, startTable));
    byTolerance.push_back(tolerancesOf(b, toleranceTable));
    byRelaxation.push_back(relaxationsOf(b, relaxationTable));
  }
  startTable.write(options.out / "starts.csv");
  toleranceTable.write(options.out / "tolerances.csv");
  writePlots(options.out / "starts.svg", byStart);
  writePlots(options.out / "tolerances.svg", byTolerance);
  relaxationTable.write(options.out / "relaxations.csv");
  writePlots(options.out / "relaxations.svg", byRelaxation);
  report +=
      "### Labels, starts, tolerance and relaxation\n\nBodies hit at a corner; means over ten seeds of E_D "
      "and of "
      "processor time (the least of five runs).\n\n" +
      startTable.markdown() + "\nTolerances, from sites drawn apart; 0: until no label changes.\n\n" +
      toleranceTable.markdown() +
      "\nHow far sites move in a pass, over the way to their centroids, while labels change; 1: just "
      "there.\n\n" +
      relaxationTable.markdown() + "\n";
}

}  // namespace sherd::bench
