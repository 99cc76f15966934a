// Dropping, throwing and searching (train_degree.h).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <unordered_map>

#include "base/value_type.h"
#include "train_degree/growth_path.h"
#include "train_degree/kept.h"
#include "train_degree/phases.h"
#include "train_degree/sources.h"
#include "train_degree/train_degree.h"
#include "train_degree/unit_load.h"
#include "weights/weights.h"

namespace sherd {
namespace {

using Clock = std::chrono::steady_clock;

/// What parts of the work cost beside each other, as measured on bodies of 5,000 tetrahedra.
constexpr double kImpactCost = 1, kEnergyCost = 1.2, kWeightCost = 0.1, kPathCost = 3.5;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// One way in which the body is loaded, by any number of examples.
struct Load {
  Impact unit;
  std::size_t uses = 0;
  double strongest = 0;  ///< N, of the examples
  KeptEnergy energy;     ///< under the unit load, until it is made weights of
  double total = 0;      ///< J
  std::vector<double> weight;
  std::vector<std::vector<double>> path;  ///< energies per repeat
};

/// What an example is: a load, and how strong it is.
struct Use {
  std::size_t load = 0;
  double strength = 0;  ///< N
};

class Examples {
 public:
  Examples(const std::shared_ptr<const TetMesh>& tets, const std::shared_ptr<const Embedding>& embedding,
           const ScalarGrid* beta, const TrainDegreeParams& params, Memo* memo)
      : tets_(tets),
        embedding_(embedding),
        beta_(beta),
        params_(params),
        memo_(memo),
        body_(sharedDigest(valueType<TetMesh>(), tets)),
        metric_(sharedDigest(valueType<Embedding>(), embedding)),
        repeats_(static_cast<std::size_t>(params.repeats)) {}

  Result<DropExamples> make(const Exec& exec) {
    SHERD_ASSIGN(out_.drops, examplesOf(*tets_, params_));
    Phases phases(exec);
    SHERD_CHECK(findImpacts(phases, exec));
    SHERD_CHECK(findEnergies(phases, exec));
    SHERD_CHECK(weigh(phases, exec));
    SHERD_CHECK(search(phases, exec));
    SHERD_CHECK(fill(exec));
    return std::move(out_);
  }

 private:
  Result<void> findImpacts(Phases& phases, const Exec& exec);
  void setLoads(const std::vector<Impact>& impacts);
  Result<void> findEnergies(Phases& phases, const Exec& exec);
  Result<void> weigh(Phases& phases, const Exec& exec);
  Result<void> search(Phases& phases, const Exec& exec);
  Result<void> fill(const Exec& exec);
  Result<Impact> impactOf(const RigidParams& scene, const Digest& key, const Exec& exec) const;
  Digest keyOfPath(const Load& load, std::size_t repeat) const {
    return pathKey(metric_, load.weight, out_.volume, seedOf(repeat));
  }
  std::int64_t seedOf(std::size_t repeat) const { return params_.seed + static_cast<std::int64_t>(repeat); }
  PathGoal goalFor(double strength) const { return {strength * strength, params_.gamma, params_.maxDegree}; }

  const std::shared_ptr<const TetMesh>& tets_;
  const std::shared_ptr<const Embedding>& embedding_;
  const ScalarGrid* beta_;
  const TrainDegreeParams& params_;
  Memo* memo_;
  Digest body_, metric_;
  std::size_t repeats_;

  DropExamples out_;
  std::vector<Load> loads_;
  std::vector<Use> uses_;  ///< per example
};

/// In the scene of an example, found before or now.
Result<Impact> Examples::impactOf(const RigidParams& scene, const Digest& key, const Exec& exec) const {
  const auto start = Clock::now();
  SHERD_ASSIGN(Impact impact, dropUntilImpact(*tets_, scene, exec));
  if (!impact.hit) return whyNoImpact(*tets_, scene);
  remember(memo_, key, impact, msSince(start));
  return impact;
}

Result<void> Examples::findImpacts(Phases& phases, const Exec& exec) {
  const std::size_t n = out_.drops.size();
  std::vector<Impact> impacts(n);
  std::vector<Digest> keys(n);
  std::vector<char> isKnown(n, 0);
  SHERD_CHECK(forEach(quiet(exec), n, [&](std::size_t i) -> Result<void> {
    const DropExample& example = out_.drops[i];
    if (example.source != ExampleSource::Impact) {
      keys[i] = impactKey(body_, sceneOf(example, params_));
      auto known = recall<Impact>(memo_, keys[i]);
      if (!known || !known->hit) return {};
      impacts[i] = std::move(*known);
    } else {
      impacts[i] = params_.impacts[example.impact];
    }
    isKnown[i] = 1;
    return {};
  }));
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < n; ++i)
    if (!isKnown[i]) left.push_back(i);
  out_.impacts = left.size();
  const auto searches =
      static_cast<double>(repeats_ * static_cast<std::size_t>(1 + out_.drops.back().example.group));
  const Exec part = phases.next(kImpactCost * static_cast<double>(left.size()), kPathCost * searches);
  SHERD_CHECK(forEach(part, left.size(), [&](std::size_t k) -> Result<void> {
    const std::size_t i = left[k];
    SHERD_ASSIGN(impacts[i], impactOf(sceneOf(out_.drops[i], params_), keys[i], quiet(exec)));
    return {};
  }));
  setLoads(impacts);
  return {};
}

void Examples::setLoads(const std::vector<Impact>& impacts) {
  const double size = sizeOf(*tets_);
  std::unordered_map<Digest, std::size_t> place;
  for (const Impact& impact : impacts) {
    UnitLoad unit = unitLoadOf(impact, size);
    const auto [at, isNew] = place.emplace(digestOfLoad(unit.impact), loads_.size());
    if (isNew) loads_.emplace_back().unit = std::move(unit.impact);
    Load& load = loads_[at->second];
    ++load.uses;
    load.strongest = std::max(load.strongest, unit.strength);
    uses_.push_back({at->second, unit.strength});
  }
}

Result<void> Examples::findEnergies(Phases& phases, const Exec& exec) {
  const Material& material = params_.drop.body;
  std::vector<Digest> keys(loads_.size());
  SHERD_CHECK(forEach(quiet(exec), loads_.size(), [&](std::size_t i) -> Result<void> {
    keys[i] = energyKey(body_, params_.drop, digestOfLoad(loads_[i].unit));
    if (auto known = recall<KeptEnergy>(memo_, keys[i])) loads_[i].energy = std::move(*known);
    return {};
  }));
  std::vector<std::size_t> left;
  std::vector<Impact> impacts;
  for (std::size_t i = 0; i < loads_.size(); ++i)
    if (loads_[i].energy.nodeEnergy.size() != tets_->nodes.size())
      left.push_back(i), impacts.push_back(loads_[i].unit);
  out_.solves = left.size();
  const auto n = static_cast<double>(loads_.size());
  const Exec part = phases.next(kEnergyCost * static_cast<double>(left.size()),
                                (kWeightCost + kPathCost * static_cast<double>(repeats_)) * n);
  if (left.empty()) return {};
  auto last = Clock::now();
  return eachImpactEnergy(
      tets_, impacts, material, params_.drop.elements, params_.drop.refine, part,
      [&](std::size_t first, std::vector<ImpactEnergy> energies) -> Result<void> {
        const double ms = msSince(last) / static_cast<double>(energies.size());
        SHERD_CHECK(forEach(quiet(exec), energies.size(), [&](std::size_t k) -> Result<void> {
          const std::size_t i = left[first + k];
          loads_[i].energy = {std::move(energies[k])};
          remember(memo_, keys[i], loads_[i].energy, ms);
          return {};
        }));
        last = Clock::now();
        return {};
      });
}

Result<void> Examples::weigh(Phases& phases, const Exec& exec) {
  const auto n = static_cast<double>(loads_.size());
  const Exec part = phases.next(kWeightCost * n, kPathCost * static_cast<double>(repeats_) * n);
  SHERD_CHECK(forEach(part, loads_.size(), [&](std::size_t i) -> Result<void> {
    EnergyField field;
    field.tets = tets_;
    field.material = params_.drop.body;
    field.nodeEnergy = std::move(loads_[i].energy.nodeEnergy);
    loads_[i].total = loads_[i].energy.total;
    SHERD_ASSIGN(WeightField made, weights(field, beta_, {params_.alpha}, quiet(exec)));
    loads_[i].weight = std::move(made.weight);
    if (i > 0) return {};
    out_.volume = std::move(made.volume);
    out_.validFor.beta = made.beta;
    return {};
  }));
  WeightField field{tets_, params_.drop.body, {}, {}, params_.alpha, out_.validFor.beta};
  out_.validFor = validityOf(field, embedding_, params_.gamma);
  return {};
}

Result<void> Examples::search(Phases& phases, const Exec& exec) {
  const std::size_t n = loads_.size() * repeats_;
  std::vector<GrowthPath> paths(n);
  for (Load& load : loads_) load.path.resize(repeats_);
  const auto loadOf = [&](std::size_t task) -> Load& { return loads_[task / repeats_]; };
  SHERD_CHECK(forEach(quiet(exec), n, [&](std::size_t task) -> Result<void> {
    if (auto known = recall<GrowthPath>(memo_, keyOfPath(loadOf(task), task % repeats_)))
      paths[task] = std::move(*known);
    if (isComplete(paths[task], goalFor(loadOf(task).strongest))) paths[task].sites.resize(0, 0);
    return {};
  }));
  std::vector<std::size_t> left;
  for (std::size_t task = 0; task < n; ++task)
    if (!isComplete(paths[task], goalFor(loadOf(task).strongest))) left.push_back(task);
  out_.paths = left.size();
  // Long ones first, so that no thread is left with one at the end: what takes long is about as the energy.
  std::vector<double> cost(n);
  for (std::size_t task = 0; task < n; ++task)
    cost[task] = loadOf(task).total * std::pow(loadOf(task).strongest, 2);
  std::stable_sort(left.begin(), left.end(), [&](auto a, auto b) { return cost[a] > cost[b]; });
  const Exec part = phases.next(1, 0);
  CostProgress progress(part);
  for (const std::size_t task : left) progress.add(cost[task]);
  SHERD_CHECK(forEach(quiet(exec), left.size(), [&](std::size_t k) -> Result<void> {
    const std::size_t task = left[k];
    const Load& load = loadOf(task);
    const auto start = Clock::now();
    const WeightField field{tets_, {}, load.weight, out_.volume};
    SHERD_CHECK(follow(paths[task], goalFor(load.strongest), *embedding_, field, seedOf(task % repeats_),
                       quiet(exec)));
    remember(memo_, keyOfPath(load, task % repeats_), paths[task], msSince(start));
    paths[task].sites.resize(0, 0);  // a hundred thousand of them would take gigabytes
    progress.done(cost[task]);
    return {};
  }));
  for (std::size_t task = 0; task < n; ++task)
    loadOf(task).path[task % repeats_] = std::move(paths[task].energy);
  return {};
}

/// From loads to examples.
Result<void> Examples::fill(const Exec& exec) {
  return forEach(quiet(exec), out_.drops.size(), [&](std::size_t i) -> Result<void> {
    Load& load = loads_[uses_[i].load];
    const double factor = uses_[i].strength * uses_[i].strength;
    DropExample& out = out_.drops[i];
    out.strainEnergy = factor * load.total;
    out.wholeEnergy = factor * load.path.back().at(0);
    out.example.weight = load.uses > 1 ? load.weight : std::move(load.weight);
    for (double& w : out.example.weight) w *= factor;
    for (const std::vector<double>& path : load.path)
      if (const auto end = endOf(path, goalFor(uses_[i].strength))) {
        out.example.degree.push_back(end->degree);
        out.example.crossing.push_back(end->crossing);
      }
    // The others alone would be the lucky ones.
    if (out.example.degree.size() < repeats_) out.example.degree.clear(), out.example.crossing.clear();
    return {};
  });
}

}  // namespace

Result<DropExamples> dropExamples(const std::shared_ptr<const TetMesh>& tets,
                                  const std::shared_ptr<const Embedding>& embedding, const ScalarGrid* beta,
                                  const TrainDegreeParams& params, const Exec& exec, Memo* memo) {
  SHERD_CHECK(checkSources(*tets, params));
  return Examples(tets, embedding, beta, params, memo).make(exec);
}

}  // namespace sherd
