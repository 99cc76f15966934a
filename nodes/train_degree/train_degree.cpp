#include "train_degree/train_degree.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"

namespace sherd {
namespace {

/// Of the time that a training takes, as measured on bodies of 5,000 tetrahedra.
constexpr double kExamplesShare = 0.8;

/// `exec` for a part of the work, whose progress is that from `begin` to `end` of the whole.
Exec partOf(const Exec& exec, double begin, double end) {
  Exec part = exec;
  part.onProgress = [&exec, begin, end](double share) { exec.progress(begin + share * (end - begin)); };
  return part;
}

const char* nameOf(ExampleSource source) {
  return source == ExampleSource::Drop ? "drop" : source == ExampleSource::Ball ? "ball" : "impact";
}

/// The columns that say what happened; empty where they don't apply.
std::string sourceColumns(const DropExample& e) {
  const auto vector = [](const Vec3& v) { return fmt::format(",{:.9g},{:.9g},{:.9g}", v.x(), v.y(), v.z()); };
  std::string csv = nameOf(e.source);
  if (e.source == ExampleSource::Drop)
    return csv + vector(e.orientation) + fmt::format(",{:.9g},,,,,,,", e.height);
  if (e.source == ExampleSource::Ball)
    return csv + ",,,," + vector(e.hit.target) + vector(e.hit.direction) + fmt::format(",{:.9g}", e.speed);
  return csv + ",,,,,,,,,,,";
}

std::string tableOf(const DropExamples& drops, const Embedding& embedding, const DegreeModel& model,
                    const Exec& exec) {
  std::size_t searches = 0;
  for (const DropExample& drop : drops.drops) searches = std::max(searches, drop.example.degree.size());
  std::string csv =
      "source,orientation_x,orientation_y,orientation_z,height,target_x,target_y,target_z,direction_x,"
      "direction_y,direction_z,speed,strain_energy,whole_energy,foretold";
  for (std::size_t k = 0; k < searches; ++k) csv += fmt::format(",degree_{}", k + 1);
  csv += '\n';
  std::vector<int> foretold(drops.drops.size());
  parallelFor(exec, foretold.size(), 16, [&](std::size_t begin, std::size_t end) {
    WeightField weights{embedding.tets, {}, {}, drops.volume};
    for (std::size_t i = begin; i < end; ++i) {
      weights.weight = drops.drops[i].example.weight;
      foretold[i] = estimateDegree(model, weights, embedding).degree;
    }
  });
  for (std::size_t i = 0; i < foretold.size(); ++i) {
    const DropExample& drop = drops.drops[i];
    csv += sourceColumns(drop) +
           fmt::format(",{:.9g},{:.9g},{}", drop.strainEnergy, drop.wholeEnergy, foretold[i]);
    for (std::size_t k = 0; k < searches; ++k)
      csv += k < drop.example.degree.size() ? fmt::format(",{}", drop.example.degree[k]) : ",";
    csv += '\n';
  }
  return csv;
}

/// "drops", "drops and balls".
std::string wordFor(const std::vector<DropExample>& examples) {
  std::string word;
  for (const ExampleSource source : {ExampleSource::Drop, ExampleSource::Ball, ExampleSource::Impact})
    if (std::any_of(examples.begin(), examples.end(), [&](const auto& e) { return e.source == source; }))
      word += (word.empty() ? "" : " and ") + std::string(nameOf(source)) + 's';
  return word;
}

void report(const DropExamples& drops, std::size_t learned, const DegreeModel& model, const Exec& exec) {
  const std::string word = wordFor(drops.drops);
  const std::size_t left = drops.drops.size() - learned;
  if (left > 0)
    exec.warn(fmt::format(
        "{} of {} {} were left out: their searches ended before E_D was below γ = {:.6g} J·m²; raise γ or "
        "max_degree, or refine the tetrahedral mesh",
        left, drops.drops.size(), word, drops.validFor.gamma));
  int least = 0, most = 0;
  for (const DropExample& drop : drops.drops)
    for (const int degree : drop.example.degree) {
      least = least == 0 ? degree : std::min(least, degree);
      most = std::max(most, degree);
    }
  if (most == 1)
    exec.warn(fmt::format("none of the {} breaks the body: lower γ = {:.6g} J·m², or hit it harder", word,
                          drops.validFor.gamma));
  const DegreeErrors& e = model.errors;
  std::string quality = "; one way alone says nothing of how good that is for others";
  if (e.examples > 0)
    quality = fmt::format(
        "; on {} left out it is off by {:.3g} of {:.3g} pieces on average (searches with other seeds: by "
        "{:.3g})",
        word == "drops" ? "orientations" : "some", e.meanAbsolute, e.meanDegree, e.noise);
  exec.info(
      fmt::format("learned from {} {} that give {} to {} pieces{}", learned, word, least, most, quality));
}

}  // namespace

Result<TrainDegreeOutput> learnFromDrops(const DropExamples& drops, const Embedding& embedding,
                                         const LearnDegreeParams& params, const Exec& exec) {
  std::vector<const DegreeExample*> examples;
  for (const DropExample& drop : drops.drops)
    if (!drop.example.degree.empty()) examples.push_back(&drop.example);
  if (examples.empty())
    return failure(fmt::format("no example's E_D falls below γ = {:.6g} J·m²", drops.validFor.gamma),
                   "raise gamma or max_degree, or refine the tetrahedral mesh", "gamma");
  SHERD_ASSIGN(DegreeModel model,
               learnDegree(examples, embedding, drops.volume, drops.validFor, params, exec));
  report(drops, examples.size(), model, exec);
  std::string table = tableOf(drops, embedding, model, exec);
  return TrainDegreeOutput{std::move(model), std::move(table)};
}

Result<TrainDegreeOutput> trainDegree(const std::shared_ptr<const TetMesh>& tets,
                                      const std::shared_ptr<const Embedding>& embedding,
                                      const ScalarGrid* beta, const TrainDegreeParams& params,
                                      const Exec& exec, Memo* memo) {
  SHERD_ASSIGN(const DropExamples drops,
               dropExamples(tets, embedding, beta, params, partOf(exec, 0, kExamplesShare), memo));
  return learnFromDrops(drops, *embedding, params.learn, partOf(exec, kExamplesShare, 1));
}

}  // namespace sherd
