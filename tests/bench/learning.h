// What the parts of bench_learn share: bodies, examples of drops and of thrown balls, and what a model says
// of them beside what was searched.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "train_degree/train_degree.h"

namespace sherd::bench {

[[noreturn]] void exitWith(const std::string& error);

template <class T>
T orExit(Result<T> result) {
  if (!result.ok()) exitWith(result.error().text());
  return std::move(result).value();
}

double secondsOf(const std::function<void()>& work);
/// s: the least of so many runs, which others on the machine disturb least.
double leastSecondsOf(int runs, const std::function<void()>& work);

struct Body {
  std::string name;
  std::shared_ptr<const TetMesh> tets;
  std::shared_ptr<const Embedding> embedding;
};
Body bodyOf(const std::string& file, int tets);

DropExamples dropsOf(const Body& body, const TrainDegreeParams& params);

/// γ for which the median of a few drops gives about so many pieces, as if E_D fell as N^(-2/3).
double gammaFor(const Body& body, TrainDegreeParams params, double pieces);

/// Steel balls from all around at a body that floats.
struct BallParams {
  int throws = 100;      ///< directions, points to aim at and speeds, all random; misses are thrown anew
  double radius = 0.05;  ///< of the diagonal of the body's box
  double slowest = 3, fastest = 15;  ///< m/s
  std::int64_t seed = 1;
};
/// Searched as drops are; γ, α, repeats and seeds are of `params`.
DropExamples thrownBalls(const Body& body, const TrainDegreeParams& params, const BallParams& balls);
/// As many hits as `params` has orientations, each with several speeds from the slowest to the fastest.
DropExamples ballsToLearnFrom(const Body& body, const TrainDegreeParams& params, const BallParams& balls);

WeightField fieldOf(const Body& body, const DropExamples& all, const DropExample& one);

struct Moments {
  double n = 0, sum = 0, squares = 0;
  void add(double v) { n += 1, sum += v, squares += v * v; }
  double mean() const { return sum / n; }
  double deviation() const { return std::sqrt(std::max(0.0, squares / n - mean() * mean())); }
};

struct Foretold {
  const DropExample* example;
  DegreeEstimate estimate;
};

/// What a model says of examples, beside what was searched.
struct Comparison {
  std::vector<Foretold> each;
  double absolute = 0, squared = 0, noise = 0, outside = 0, microseconds = 0;
  double within = 0;  ///< share of examples whose mean is within two standard deviations and the noise
  Moments searched;
  std::map<double, std::pair<Moments, Moments>> perHeight;  ///< searched, foretold

  double share() const { return absolute / searched.sum; }
  double noiseShare() const { return noise / searched.sum; }
  double rSquared() const { return 1 - squared / (searched.squares - searched.sum * searched.mean()); }
};
Comparison compare(const Body& body, const DropExamples& drops, const DegreeModel& model);

std::string percent(double share);

}  // namespace sherd::bench
