#include "train_degree/train_degree.h"

#include <fmt/format.h>

#include <algorithm>

namespace sherd {
namespace {

std::string tableOf(const DropExamples& drops, const Embedding& embedding, const DegreeModel& model) {
  std::size_t searches = 0;
  for (const DropExample& drop : drops.drops) searches = std::max(searches, drop.example.degree.size());
  std::string csv = "orientation_x,orientation_y,orientation_z,height,strain_energy,whole_energy,foretold";
  for (std::size_t k = 0; k < searches; ++k) csv += fmt::format(",degree_{}", k + 1);
  csv += '\n';
  for (const DropExample& drop : drops.drops) {
    const WeightField weights{embedding.tets, {}, drop.example.weight, drops.volume};
    csv += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}", drop.orientation.x(),
                       drop.orientation.y(), drop.orientation.z(), drop.height, drop.strainEnergy,
                       drop.wholeEnergy, estimateDegree(model, weights, embedding).degree);
    for (std::size_t k = 0; k < searches; ++k)
      csv += k < drop.example.degree.size() ? fmt::format(",{}", drop.example.degree[k]) : ",";
    csv += '\n';
  }
  return csv;
}

void report(const DropExamples& drops, std::size_t learned, const DegreeModel& model, const Exec& exec) {
  const std::size_t left = drops.drops.size() - learned;
  if (left > 0)
    exec.warn(fmt::format(
        "{} of {} drops were left out: their searches ended before E_D was below γ = {:.6g} J·m²; raise γ or "
        "max_degree, or refine the tetrahedral mesh",
        left, drops.drops.size(), drops.validFor.gamma));
  int least = 0, most = 0;
  for (const DropExample& drop : drops.drops)
    for (const int degree : drop.example.degree) {
      least = least == 0 ? degree : std::min(least, degree);
      most = std::max(most, degree);
    }
  if (most == 1)
    exec.warn(fmt::format("no drop breaks the body: lower γ = {:.6g} J·m², or drop it from higher up",
                          drops.validFor.gamma));
  const DegreeErrors& e = model.errors;
  std::string quality = "; one orientation alone says nothing of how good that is for others";
  if (e.examples > 0)
    quality = fmt::format(
        "; on orientations left out it is off by {:.3g} of {:.3g} pieces on average (searches with other "
        "seeds: by {:.3g})",
        e.meanAbsolute, e.meanDegree, e.noise);
  exec.info(fmt::format("learned from {} drops that give {} to {} pieces{}", learned, least, most, quality));
}

}  // namespace

Result<TrainDegreeOutput> learnFromDrops(const DropExamples& drops, const Embedding& embedding,
                                         const LearnDegreeParams& params, const Exec& exec) {
  std::vector<DegreeExample> examples;
  for (const DropExample& drop : drops.drops)
    if (!drop.example.degree.empty()) examples.push_back(drop.example);
  if (examples.empty())
    return failure(fmt::format("no drop's E_D falls below γ = {:.6g} J·m²", drops.validFor.gamma),
                   "raise gamma or max_degree, or refine the tetrahedral mesh", "gamma");
  SHERD_ASSIGN(DegreeModel model,
               learnDegree(examples, embedding, drops.volume, drops.validFor, params, exec));
  report(drops, examples.size(), model, exec);
  std::string table = tableOf(drops, embedding, model);
  return TrainDegreeOutput{std::move(model), std::move(table)};
}

Result<TrainDegreeOutput> trainDegree(const std::shared_ptr<const TetMesh>& tets,
                                      const std::shared_ptr<const Embedding>& embedding,
                                      const ScalarGrid* beta, const TrainDegreeParams& params,
                                      const Exec& exec) {
  SHERD_ASSIGN(const DropExamples drops, dropExamples(tets, embedding, beta, params, exec));
  return learnFromDrops(drops, *embedding, params.learn, exec);
}

}  // namespace sherd
