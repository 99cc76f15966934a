// Figures 8 and 9 of Schvartzman and Otaduy (2014) (learn_parts.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/learn_parts.h"
#include "bench/measured_table.h"
#include "bench/plot.h"

namespace sherd::bench {
namespace {

constexpr int kSearched = 5, kForetold = 1, kTraining = 6, kForetoldTraining = 0;  // colours
constexpr double kFigure9Height = 1;                                               // m

std::string digits(double value) { return fmt::format("{:.5g}", value); }

double meanOf(const DegreeExample& example) {
  double sum = 0;
  for (const int degree : example.degree) sum += degree;
  return sum / static_cast<double>(example.degree.size());
}

void addPoint(Series& series, double x, const Moments& m) {
  series.x.push_back(x);
  series.y.push_back(m.mean());
  series.low.push_back(m.mean() - m.deviation());
  series.high.push_back(m.mean() + m.deviation());
}

/// Means and deviations per height; beside each other rather than on top.
Plot meansPlot(const Comparison& training, const Comparison& tests) {
  Plot plot{"degree by drop height: mean and standard deviation",
            "drop height, m",
            "pieces",
            {},
            Plot::Scale::Linear};
  const auto add = [&](const char* name, const Comparison& c, bool isForetold, double shift, int colour) {
    Series series{name, {}, {}};
    series.colour = colour;
    if (!isForetold) series.style = Series::Style::Dashed;
    for (const auto& [height, both] : c.perHeight)
      addPoint(series, height + shift, isForetold ? both.second : both.first);
    plot.series.push_back(std::move(series));
  };
  add("searched, training orientations", training, false, -0.06, kTraining);
  add("foretold, training orientations", training, true, -0.02, kForetoldTraining);
  add("searched, unseen orientations", tests, false, 0.02, kSearched);
  add("foretold, unseen orientations", tests, true, 0.06, kForetold);
  return plot;
}

/// Every drop of the test set: by height, and in each by the searched degree.
Plot dropsPlot(const Comparison& tests) {
  std::vector<Foretold> all = tests.each;
  std::stable_sort(all.begin(), all.end(), [](const Foretold& a, const Foretold& b) {
    if (a.example->height != b.example->height) return a.example->height < b.example->height;
    return meanOf(a.example->example) < meanOf(b.example->example);
  });
  Plot plot{"degree of each drop from an unseen orientation",
            "drop height, m; in each by searched degree",
            "pieces",
            {},
            Plot::Scale::Linear};
  plot.groups = true;
  plot.width = 720;
  Series searched{"searched: mean, least and most of the repeats", {}, {}}, foretold{"foretold", {}, {}};
  searched.style = foretold.style = Series::Style::Points;
  searched.colour = kSearched, foretold.colour = kForetold;
  const double perGroup = static_cast<double>(all.size()) / static_cast<double>(tests.perHeight.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double x = (static_cast<double>(i) + 0.5) / perGroup;
    const auto& degree = all[i].example->example.degree;
    searched.x.push_back(x), foretold.x.push_back(x);
    searched.y.push_back(meanOf(all[i].example->example));
    searched.low.push_back(*std::min_element(degree.begin(), degree.end()));
    searched.high.push_back(*std::max_element(degree.begin(), degree.end()));
    foretold.y.push_back(all[i].estimate.degree);
  }
  for (const auto& [height, both] : tests.perHeight) plot.categories.push_back(fmt::format("{:g}", height));
  plot.series = {std::move(searched), std::move(foretold)};
  return plot;
}

struct Compared {
  Comparison training, tests;
};

void writeFigure8(const Setup& setup, const Compared& best, const Compared& paper,
                  const std::filesystem::path& directory) {
  Plot means = meansPlot(best.training, best.tests), drops = dropsPlot(best.tests);
  means.title = setup.body.name + ": " + means.title;
  writePlots(directory / ("figure8_" + setup.body.name + ".svg"), {means, drops});
  Table heights({"set", "height_m", "searched_mean", "searched_deviation", "foretold_mean",
                 "foretold_deviation", "paper_mean", "paper_deviation"});
  for (const bool isTest : {false, true}) {
    const Comparison &ours = isTest ? best.tests : best.training,
                     &theirs = isTest ? paper.tests : paper.training;
    for (const auto& [height, both] : ours.perHeight) {
      const Moments& other = theirs.perHeight.at(height).second;
      heights.row({isTest ? "unseen" : "training", digits(height), digits(both.first.mean()),
                   digits(both.first.deviation()), digits(both.second.mean()),
                   digits(both.second.deviation()), digits(other.mean()), digits(other.deviation())});
    }
  }
  heights.write(directory / ("figure8_" + setup.body.name + ".csv"));
  std::vector<std::string> searches;
  for (std::size_t k = 1; k <= best.tests.each.at(0).example->example.degree.size(); ++k)
    searches.push_back(fmt::format("searched_{}", k));
  Table each({"height_m", "orientation_x", "orientation_y", "orientation_z",
              fmt::format("{}", fmt::join(searches, ",")), "foretold", "foretold_deviation", "paper"});
  for (std::size_t i = 0; i < best.tests.each.size(); ++i) {
    const Foretold& one = best.tests.each[i];
    const Vec3& turned = one.example->orientation;
    each.row({digits(one.example->height), digits(turned.x()), digits(turned.y()), digits(turned.z()),
              fmt::format("{}", fmt::join(one.example->example.degree, ",")),
              fmt::format("{}", one.estimate.degree), digits(one.estimate.deviation),
              fmt::format("{}", paper.tests.each[i].estimate.degree)});
  }
  each.write(directory / ("figure8_" + setup.body.name + "_drops.csv"));
}

/// The paper's method with principal components to several tolerances.
void writeFigure9(const Setup& setup, const Compared& best, const std::filesystem::path& directory) {
  Plot means{fmt::format("{}: degree at {:g} m by the paper's network", setup.body.name, kFigure9Height),
             "error left by the principal components",
             "pieces: mean and standard deviation",
             {},
             Plot::Scale::Linear};
  Plot errors{"what that costs, over all heights",
              means.xLabel,
              "mean absolute error, % of the mean degree",
              {},
              Plot::Scale::Linear};
  Series searchedTraining{"searched, training", {}, {}}, foretoldTraining{"foretold, training", {}, {}},
      searched{"searched, unseen", {}, {}}, foretold{"foretold, unseen", {}, {}};
  Series known{"on training orientations", {}, {}}, unseen{"on unseen orientations", {}, {}},
      ours{"the default method, unseen", {}, {}}, noise{"spread over seeds, which none can foretell", {}, {}};
  const std::pair<Series*, int> styles[] = {
      {&searchedTraining, kTraining}, {&foretoldTraining, kForetoldTraining},
      {&searched, kSearched},         {&foretold, kForetold},
      {&known, kForetoldTraining},    {&unseen, kForetold}};
  for (const auto& [series, colour] : styles) series->style = Series::Style::Points, series->colour = colour;
  known.style = unseen.style = Series::Style::LineAndPoints;
  ours.style = noise.style = Series::Style::Dashed;
  ours.colour = 2, noise.colour = kSearched;
  Table table({"tolerance", "components", "centres", "set", "searched_mean", "searched_deviation",
               "foretold_mean", "foretold_deviation", "error_share_all_heights"});
  double x = 0;
  for (const double tolerance : {0.0, 0.01, 0.02, 0.05, 0.10}) {
    const DegreeModel model =
        orExit(learnFromDrops(setup.training, *setup.body.embedding, paperMethod(tolerance), Exec{})).model;
    const Comparison training = compare(setup.body, setup.training, model),
                     tests = compare(setup.body, setup.tests, model);
    const auto row = [&](const char* set, const Comparison& c, Series& s, Series& f, Series& error,
                         double shift) {
      const auto& [atHeight, told] = c.perHeight.at(kFigure9Height);
      addPoint(s, x + shift - 0.06, atHeight);
      addPoint(f, x + shift + 0.06, told);
      error.x.push_back(x), error.y.push_back(100 * c.share());
      table.row({digits(tolerance), count(static_cast<std::size_t>(model.basis.rows())),
                 count(model.centres.size()), set, digits(atHeight.mean()), digits(atHeight.deviation()),
                 digits(told.mean()), digits(told.deviation()), digits(c.share())});
    };
    row("training", training, searchedTraining, foretoldTraining, known, -0.18);
    row("unseen", tests, searched, foretold, unseen, 0.18);
    ours.x.push_back(x), ours.y.push_back(100 * best.tests.share());
    noise.x.push_back(x), noise.y.push_back(100 * best.tests.noiseShare());
    const std::string label = tolerance == 0 ? "none" : fmt::format("{:g} %", 100 * tolerance);
    for (Plot* plot : {&means, &errors})
      plot->categories.push_back(fmt::format("{} ({})", label, model.basis.rows()));
    x += 1;
  }
  means.xLabel += " (how many there are)";
  means.series = {searchedTraining, foretoldTraining, searched, foretold};
  errors.series = {known, unseen, ours, noise};
  means.width = errors.width = 540;
  writePlots(directory / ("figure9_" + setup.body.name + ".svg"), {means, errors});
  table.write(directory / ("figure9_" + setup.body.name + ".csv"));
}

}  // namespace

std::string figuresPart(const Setup& setup, const std::filesystem::path& directory) {
  const auto compared = [&](const LearnDegreeParams& method) {
    const DegreeModel model =
        orExit(learnFromDrops(setup.training, *setup.body.embedding, method, Exec{})).model;
    return Compared{compare(setup.body, setup.training, model), compare(setup.body, setup.tests, model)};
  };
  const Compared best = compared(bestMethod());
  writeFigure8(setup, best, compared(paperMethod()), directory);
  writeFigure9(setup, best, directory);
  return fmt::format("{}: figures 8 and 9 in {}\n", setup.body.name, directory.string());
}

}  // namespace sherd::bench
