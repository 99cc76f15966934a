#include "bench/learning.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "embed/embed.h"
#include "load_mesh/load_mesh.h"
#include "tetrahedralize/tetrahedralize.h"
#include "train_degree/growth_path.h"
#include "weights/weights.h"

namespace sherd::bench {
namespace {

constexpr std::uint64_t kThrowStream = 0x7468726f77;
constexpr std::uint64_t kNumbersPerThrow = 8;
constexpr int kTimings = 5;

/// The n-th throw of a seed: whence it comes, where to, and how far between the slowest and the fastest.
RigidParams thrown(const Body& body, const TrainDegreeParams& params, const BallParams& balls,
                   std::uint64_t n, double& share) {
  const Rng rng(static_cast<std::uint64_t>(balls.seed), kThrowStream);
  const auto uniform = [&](std::uint64_t k) { return rng.uniformAt(kNumbersPerThrow * n + k); };
  RigidParams p = params.drop;
  p.scene = RigidScene::Ball;
  const double height = 2 * uniform(0) - 1, angle = 2 * M_PI * uniform(1);
  const double flat = std::sqrt(1 - height * height);
  p.ballDirection = Vec3(flat * std::cos(angle), height, flat * std::sin(angle));
  p.ballTarget = Vec3(0.1 + 0.8 * uniform(2), 0.1 + 0.8 * uniform(3), 0.1 + 0.8 * uniform(4));
  p.ballRadius = balls.radius * boxOf(body.tets->surface->positions).diagonal();
  share = uniform(5);
  return p;
}

/// Impacts of as many throws as are asked for, and the examples that they will be.
std::vector<Impact> throwAll(const Body& body, const TrainDegreeParams& params, const BallParams& balls,
                             DropExamples& out) {
  std::vector<Impact> impacts;
  int group = 0;
  for (std::uint64_t n = 0; group < balls.throws; ++n) {
    double share = 0;
    RigidParams p = thrown(body, params, balls, n, share);
    std::vector<Impact> one;
    for (int k = 0; k < balls.speeds; ++k) {
      const double at = balls.speeds == 1 ? share : k / (balls.speeds - 1.0);
      p.ballSpeed = balls.slowest + at * (balls.fastest - balls.slowest);
      one.push_back(orExit(dropUntilImpact(*body.tets, p, Exec{})));
      if (!one.back().hit) break;
      out.drops.emplace_back();
      out.drops.back().height = p.ballSpeed;
      out.drops.back().example.group = group;
    }
    if (!one.back().hit) continue;
    impacts.insert(impacts.end(), one.begin(), one.end());
    ++group;
  }
  return impacts;
}

void weigh(const Body& body, const TrainDegreeParams& params, const std::vector<Impact>& impacts,
           DropExamples& out) {
  auto energies = orExit(impactEnergies(body.tets, impacts, params.drop.body, params.drop.elements, Exec{}));
  WeightField made;
  for (std::size_t i = 0; i < energies.size(); ++i) {
    EnergyField field;
    field.tets = body.tets;
    field.material = params.drop.body;
    field.nodeEnergy = std::move(energies[i].nodeEnergy);
    made = orExit(weights(field, nullptr, {params.alpha}, Exec{}));
    out.drops[i].strainEnergy = energies[i].total;
    out.drops[i].example.weight = made.weight;
  }
  out.volume = made.volume;
  out.validFor = validityOf(made, body.embedding, params.gamma);
}

void search(const Body& body, const TrainDegreeParams& params, DropExamples& out) {
  parallelFor(Exec{}, out.drops.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      DropExample& drop = out.drops[i];
      for (int r = 0; r < params.repeats; ++r) {
        const auto path = orExit(growthPath(*body.embedding, fieldOf(body, out, drop), params.gamma,
                                            params.seed + r, params.maxDegree, Exec{}));
        drop.wholeEnergy = path[0];
        const auto found = endOf(path, 1, params.gamma);
        if (!found) exitWith(fmt::format("{} sites are not enough for {} J", path.size(), drop.strainEnergy));
        drop.example.degree.push_back(found->degree);
        drop.example.crossing.push_back(found->crossing);
      }
    }
  });
  out.paths = out.drops.size() * static_cast<std::size_t>(params.repeats);
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

DropExamples ballsOf(const Body& body, const TrainDegreeParams& params, const BallParams& balls) {
  DropExamples out;
  weigh(body, params, throwAll(body, params, balls, out), out);
  search(body, params, out);
  return out;
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
