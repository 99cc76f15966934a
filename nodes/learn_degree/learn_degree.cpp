#include "learn_degree/learn_degree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "base/value_type.h"
#include "learn_degree/network.h"
#include "learn_degree/principal_components.h"
#include "learn_degree/process.h"
#include "learn_degree/split_tree.h"
#include "learn_degree/weight_point.h"

namespace sherd {
namespace {

/// A spread below these counts as these: an input that the examples don't vary in is still one to differ in.
constexpr double kLeastLogSpread = 1e-3;
constexpr double kLeastShapeSpread = 1e-3;
/// What a search needs of the tree's cells (learn_degree/split_tree.h), where no example says it.
constexpr double kTreeRatio = 0.8;

/// Of the time that learning takes.
constexpr double kFitShare = 0.6, kEstimateShare = 0.1;

using ExampleList = std::vector<const DegreeExample*>;

/// What is learned from, beside the examples.
struct Body {
  const Embedding& embedding;
  const std::vector<double>& volume;
  const DegreeValidity& validFor;
  const LearnDegreeParams& params;
  std::vector<Index> order;  ///< of splitOrder, for a process
};

/// What a fit to all examples decides, for the fits to parts of them.
struct Decided {
  std::optional<Eigen::Index> centres;
  std::optional<ProcessScales> scales;
};

Result<void> checkExample(const DegreeExample& example, std::size_t nodes) {
  if (example.weight.size() != nodes)
    return failure(fmt::format("has {} weights for {} nodes", example.weight.size(), nodes));
  for (const double w : example.weight)
    if (!std::isfinite(w) || w < 0)
      return failure(fmt::format("has a weight of {}", w), "weights are finite and not negative");
  if (example.degree.empty() || example.degree.size() != example.crossing.size())
    return failure("has no search, or not one crossing for each");
  for (const int degree : example.degree)
    if (degree < 1) return failure(fmt::format("has a degree of {}", degree), "a degree is at least 1");
  for (const double crossing : example.crossing)
    if (!std::isfinite(crossing) || crossing <= 0)
      return failure(fmt::format("crosses γ at {} pieces", crossing));
  return {};
}

Result<void> check(const ExampleList& examples, const Body& body) {
  if (examples.empty()) return failure("there are no examples to learn from");
  const auto nodes = static_cast<std::size_t>(body.embedding.coordinates.cols());
  if (body.volume.size() != nodes || nodes == 0)
    return failure(fmt::format("{} volumes for {} nodes of the embedding", body.volume.size(), nodes));
  for (std::size_t i = 0; i < examples.size(); ++i)
    if (const auto good = checkExample(*examples[i], nodes); !good.ok())
      return failure(fmt::format("example {} {}", i + 1, good.error().what), good.error().remedy);
  const double gamma = body.validFor.gamma, tolerance = body.params.tolerance;
  if (!(gamma > 0) || !std::isfinite(gamma))
    return failure(fmt::format("γ is {}", gamma), "learning needs one above 0", "gamma");
  if (!(tolerance >= 0 && tolerance < 1))
    return failure(fmt::format("the tolerance of the principal components is {}", tolerance),
                   "it is at least 0 and below 1", "pca_tolerance");
  if (!(body.params.trainingError >= 0))
    return failure("the training error is negative or NaN", {}, "training_error");
  return {};
}

/// body(i) for i in [0, n), in parallel.
template <class F>
void forEach(std::size_t n, const Exec& exec, const F& body) {
  parallelFor(exec, n, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Examples with equal weights as one.
std::vector<ExampleList> distinct(const ExampleList& examples, const Exec& exec) {
  std::vector<ExampleList> out;
  std::vector<Digest> digests(examples.size());
  forEach(examples.size(), exec,
          [&](std::size_t i) { digests[i] = Hasher().add(examples[i]->weight).digest(); });
  std::map<Digest, std::size_t> place;
  for (std::size_t i = 0; i < examples.size(); ++i) {
    const auto [at, isNew] = place.emplace(digests[i], out.size());
    if (isNew) out.emplace_back();
    out[at->second].push_back(examples[i]);
  }
  return out;
}

/// Those that a process is made of: no more than it can hold.
std::vector<ExampleList> thinned(std::vector<ExampleList> distinct) {
  std::vector<ExampleList> out;
  for (const Eigen::Index i : evenlyChosen(static_cast<Eigen::Index>(distinct.size()), kMostExamples))
    out.push_back(std::move(distinct[static_cast<std::size_t>(i)]));
  return out;
}

/// Targets, counts and groups; no points yet.
Samples samplesOf(const std::vector<ExampleList>& distinct, DegreeMethod method) {
  const auto n = static_cast<Eigen::Index>(distinct.size());
  Samples samples{{}, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const ExampleList& same = distinct[static_cast<std::size_t>(i)];
    for (const DegreeExample* e : same)
      for (std::size_t k = 0; k < e->degree.size(); ++k) {
        samples.target[i] += method == DegreeMethod::Process ? std::log(e->crossing[k]) : e->degree[k];
        samples.count[i] += 1;
      }
    samples.target[i] /= samples.count[i];
    samples.group.push_back(same[0]->group);
  }
  return samples;
}

/// Fills mean, basis and residualFactor: a basis whose coordinates have a spread of 1 all together where
/// `unit`.
Result<void> setBasis(const std::vector<ExampleList>& distinct, double tolerance, bool unit,
                      DegreeModel& model, const Exec& exec) {
  const auto chosen = evenlyChosen(static_cast<Eigen::Index>(distinct.size()), kMostExamples);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(distinct[0][0]->weight.size()),
                       static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k)
    rows.col(static_cast<Eigen::Index>(k)) =
        dividedWeights(distinct[static_cast<std::size_t>(chosen[k])][0]->weight, model.scale);
  SHERD_ASSIGN(PrincipalComponents components, principalComponents(rows, tolerance, exec));
  model.mean.assign(components.mean.begin(), components.mean.end());
  model.basis = std::move(components.basis);
  model.residualFactor = 1;
  if (!unit) return {};
  const double spread = std::max(components.total / std::sqrt(static_cast<double>(rows.cols())),
                                 kLeastShapeSpread * components.mean.norm());
  model.basis /= spread;
  model.residualFactor /= spread;
  return {};
}

void setFeatureScale(const std::vector<ExampleList>& distinct, const Body& body, DegreeModel& model,
                     const Exec& exec) {
  Eigen::MatrixXd features(kFeatures, static_cast<Eigen::Index>(distinct.size()));
  forEach(distinct.size(), exec, [&](std::size_t i) {
    features.col(static_cast<Eigen::Index>(i)) =
        logFeatures(body.order, distinct[i][0]->weight, body.volume, body.embedding, body.validFor.gamma)
            .value;
  });
  model.featureScale.resize(kFeatures, 2);
  const Eigen::VectorXd mean = features.rowwise().mean();
  const Eigen::VectorXd variance =
      (features.colwise() - mean).rowwise().squaredNorm() / static_cast<double>(features.cols());
  model.featureScale.col(0) = mean;
  model.featureScale.col(1) = variance.cwiseSqrt().cwiseMax(kLeastLogSpread).cwiseInverse();
}

struct Points {
  Eigen::MatrixXd z;
  Eigen::VectorXd residual, logPieces;
};

Points pointsOf(const std::vector<ExampleList>& distinct, const Body& body, const DegreeModel& model,
                const Exec& exec) {
  const auto n = static_cast<Eigen::Index>(distinct.size());
  Points points{Eigen::MatrixXd(model.featureScale.rows() + model.basis.rows(), n), Eigen::VectorXd(n),
                Eigen::VectorXd(n)};
  forEach(distinct.size(), exec, [&](std::size_t i) {
    const WeightPoint p = pointOf(model, distinct[i][0]->weight, body.volume, body.embedding);
    points.z.col(static_cast<Eigen::Index>(i)) = p.z;
    points.residual[static_cast<Eigen::Index>(i)] = p.residual;
    points.logPieces[static_cast<Eigen::Index>(i)] = p.logPieces;
  });
  return points;
}

/// The largest distance of an example from those of other groups: something new may be as far.
double reachOf(const Eigen::MatrixXd& z, const Eigen::VectorXd& residual, const std::vector<int>& group) {
  const bool isOneGroup = std::all_of(group.begin(), group.end(), [&](int g) { return g == group[0]; });
  double reach = 0;
  for (Eigen::Index i = 0; i < z.cols(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < z.cols(); ++j)
      if (isOneGroup ? i != j : group[static_cast<std::size_t>(i)] != group[static_cast<std::size_t>(j)])
        nearest = std::min(nearest, (z.col(i) - z.col(j)).squaredNorm() + residual[i] * residual[i]);
    if (std::isfinite(nearest)) reach = std::max(reach, std::sqrt(nearest));
  }
  return reach;
}

/// Keeps the points that may be centres, and the reach among them.
void setPoints(const Points& points, const Samples& samples, DegreeModel& model) {
  const auto chosen = evenlyChosen(points.z.cols(), kMostExamples);
  model.points = points.z(Eigen::all, chosen);
  std::vector<int> group;
  for (const Eigen::Index i : chosen) group.push_back(samples.group[static_cast<std::size_t>(i)]);
  model.reach = reachOf(model.points, points.residual(chosen), group);
  for (Index& c : model.centres)
    c = static_cast<Index>(std::lower_bound(chosen.begin(), chosen.end(), c) - chosen.begin());
}

void setFit(Fit fit, DegreeModel& model) {
  model.centres = std::move(fit.centres);
  model.coefficient.assign(fit.coefficient.begin(), fit.coefficient.end());
  model.bias = fit.bias;
  model.whitening = std::move(fit.whitening);
  model.variance = fit.variance;
}

Result<void> fitNetworkModel(const std::vector<ExampleList>& all, const Body& body, Decided& decided,
                             DegreeModel& model, const Exec& exec) {
  double squares = 0;
  for (const ExampleList& same : all) squares += dividedWeights(same[0]->weight, 1).squaredNorm();
  model.scale = std::sqrt(squares / static_cast<double>(all.size()));
  if (!(model.scale > 0)) model.scale = 1;
  SHERD_CHECK(setBasis(all, body.params.tolerance, false, model, exec));
  Samples samples = samplesOf(all, model.method);
  const Points points = pointsOf(all, body, model, exec);
  samples.points = points.z;
  SHERD_ASSIGN(Fit fit, model.method == DegreeMethod::Exact
                            ? fitExactly(samples, exec)
                            : fitNetwork(samples, body.params.trainingError, decided.centres, exec));
  decided.centres = static_cast<Eigen::Index>(fit.centres.size());
  setFit(std::move(fit), model);
  setPoints(points, samples, model);
  return {};
}

/// Lengths go into what points are made with, so that distances between points are in lengths.
void foldLengths(const ProcessFit& fitted, DegreeModel& model) {
  model.featureScale.col(1) *= fitted.scales.feature;
  model.basis *= fitted.scales.component;
  model.residualFactor *= fitted.scales.component;
  if (fitted.scales.component > 0) return;
  model.basis.resize(0, 0);
  model.mean.clear();
}

Result<void> fitProcessModel(const ExampleList& examples, const Body& body, Decided& decided,
                             DegreeModel& model, const Exec& exec) {
  ExampleList broken;
  std::vector<double> whole(examples.size());
  forEach(examples.size(), exec,
          [&](std::size_t i) { whole[i] = wholeEnergy(examples[i]->weight, body.volume, body.embedding); });
  for (std::size_t i = 0; i < examples.size(); ++i)
    if (whole[i] >= body.validFor.gamma) broken.push_back(examples[i]);
  model.featureScale = Eigen::MatrixXd::Zero(kFeatures, 2);
  model.order = body.order;
  model.bias = std::log(kTreeRatio);
  model.points.resize(kFeatures, 0);
  if (broken.empty()) return {};
  const std::vector<ExampleList> all = thinned(distinct(broken, exec));
  if (exec.cancelled()) return cancelledError();
  setFeatureScale(all, body, model, exec);
  SHERD_CHECK(setBasis(all, body.params.tolerance, true, model, exec));
  Samples samples = samplesOf(all, model.method);
  Points points = pointsOf(all, body, model, exec);
  if (exec.cancelled()) return cancelledError();
  samples.points = std::move(points.z);
  samples.target -= points.logPieces;
  SHERD_ASSIGN(ProcessFit fitted, fitProcess(samples, kFeatures, decided.scales, exec));
  decided.scales = fitted.scales;
  setFit(std::move(fitted.fit), model);
  model.noise = fitted.scales.noise;
  foldLengths(fitted, model);
  setPoints(pointsOf(all, body, model, exec), samples, model);
  return {};
}

Result<DegreeModel> fitModel(const ExampleList& examples, const Body& body, Decided& decided,
                             const Exec& exec) {
  DegreeModel model;
  model.validFor = body.validFor;
  model.method = body.params.method;
  if (model.method == DegreeMethod::Process)
    SHERD_CHECK(fitProcessModel(examples, body, decided, model, exec));
  else
    SHERD_CHECK(fitNetworkModel(distinct(examples, exec), body, decided, model, exec));
  return model;
}

/// Sums over searches, of what a model says of them.
class ErrorSums {
 public:
  void add(const DegreeExample& example, int foretold) {
    double mean = 0;
    for (const int degree : example.degree) mean += degree;
    mean /= static_cast<double>(example.degree.size());
    for (const int degree : example.degree) {
      n_ += 1;
      sum_ += degree;
      squares_ += static_cast<double>(degree) * degree;
      absolute_ += std::abs(foretold - degree);
      squaredError_ += std::pow(foretold - degree, 2);
      noise_ += std::abs(degree - mean);
    }
  }
  DegreeErrors errors() const {
    if (n_ == 0) return {};
    const double spread = squares_ - sum_ * sum_ / n_;
    const double r2 = spread > 0 ? 1 - squaredError_ / spread : squaredError_ > 0 ? 0 : 1;
    return {n_, sum_ / n_, absolute_ / n_, r2, noise_ / n_};
  }

 private:
  double n_ = 0, sum_ = 0, squares_ = 0, absolute_ = 0, squaredError_ = 0, noise_ = 0;
};

/// Fits without each fifth of the groups, and foretells that fifth.
Result<DegreeErrors> errorsOnGroupsLeftOut(const ExampleList& examples, const Body& body,
                                           const Decided& decided, const Exec& exec) {
  std::vector<int> group;
  for (const DegreeExample* e : examples) group.push_back(e->group);
  const Folds folds = foldsOf(group);
  if (folds.count < 2) return DegreeErrors{};
  std::vector<Result<DegreeModel>> models(static_cast<std::size_t>(folds.count), failure("was not fitted"));
  parallelFor(exec, models.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t fold = begin; fold < end; ++fold) {
      ExampleList kept;
      for (std::size_t i = 0; i < examples.size(); ++i)
        if (folds.of[i] != static_cast<int>(fold)) kept.push_back(examples[i]);
      Decided same = decided;
      models[fold] = fitModel(kept, body, same, exec);
    }
  });
  if (exec.cancelled()) return cancelledError();
  for (const auto& model : models) SHERD_CHECK(model);
  exec.progress(1 - kEstimateShare);
  std::vector<int> foretold(examples.size());
  parallelFor(exec, examples.size(), 16, [&](std::size_t begin, std::size_t end) {
    WeightField weights{body.embedding.tets, {}, {}, body.volume};
    for (std::size_t i = begin; i < end; ++i) {
      weights.weight = examples[i]->weight;
      const DegreeModel& model = *models[static_cast<std::size_t>(folds.of[i])];
      foretold[i] = estimateDegree(model, weights, body.embedding).degree;
    }
  });
  if (exec.cancelled()) return cancelledError();
  ErrorSums sums;
  for (std::size_t i = 0; i < examples.size(); ++i) sums.add(*examples[i], foretold[i]);
  return sums.errors();
}

}  // namespace

Result<DegreeModel> learnDegree(std::span<const DegreeExample* const> examples, const Embedding& embedding,
                                const std::vector<double>& volume, const DegreeValidity& validFor,
                                const LearnDegreeParams& params, const Exec& exec) {
  Body body{embedding, volume, validFor, params, {}};
  const ExampleList list(examples.begin(), examples.end());
  SHERD_CHECK(check(list, body));
  if (params.method == DegreeMethod::Process) body.order = splitOrder(embedding, exec);
  if (exec.cancelled()) return cancelledError();
  Decided decided;
  SHERD_ASSIGN(DegreeModel model, fitModel(list, body, decided, exec));
  if (exec.cancelled()) return cancelledError();
  exec.progress(kFitShare);
  SHERD_ASSIGN(model.errors, errorsOnGroupsLeftOut(list, body, decided, exec));
  return model;
}

Result<DegreeModel> learnDegree(const std::vector<DegreeExample>& examples, const Embedding& embedding,
                                const std::vector<double>& volume, const DegreeValidity& validFor,
                                const LearnDegreeParams& params, const Exec& exec) {
  ExampleList list;
  for (const DegreeExample& e : examples) list.push_back(&e);
  return learnDegree(std::span<const DegreeExample* const>(list), embedding, volume, validFor, params, exec);
}

}  // namespace sherd
