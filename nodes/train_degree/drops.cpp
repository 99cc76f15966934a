// Dropping and searching (train_degree.h).
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "train_degree/growth_path.h"
#include "train_degree/rotations.h"
#include "train_degree/train_degree.h"
#include "weights/weights.h"

namespace sherd {
namespace {

Error outside(const char* parameter, const std::string& value, const char* range) {
  return Error{fmt::format("{} is {}", parameter, value), std::string("must be ") + range, parameter,
               Error::Kind::Input};
}

Result<void> check(const TrainDegreeParams& p) {
  if (p.orientations < 1) return outside("orientations", std::to_string(p.orientations), "at least 1");
  if (p.repeats < 1) return outside("repeats", std::to_string(p.repeats), "at least 1");
  if (p.maxDegree < 1) return outside("max_degree", std::to_string(p.maxDegree), "at least 1");
  if (!(p.gamma > 0) || !std::isfinite(p.gamma))
    return outside("gamma", fmt::format("{:.6g}", p.gamma), "above 0");
  for (const double height : p.heights)
    if (!(height > 0) || !std::isfinite(height))
      return outside("heights", fmt::format("{:.6g} m", height), "above 0");
  return {};
}

/// `exec` for a part of the work, whose progress is that from `begin` to `end` of the whole.
Exec partOf(const Exec& exec, double begin, double end) {
  Exec part{exec.cancel, {}, {}};
  part.onProgress = [&exec, begin, end](double share) { exec.progress(begin + share * (end - begin)); };
  return part;
}

/// body(i) for i in [0, n), in parallel; the first error, by i.
template <class Body>
Result<void> forEach(const Exec& exec, std::size_t n, const Body& body) {
  std::vector<Result<void>> results(n);
  std::atomic<std::size_t> done{0};
  parallelFor(exec, n, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      results[i] = body(i);
      exec.progress(static_cast<double>(++done) / static_cast<double>(n));
    }
  });
  if (exec.cancelled()) return cancelledError();
  for (const auto& result : results) SHERD_CHECK(result);
  return {};
}

/// What a part may do beside others: be cancelled, but not speak.
Exec quiet(const Exec& exec) { return {exec.cancel, {}, {}}; }

Result<std::vector<Impact>> impactsOf(const TetMesh& tets, const std::vector<DropExample>& drops,
                                      const SimulateParams& params, const Exec& exec) {
  std::vector<Impact> impacts(drops.size());
  SHERD_CHECK(forEach(exec, drops.size(), [&](std::size_t i) -> Result<void> {
    RigidParams drop = params;
    drop.scene = RigidScene::Floor;
    drop.orientation = drops[i].orientation;
    drop.dropHeight = drops[i].height;
    SHERD_ASSIGN(impacts[i], dropUntilImpact(tets, drop, quiet(exec)));
    if (!impacts[i].hit) return whyNoImpact(tets, drop);
    return {};
  }));
  return impacts;
}

/// Weights from energies, which are given up.
Result<void> weigh(const std::shared_ptr<const TetMesh>& tets, std::vector<ImpactEnergy> energies,
                   const ScalarGrid* beta, const TrainDegreeParams& params, DropExamples& out,
                   const Exec& exec) {
  return forEach(exec, energies.size(), [&](std::size_t i) -> Result<void> {
    EnergyField field;
    field.tets = tets;
    field.material = params.drop.body;
    field.nodeEnergy = std::move(energies[i].nodeEnergy);
    SHERD_ASSIGN(WeightField made, weights(field, beta, {params.alpha}, quiet(exec)));
    out.drops[i].strainEnergy = energies[i].total;
    out.drops[i].example.weight = std::move(made.weight);
    if (i > 0) return {};
    out.volume = std::move(made.volume);
    out.validFor.beta = made.beta;
    return {};
  });
}

/// The searches of one orientation's drops with one seed.
class OrientationSearch {
 public:
  OrientationSearch(const std::shared_ptr<const TetMesh>& tets, const Embedding& embedding,
                    const std::vector<double>& volume, const TrainDegreeParams& params)
      : tets_(tets), embedding_(embedding), volume_(volume), params_(params) {}

  /// Fills `ends`, one per drop, none where γ is not reached. Returns how many paths were grown.
  Result<std::size_t> run(std::span<const DropExample> drops, std::int64_t seed,
                          std::span<std::optional<PathEnd>> ends, double* wholeEnergy,
                          const Exec& exec) const {
    std::vector<std::size_t> left(drops.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
    std::size_t paths = 0;
    for (; !left.empty(); ++paths) {
      // The strongest needs the longest path.
      const std::size_t reference = *std::max_element(left.begin(), left.end(), [&](auto a, auto b) {
        return drops[a].strainEnergy < drops[b].strainEnergy;
      });
      const std::vector<double>& strongest = drops[reference].example.weight;
      const WeightField field{tets_, {}, strongest, volume_};
      SHERD_ASSIGN(const std::vector<double> path,
                   growthPath(embedding_, field, params_.gamma, seed, params_.maxDegree, exec));
      std::erase_if(left, [&](std::size_t i) {
        const auto factor = i == reference ? 1.0 : factorBetween(drops[i].example.weight, strongest);
        if (!factor) return false;
        ends[i] = endOf(path, *factor, params_.gamma);
        wholeEnergy[i] = *factor * path[0];
        return true;
      });
    }
    return paths;
  }

 private:
  const std::shared_ptr<const TetMesh>& tets_;
  const Embedding& embedding_;
  const std::vector<double>& volume_;
  const TrainDegreeParams& params_;
};

Result<void> searchAll(const std::shared_ptr<const TetMesh>& tets, const Embedding& embedding,
                       std::size_t heights, const TrainDegreeParams& params, DropExamples& out,
                       const Exec& exec) {
  const OrientationSearch search(tets, embedding, out.volume, params);
  const std::size_t drops = out.drops.size(), groups = drops / heights;
  const auto repeats = static_cast<std::size_t>(params.repeats);
  std::vector<std::optional<PathEnd>> ends(repeats * drops);
  std::vector<double> whole(repeats * drops);
  std::vector<std::size_t> paths(repeats * groups);
  SHERD_CHECK(forEach(exec, repeats * groups, [&](std::size_t task) -> Result<void> {
    const std::size_t group = task / repeats, repeat = task % repeats;
    const std::size_t first = group * heights, at = repeat * drops + first;
    SHERD_ASSIGN(paths[task], search.run(std::span(out.drops).subspan(first, heights),
                                         params.seed + static_cast<std::int64_t>(repeat),
                                         std::span(ends).subspan(at, heights), &whole[at], quiet(exec)));
    return {};
  }));
  for (const std::size_t count : paths) out.paths += count;
  for (std::size_t i = 0; i < drops; ++i) {
    out.drops[i].wholeEnergy = whole[i];
    DegreeExample& example = out.drops[i].example;
    for (std::size_t r = 0; r < repeats; ++r)
      if (const auto& end = ends[r * drops + i]) {
        example.degree.push_back(end->degree);
        example.crossing.push_back(end->crossing);
      }
    // The others alone would be the lucky ones.
    if (example.degree.size() < repeats) example.degree.clear(), example.crossing.clear();
  }
  return {};
}

}  // namespace

Result<DropExamples> dropExamples(const std::shared_ptr<const TetMesh>& tets,
                                  const std::shared_ptr<const Embedding>& embedding, const ScalarGrid* beta,
                                  const TrainDegreeParams& params, const Exec& exec) {
  SHERD_CHECK(check(params));
  const std::vector<double>& heights = params.heights.empty() ? kDropHeights : params.heights;
  DropExamples out;
  int group = 0;
  for (const Vec3& orientation : uniformOrientations(params.orientations, params.seed)) {
    for (const double height : heights) {
      out.drops.emplace_back();
      out.drops.back().orientation = orientation;
      out.drops.back().height = height;
      out.drops.back().example.group = group;
    }
    ++group;
  }
  SHERD_ASSIGN(const std::vector<Impact> impacts,
               impactsOf(*tets, out.drops, params.drop, partOf(exec, 0, 0.05)));
  SHERD_ASSIGN(
      std::vector<ImpactEnergy> energies,
      impactEnergies(tets, impacts, params.drop.body, params.drop.elements, partOf(exec, 0.05, 0.2)));
  SHERD_CHECK(weigh(tets, std::move(energies), beta, params, out, partOf(exec, 0.2, 0.25)));
  WeightField field{tets, params.drop.body, {}, {}, params.alpha, out.validFor.beta};
  out.validFor = validityOf(field, embedding, params.gamma);
  SHERD_CHECK(searchAll(tets, *embedding, heights.size(), params, out, partOf(exec, 0.25, 0.9)));
  return out;
}

}  // namespace sherd
