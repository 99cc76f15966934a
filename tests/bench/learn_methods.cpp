// Methods beside each other, on orientations, on balls, and on single hits (learn_parts.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "bench/learn_parts.h"
#include "bench/measured_table.h"
#include "cvd/cvd.h"
#include "predict_degree/predict_degree.h"

namespace sherd::bench {
namespace {

struct Method {
  const char* name;
  LearnDegreeParams params;
};
const Method kMethods[] = {
    {"best", bestMethod()},
    {"paper", paperMethod()},
    {"paper, PCA to 0.1 %", paperMethod(0.001)},
    {"paper, PCA to 1 %", paperMethod(0.01)},
    {"paper, PCA to 5 %", paperMethod(0.05)},
    {"paper, PCA to 10 %", paperMethod(0.10)},
    {"exact", {DegreeMethod::Exact, 0.02, 0.01}},
    {"exact, PCA to 0.1 %", {DegreeMethod::Exact, 0.001, 0.01}},
};

DegreeModel learned(const Setup& setup, const DropExamples& from, const LearnDegreeParams& params) {
  return orExit(learnFromDrops(from, *setup.body.embedding, params, Exec{})).model;
}

}  // namespace

std::string methodsPart(const Setup& setup, const std::filesystem::path& out) {
  const double examples = static_cast<double>(setup.training.drops.size()) * setup.params.repeats;
  std::string report = fmt::format(
      "{}: {} examples in {:.1f} s with {} threads ({:.1f} a second), {} searches, γ = {:.4g} J·m²\n\n",
      setup.body.name, examples, setup.trainingSeconds, threadLimit(), examples / setup.trainingSeconds,
      setup.training.paths, setup.params.gamma);
  Table table({"method", "components", "centres", "error on tests", "share of mean", "R²", "noise", "outside",
               "error left out", "error on training", "fit s", "foretell µs"});
  Table heights({"method", "height m", "searched mean", "searched deviation", "foretold mean",
                 "foretold deviation", "difference / deviation"});
  for (const Method& method : kMethods) {
    DegreeModel model;
    const double fit = secondsOf([&] { model = learned(setup, setup.training, method.params); });
    const Comparison test = compare(setup.body, setup.tests, model),
                     known = compare(setup.body, setup.training, model);
    table.row({method.name, count(static_cast<std::size_t>(model.basis.rows())), count(model.centres.size()),
               number(test.absolute / test.searched.n), percent(test.share()),
               fmt::format("{:.4f}", test.rSquared()), percent(test.noiseShare()), percent(test.outside),
               percent(model.errors.meanAbsolute / model.errors.meanDegree), percent(known.share()),
               number(fit), number(test.microseconds)});
    const bool isShown = std::string(method.name) == "best" || std::string(method.name) == "paper";
    for (const auto& [height, both] : test.perHeight) {
      if (!isShown) continue;
      const auto& [searched, foretold] = both;
      heights.row({method.name, number(height), number(searched.mean()), number(searched.deviation()),
                   number(foretold.mean()), number(foretold.deviation()),
                   fmt::format("{:.2f}", (foretold.mean() - searched.mean()) / searched.deviation())});
    }
    fmt::print("{}: {} (R² {:.4f}, noise {})\n", method.name, percent(test.share()), test.rSquared(),
               percent(test.noiseShare()));
  }
  table.write(out / "methods.csv");
  heights.write(out / "heights.csv");
  return report + table.markdown() + "\n" + heights.markdown();
}

std::string ballsPart(const Setup& setup, const BallParams& balls) {
  const DropExamples tests = thrownBalls(setup.body, setup.params, balls),
                     training = ballsToLearnFrom(setup.body, setup.params, balls);
  std::string report = fmt::format(
      "{}: {} balls of steel, {:.3g} of the diagonal in radius, {:g} to {:g} m/s, from all around; γ = "
      "{:.4g} "
      "J·m²\n\n",
      setup.body.name, tests.drops.size(), balls.radius, balls.slowest, balls.fastest, setup.params.gamma);
  Table table({"made of", "method", "error on balls", "share of mean", "bias", "R²", "noise", "outside",
               "within two deviations"});
  const auto row = [&](const char* from, const DropExamples& examples, const Method& method) {
    const Comparison c = compare(setup.body, tests, learned(setup, examples, method.params));
    double foretold = 0;
    for (const Foretold& one : c.each) foretold += one.estimate.degree;
    table.row({from, method.name, number(c.absolute / c.searched.n), percent(c.share()),
               percent(foretold / static_cast<double>(c.each.size()) / c.searched.mean() - 1),
               fmt::format("{:.4f}", c.rSquared()), percent(c.noiseShare()), percent(c.outside),
               percent(c.within)});
  };
  for (const Method& method : {kMethods[0], kMethods[1]}) row("drops", setup.training, method);
  for (const Method& method : {kMethods[0], kMethods[1]}) row("balls", training, method);
  return report + table.markdown();
}

namespace {

constexpr std::size_t kShownOf = 7;  // no divisor of the number of heights: all of them are seen

/// What a hit gives: by a search, and by a model.
struct Side {
  Sites sites;
  double milliseconds = 0;
};

Side sideOf(const std::function<Result<Sites>()>& make) {
  Side side;
  side.milliseconds = 1000 * leastSecondsOf(5, [&] { side.sites = orExit(make()); });
  return side;
}

}  // namespace

std::string hitsPart(const Setup& setup) {
  const DegreeModel model = learned(setup, setup.training, bestMethod());
  Table table({"drop m", "E_D whole / γ", "searched N", "search ms", "E_D / γ", "foretold N", "± ",
               "foretell µs", "with its sites ms", "E_D / γ"});
  std::vector<double> ratios, searchTimes, foretellTimes, siteTimes;
  double below = 0, broken = 0;
  const auto& drops = setup.tests.drops;
  for (std::size_t i = 0; i < drops.size(); ++i) {
    const WeightField field = fieldOf(setup.body, setup.tests, drops[i]);
    DegreeEstimate estimate;
    const double us = 1e6 * leastSecondsOf(5, [&] {
                        estimate = estimateDegree(model, field, *setup.body.embedding, Deviation::Known);
                      });
    PredictDegreeParams params{.gamma = setup.params.gamma, .outside = OutsideModel::Predict};
    const Side searched = sideOf([&] { return predictDegree(field, *setup.body.embedding, params, Exec{}); });
    const Side foretold =
        sideOf([&] { return predictByModel(model, field, setup.body.embedding, params, Exec{}); });
    const double ratio = foretold.sites.energy / setup.params.gamma;
    if (searched.sites.positions.cols() > 1) {
      ratios.push_back(ratio);
      broken += 1, below += ratio < 1;
      searchTimes.push_back(searched.milliseconds), siteTimes.push_back(foretold.milliseconds);
      foretellTimes.push_back(us);
    }
    if (i % kShownOf != 0) continue;
    table.row({number(drops[i].height), number(drops[i].wholeEnergy / setup.params.gamma),
               count(static_cast<std::size_t>(searched.sites.positions.cols())),
               number(searched.milliseconds),
               fmt::format("{:.3f}", searched.sites.energy / setup.params.gamma),
               count(static_cast<std::size_t>(foretold.sites.positions.cols())),
               fmt::format("{:.1f}", estimate.deviation), number(us), number(foretold.milliseconds),
               fmt::format("{:.3f}", ratio)});
  }
  const auto at = [](std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return fmt::format(
             "{}: every {}th of {} drops from orientations that the model wasn't made of. Times are the "
             "least of "
             "five. Of the {:.0f} that break, a foretold fracture's E_D / γ is {:.3f} in the middle, {:.3f} "
             "to "
             "{:.3f} for nine in ten, and below 1 for {}. Medians: search {:.2f} ms, foretelling {:.1f} µs, "
             "with "
             "its sites {:.2f} ms.\n\n",
             setup.body.name, kShownOf, drops.size(), broken, at(ratios, 0.5), at(ratios, 0.05),
             at(ratios, 0.95), percent(below / broken), at(searchTimes, 0.5), at(foretellTimes, 0.5),
             at(siteTimes, 0.5)) +
         table.markdown();
}

}  // namespace sherd::bench
