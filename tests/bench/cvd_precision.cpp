// Float in place of double: what it would save and what it changes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>

#include "base/clones.h"
#include "bench/cvd_parts.h"
#include "bench/cvd_runs.h"
#include "bench/measured_table.h"
#include "bench/plot.h"
#include "cvd/distance.h"
#include "support/prepared_cells.h"
#include "support/tet_families.h"

namespace sherd::bench {
/// Zeros behind a vector change nothing of its distances.
constexpr std::size_t paddedSize(std::size_t dimensions) {
  return (dimensions + kLanes - 1) / kLanes * kLanes;
}

/// As in cvd/distance.cpp, in the same order of summation.
SHERD_CLONES float squaredDistanceOf(const float* a, const float* b, std::size_t size) {
  float sum[kLanes] = {};
  for (std::size_t i = 0; i < size; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float difference = a[i + lane] - b[i + lane];
      sum[lane] += difference * difference;
    }
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}
double squaredDistanceOf(const double* a, const double* b, std::size_t size) {
  return squaredDistance(a, b, size);
}

namespace {

/// Lloyd's iteration with every node compared with every site, in either precision: the same work, so that
/// times compare.
template <class T>
class PlainLloyd {
 public:
  PlainLloyd(const Body& body, const Eigen::MatrixXd& sites)
      : body_(body),
        nodes_(static_cast<std::size_t>(body.embedding->coordinates.cols())),
        size_(paddedSize(static_cast<std::size_t>(sites.rows()))),
        x_(padded(body.embedding->coordinates)),
        p_(padded(sites)),
        count_(static_cast<std::size_t>(sites.cols())),
        label_(nodes_, -1) {}

  bool assign() {
    bool changed = false;
    for (std::size_t n = 0; n < nodes_; ++n) {
      T least = std::numeric_limits<T>::infinity();
      Index nearest = 0;
      for (std::size_t j = 0; j < count_; ++j) {
        const T d2 = squaredDistanceOf(&x_[n * size_], &p_[j * size_], size_);
        if (d2 < least) least = d2, nearest = static_cast<Index>(j);
      }
      changed = changed || nearest != label_[n];
      label_[n] = nearest;
    }
    return changed;
  }
  int run() {
    int passes = 0;
    while (assign() && passes < 1000) move(), ++passes;
    return passes;
  }
  const std::vector<Index>& labels() const { return label_; }

 private:
  std::vector<T> padded(const Eigen::MatrixXd& points) const {
    std::vector<T> out(static_cast<std::size_t>(points.cols()) * size_, T(0));
    for (Eigen::Index n = 0; n < points.cols(); ++n)
      for (Eigen::Index i = 0; i < points.rows(); ++i)
        out[static_cast<std::size_t>(n) * size_ + static_cast<std::size_t>(i)] = static_cast<T>(points(i, n));
    return out;
  }
  void move() {
    std::vector<T> sum(p_.size(), T(0)), total(count_, T(0));
    for (std::size_t n = 0; n < nodes_; ++n) total[at(label_[n])] += static_cast<T>(body_.weights.weight[n]);
    for (std::size_t n = 0; n < nodes_; ++n) {
      const std::size_t j = at(label_[n]);
      const T share = static_cast<T>(body_.weights.weight[n]) / total[j];
      for (std::size_t i = 0; i < size_; ++i) sum[j * size_ + i] += share * x_[n * size_ + i];
    }
    for (std::size_t j = 0; j < count_; ++j)
      if (total[j] > T(0)) std::copy_n(&sum[j * size_], size_, &p_[j * size_]);
  }

  const Body& body_;
  std::size_t nodes_, size_;
  std::vector<T> x_, p_;
  std::size_t count_;
  std::vector<Index> label_;
};

/// E_D of the labels' own centroids, in double.
double energyOf(const Body& body, const std::vector<Index>& labels, Eigen::Index count) {
  const Eigen::MatrixXd& x = body.embedding->coordinates;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(x.rows(), count);
  Eigen::VectorXd total = Eigen::VectorXd::Zero(count);
  for (std::size_t n = 0; n < labels.size(); ++n) {
    sum.col(labels[n]) += body.weights.weight[n] * x.col(static_cast<Eigen::Index>(n));
    total[labels[n]] += body.weights.weight[n];
  }
  double energy = 0;
  for (std::size_t n = 0; n < labels.size(); ++n)
    energy += body.weights.weight[n] *
              (x.col(static_cast<Eigen::Index>(n)) - sum.col(labels[n]) / total[labels[n]]).squaredNorm();
  return energy;
}

double leastMs(const std::function<void()>& run) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 10; ++k) {
    const std::clock_t start = std::clock();
    run();
    least = std::min(least, 1000 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

/// Coordinates rounded to float, and everything computed from these in double.
Body withFloatCoordinates(const Body& body) {
  auto rounded = std::make_shared<Embedding>(*body.embedding);
  rounded->coordinates = body.embedding->coordinates.cast<float>().cast<double>();
  return {rounded, body.weights};
}

/// Nodes on a lattice, equally far from many a pair of sites.
Body wallOfCubes() {
  const auto tets = families::shared(families::box(24, 20, 3, Vec3(1.02, 0.84, 0.12)));
  auto embedding = std::make_shared<Embedding>();
  embedding->tets = tets;
  embedding->coordinates.resize(3, static_cast<Eigen::Index>(tets->nodes.size()));
  for (std::size_t n = 0; n < tets->nodes.size(); ++n)
    embedding->coordinates.col(static_cast<Eigen::Index>(n)) = tets->nodes[n];
  embedding->diameter = boxOf(tets->nodes).diagonal();
  return {embedding, test::volumeWeights(tets)};
}

struct Measured {
  double ms = 0, sameSites = 0, atTheEnd = 0, energy = 0;
  int passes = 0;
};

/// `body`: what is computed with; compared with `onePass` and `whole`, in the coordinates of `exact`.
template <class T>
void runPlain(const Body& exact, const Body& body, const Eigen::MatrixXd& start,
              const PlainLloyd<double>& onePass, const PlainLloyd<double>& whole, Measured& out) {
  PlainLloyd<T> one(body, start), all(body, start);
  one.assign();
  out.passes = all.run();
  out.ms = leastMs([&] { PlainLloyd<T>(body, start).run(); });
  out.sameSites = 100 * shareOfDifferent(one.labels(), onePass.labels());
  out.atTheEnd = 100 * shareOfDifferent(all.labels(), whole.labels());
  out.energy = energyOf(exact, all.labels(), start.cols());
}

void precisionOf(const std::string& name, const Body& body, int sites, Table& table,
                 std::vector<Series>& series) {
  const Eigen::MatrixXd start = drawnApart(body, sites, 1).sites();
  PlainLloyd<double> onePass(body, start), whole(body, start);
  onePass.assign();
  whole.run();
  const Body rounded = withFloatCoordinates(body);
  Measured inDouble, coordinates, inFloat, product;
  runPlain<double>(body, body, start, onePass, whole, inDouble);
  runPlain<double>(body, rounded, start, onePass, whole, coordinates);
  runPlain<float>(body, body, start, onePass, whole, inFloat);
  const LloydLimits unrelaxed{.relaxation = 1};  // as the others
  const Outcome kept = iterated(drawnApart(body, sites, 1), Labels::Exact, unrelaxed);
  product = inDouble;
  product.atTheEnd = 100 * shareOfDifferent(kept.labels, whole.labels());
  product.passes = kept.iterations;
  product.ms = leastMs([&] { iterated(drawnApart(body, sites, 1), Labels::Exact, unrelaxed); });
  const std::pair<const char*, const Measured*> rows[] = {{"double, with bounds (default)", &product},
                                                          {"double, plain", &inDouble},
                                                          {"coordinates in float, plain", &coordinates},
                                                          {"all in float, plain", &inFloat}};
  for (std::size_t k = 0; k < std::size(rows); ++k) {
    const Measured& m = *rows[k].second;
    const double change = 100 * (m.energy / inDouble.energy - 1);
    table.row({name, rows[k].first, number(m.ms), scientific(m.sameSites), scientific(m.atTheEnd),
               fmt::format("{:.1e}", change), count(static_cast<std::size_t>(m.passes))});
    if (series.size() <= k) series.push_back({rows[k].first, {}, {}});
    series[k].x.push_back(m.ms);
    series[k].y.push_back(std::max(m.atTheEnd, 1e-3));  // none at all is drawn at the bottom
  }
}

}  // namespace

void precision(const Options& options, std::string& report) {
  Table table({"case", "numbers", "cpu ms", "labels that differ at the same sites, %",
               "labels that differ at the end, %", "E_D over that of double − 1, %", "passes"});
  Plot plot{"Float and double", "processor ms", "labels that differ at the end, %", {}};
  for (const PaperCase& c : paperCases()) {
    if (!std::filesystem::exists(c.path())) {
      report += fmt::format("{}-{} is left out: {} is absent.\n\n", c.name, c.sites, c.file);
      continue;
    }
    precisionOf(fmt::format("{}-{}", c.name, c.sites), bodyOf(c), c.sites, table, plot.series);
  }
  precisionOf("wall of cubes-18", wallOfCubes(), 18, table, plot.series);
  precisionOf("cloud in 64 dimensions-40", cloud(4000, 64), 40, table, plot.series);
  table.write(options.out / "precision.csv");
  writePlots(options.out / "precision.svg", {plot});
  report +=
      "### Float and double\n\nLloyd's iteration from the same sites to its end, volumes as weights; "
      "processor time, "
      "the least of ten runs.\n\n" +
      table.markdown() + "\n";
}

}  // namespace sherd::bench
