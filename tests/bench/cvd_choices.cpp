// How cells are labelled, started and ended: E_D beside time.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>

#include "bench/cvd_parts.h"
#include "bench/cvd_runs.h"
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
  std::string name;
  Run run;
  bool isDefault = false;
};

std::vector<Choice> starts(const Body& body, int count) {
  const auto drawn = [&body, count](std::int64_t seed) {
    return drawnAtOnce(body, body.weights.weight, count, static_cast<std::uint64_t>(seed));
  };
  return {{"grown, exact", [&body, count](std::int64_t s) { return grown(body, count, s); }, true},
          {"apart, exact", [&body, count](std::int64_t s) { return iterated(drawnApart(body, count, s)); }},
          {"apart, flood",
           [&body, count](std::int64_t s) { return iterated(drawnApart(body, count, s), Labels::Flood); }},
          {"∝ w, exact", [drawn](std::int64_t s) { return iterated(drawn(s)); }},
          {"∝ w, flood", [drawn](std::int64_t s) { return iterated(drawn(s), Labels::Flood); }},
          {"uniform, 1", [&body, count](std::int64_t s) { return bestOf(body, count, 1, s); }},
          {"best of 5", [&body, count](std::int64_t s) { return bestOf(body, count, 5, s); }},
          {"best of 50", [&body, count](std::int64_t s) { return bestOf(body, count, 50, s); }}};
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

void measureStarts(const std::vector<Bodies>& bodies, Table& table, Plot& plot) {
  Series byDefault{"default: grown, exact", {}, {}};
  std::vector<Series> series;
  for (const Bodies& b : bodies) {
    const std::vector<Choice> choices = starts(b.body, b.sites);
    std::vector<Means> means;
    double best = std::numeric_limits<double>::infinity();
    for (const Choice& choice : choices) {
      means.push_back(meansOf(choice.run));
      best = std::min(best, means.back().best);
    }
    for (std::size_t k = 0; k < choices.size(); ++k) {
      const double above = 100 * (means[k].energy / best - 1);
      table.row({b.name, choices[k].name, number(means[k].ms), number(above), number(means[k].passes)});
      if (series.size() < choices.size()) series.push_back({choices[k].name, {}, {}});
      series[k].x.push_back(means[k].ms);
      series[k].y.push_back(above);
      if (!choices[k].isDefault) continue;
      byDefault.x.push_back(means[k].ms);
      byDefault.y.push_back(above);
    }
  }
  series[0] = byDefault;
  plot.series = std::move(series);
}

constexpr double kTolerances[] = {0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5, 1e-7, 0};

void measureTolerances(const std::vector<Bodies>& bodies, Table& table, Plot& plot) {
  Series byDefault{"default: 1e-7", {}, {}};
  for (const Bodies& b : bodies) {
    Series series{b.name, {}, {}};
    const auto runTo = [&](double tolerance) {
      return meansOf([&](std::int64_t s) {
        return iterated(drawnApart(b.body, b.sites, s), Labels::Exact, {.tolerance = tolerance});
      });
    };
    const double end = runTo(0).energy;
    for (const double tolerance : kTolerances) {
      const Means m = runTo(tolerance);
      const double above = 100 * (m.energy / end - 1);
      table.row({b.name, fmt::format("{:g}", tolerance), number(m.ms), scientific(std::max(0.0, above)),
                 number(m.passes)});
      series.x.push_back(m.ms);
      series.y.push_back(std::max(above, 1e-4));  // an end that is the very same is drawn at the bottom
      if (tolerance != LloydLimits{}.tolerance) continue;
      byDefault.x.push_back(m.ms);
      byDefault.y.push_back(series.y.back());
    }
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back(std::move(byDefault));
}

}  // namespace

void choices(const Options& options, std::string& report) {
  Plot byStart{"Labels and starts", "processor ms", "E_D above the best known, %", {}};
  Plot byTolerance{"Tolerance", "processor ms", "E_D above that at the end, %", {}};
  Table startTable({"case", "choice", "cpu ms", "E_D above the best known, %", "passes at the end"});
  Table toleranceTable({"case", "tolerance", "cpu ms", "E_D above that at the end, %", "passes"});
  const std::vector<Bodies> bodies = hitBodies(report);
  measureStarts(bodies, startTable, byStart);
  measureTolerances(bodies, toleranceTable, byTolerance);
  startTable.write(options.out / "starts.csv");
  toleranceTable.write(options.out / "tolerances.csv");
  writePlots(options.out / "choices.svg", {byStart, byTolerance});
  report +=
      "### Labels, starts and tolerance\n\nBodies hit at a corner; means over ten seeds of E_D and of "
      "processor time (the least of five runs).\n\n" +
      startTable.markdown() + "\nTolerances, from sites drawn apart; 0: until no label changes.\n\n" +
      toleranceTable.markdown() + "\n";
}

}  // namespace sherd::bench
