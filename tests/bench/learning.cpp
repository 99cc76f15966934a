#include "bench/learning.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/rng.h"
#include "embed/embed.h"
#include "load_mesh/load_mesh.h"
#include "tetrahedralize/tetrahedralize.h"

namespace sherd::bench {
namespace {

constexpr std::uint64_t kThrowStream = 0x7468726f77;
constexpr std::uint64_t kNumbersPerThrow = 8;
constexpr int kTimings = 5;

double radiusOf(const Body& body, const BallParams& balls) {
  return balls.radius * boxOf(body.tets->surface->positions).diagonal();
}

/// The n-th throw of a seed.
RigidParams thrown(const Body& body, const TrainDegreeParams& params, const BallParams& balls,
                   std::uint64_t n) {
  const Rng rng(static_cast<std::uint64_t>(balls.seed), kThrowStream);
  const auto uniform = [&](std::uint64_t k) { return rng.uniformAt(kNumbersPerThrow * n + k); };
  RigidParams p = params.drop;
  p.scene = RigidScene::Ball;
  const double height = 2 * uniform(0) - 1, angle = 2 * M_PI * uniform(1);
  const double flat = std::sqrt(1 - height * height);
  p.ballDirection = Vec3(flat * std::cos(angle), height, flat * std::sin(angle));
  p.ballTarget = Vec3(0.1 + 0.8 * uniform(2), 0.1 + 0.8 * uniform(3), 0.1 + 0.8 * uniform(4));
  p.ballRadius = radiusOf(body, balls);
  p.ballSpeed = balls.slowest + uniform(5) * (balls.fastest - balls.slowest);
  return p;
}

/// Impacts of as many throws as are asked for, and their speeds.
std::vector<Impact> throwAll(const Body& body, const TrainDegreeParams& params, const BallParams& balls,
                             std::vector<double>& speeds) {
  std::vector<Impact> impacts;
  for (std::uint64_t n = 0; static_cast<int>(impacts.size()) < balls.throws; ++n) {
    const RigidParams p = thrown(body, params, balls, n);
    Impact impact = orExit(dropUntilImpact(*body.tets, p, Exec{}));
    if (!impact.hit) continue;
    impacts.push_back(std::move(impact));
    speeds.push_back(p.ballSpeed);
  }
  return impacts;
}

}  // namespace

void exitWith(const std::string& error) {
  fmt::print(stderr, "bench_learn: {}\n", error);
  std::exit(1);
}

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double leastSecondsOf(int runs, const std::function<void()>& work) {
  double least = HUGE_VAL;
  for (int k = 0; k < runs; ++k) least = std::min(least, secondsOf(work));
  return least;
}

Body bodyOf(const std::string& file, int tets) {
  LoadMeshParams load;
  load.file = file;
  TetrahedralizeParams params;
  params.tets = tets;
  Body body;
  body.name = std::filesystem::path(file).stem().string();
  const auto mesh = std::make_shared<const TriMesh>(orExit(loadMesh(load, Exec{})));
  body.tets = std::make_shared<const TetMesh>(orExit(tetrahedralize(mesh, params, Exec{})));
  body.embedding = std::make_shared<const Embedding>(orExit(embed(body.tets, {}, Exec{})));
  fmt::print("{}: {} tetrahedra, {} nodes, {} dimensions\n", body.name, body.tets->tets.size(),
             body.tets->nodes.size(), body.embedding->coordinates.rows());
  return body;
}

DropExamples dropsOf(const Body& body, const TrainDegreeParams& params) {
  return orExit(dropExamples(body.tets, body.embedding, nullptr, params, Exec{}));
}

double gammaFor(const Body& body, TrainDegreeParams params, double pieces) {
  params.orientations = 9;
  params.repeats = params.maxDegree = 1;
  params.gamma = 1;
  std::vector<double> energy;
  for (const DropExample& drop : dropsOf(body, params).drops) energy.push_back(drop.wholeEnergy);
  std::nth_element(energy.begin(), energy.begin() + static_cast<std::ptrdiff_t>(energy.size() / 2),
                   energy.end());
  return energy[energy.size() / 2] / std::pow(pieces, 2.0 / 3);
}

DropExamples thrownBalls(const Body& body, const TrainDegreeParams& params, const BallParams& balls) {
  std::vector<double> speeds;
  TrainDegreeParams thrown = params;
  thrown.orientations = 0;
  thrown.impacts = throwAll(body, params, balls, speeds);
  DropExamples out = dropsOf(body, thrown);
  for (DropExample& one : out.drops) one.speed = speeds[one.impact];
  return out;
}

DropExamples ballsToLearnFrom(const Body& body, const TrainDegreeParams& params, const BallParams& balls) {
  TrainDegreeParams hits = params;
  hits.balls = params.orientations;
  hits.orientations = 0;
  hits.drop.ballRadius = radiusOf(body, balls);
  const auto count = static_cast<int>(kBallSpeeds.size());
  for (int k = 0; k < count; ++k)
    hits.ballSpeeds.push_back(balls.slowest + k * (balls.fastest - balls.slowest) / (count - 1));
  return dropsOf(body, hits);
}

WeightField fieldOf(const Body& body, const DropExamples& all, const DropExample& one) {
  return {body.tets,  all.validFor.material, one.example.weight,
          all.volume, all.validFor.alpha,    all.validFor.beta};
}

Comparison compare(const Body& body, const DropExamples& drops, const DegreeModel& model) {
  Comparison c;
  std::vector<double> seconds;
  for (const DropExample& drop : drops.drops) {
    if (drop.example.degree.empty()) continue;
    const WeightField field = fieldOf(body, drops, drop);
    DegreeEstimate estimate;
    seconds.push_back(leastSecondsOf(
        kTimings, [&] { estimate = estimateDegree(model, field, *body.embedding, Deviation::Known); }));
    c.each.push_back({&drop, estimate});
    c.outside += estimate.isOutside;
    double mean = 0, noise = 0;
    for (const int degree : drop.example.degree) mean += degree;
    mean /= static_cast<double>(drop.example.degree.size());
    auto& [searched, foretold] = c.perHeight[drop.height];
    foretold.add(estimate.degree);
    for (const int degree : drop.example.degree) {
      c.searched.add(degree);
      searched.add(degree);
      c.absolute += std::abs(estimate.degree - degree);
      c.squared += std::pow(estimate.degree - degree, 2);
      noise += std::abs(degree - mean);
    }
    c.noise += noise;
    noise /= static_cast<double>(drop.example.degree.size());
    c.within += std::abs(estimate.degree - mean) <= 2 * estimate.deviation + noise;
  }
  c.within /= static_cast<double>(c.each.size());
  c.outside /= static_cast<double>(c.each.size());
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  c.microseconds = 1e6 * *middle;
  return c;
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

}  // namespace sherd::bench
