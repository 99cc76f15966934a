#include "simulate/simulate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "simulate/assembly.h"
#include "simulate/impact_refinement.h"
#include "simulate/patch_load.h"
#include "simulate/statics.h"
#include "simulate/supernodal_solve.h"

namespace sherd {
namespace {

template <class... Numbers>
std::string formatted(const char* format, Numbers... numbers) {
  char line[300];
  std::snprintf(line, sizeof line, format, numbers...);
  return line;
}

double sumOf(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

EnergyField withoutEnergy(std::shared_ptr<const TetMesh> mesh, const Material& material) {
  EnergyField field;
  field.tetEnergy.assign(mesh->tets.size(), 0.0);
  field.nodeEnergy.assign(mesh->nodes.size(), 0.0);
  field.displacement.assign(mesh->nodes.size(), Vec3::Zero());
  field.material = material;
  field.tets = std::move(mesh);
  return field;
}

constexpr std::size_t kImpactsAtOnce = 8 * kSolveWidth;  // whose forces and displacements are kept at a time

/// Per tetrahedron, how much of its energy the body holds: stiffness that only keeps up what is outside (see
/// kLeastSupport) holds none of it. So a node's energy over its volume is a mean of energy densities, however
/// little of the body reaches to the node.
std::vector<double> sharesOfBody(const Elements& elements) {
  std::vector<double> share = stiffnessShares(elements);
  for (std::size_t t = 0; t < share.size(); ++t)
    share[t] = std::min(1.0, elements.mesh().insideFraction[t] / share[t]);
  return share;
}

std::vector<double> nodeEnergies(const TetMesh& mesh, std::span<const double> tetEnergy,
                                 std::span<const double> shareOfBody) {
  std::vector<double> sum(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < tetEnergy.size(); ++t)
    for (const Index n : mesh.tets[t]) sum[at(n)] += shareOfBody[t] * tetEnergy[t] / 4;
  return sum;
}

/// An energy that is to be used has to be finite and to have digits.
Result<void> checkSolution(const StaticSolution& solution, double energy) {
  if (!std::isfinite(energy))
    return failure("the strain energy is not a finite number",
                   "check young, the body's tetrahedra and the impact's speed");
  if (!(solution.residual <= kWorstResidual))
    return failure(
        formatted("the deformation could not be solved for: %.2g of the load is left over",
                  solution.residual),
        "the body is too flat for its tetrahedra, hangs together by next to nothing, or its Poisson's "
        "ratio is too close to 1/2");
  return {};
}

/// An impact's forces: at points of tetrahedra, and at element nodes.
struct Load {
  std::vector<PointLoad> points;
  std::vector<Vec3> nodal;
};

Result<Load> loadOf(const PatchLoader& loader, std::size_t nodes, const Impact& impact) {
  Load load{{}, std::vector<Vec3>(nodes, Vec3::Zero())};
  for (const Contact& contact : impact.contacts) {
    const Vec3 force = kHertzPeak / contact.duration * contact.impulse;
    SHERD_ASSIGN(const std::vector<PointLoad> points,
                 loader.pointLoads(contact.point, force, contact.radius));
    loader.hand(points, load.nodal);
    load.points.insert(load.points.end(), points.begin(), points.end());
  }
  return load;
}

/// Bytes that factoring took at most, and pieces that were refined.
struct Effort {
  std::size_t bytes, pieces;
};

Result<Effort> deform(EnergyField& field, const Impact& impact, const SimulateParams& params,
                      const Exec& exec) {
  const double young = field.material.youngModulus;
  SHERD_ASSIGN(const Statics statics,
               Statics::factor(field.tets, {field.material.poissonRatio, params.elements}, exec));
  SHERD_ASSIGN(const Load load,
               loadOf(PatchLoader(statics.elements()), statics.elements()->nodeCount(), impact));
  if (exec.cancelled()) return cancelledError();
  StaticSolution solution = statics.solve(load.nodal, young);
  SHERD_CHECK(checkSolution(solution, sumOf(solution.tetEnergy)));
  Effort effort{statics.peakBytes(), 0};
  if (params.refine && params.elements == ElementOrder::Quadratic) {
    if (exec.cancelled()) return cancelledError();
    SHERD_ASSIGN(effort.pieces,
                 ImpactRefinement(statics).refine(impact, load.nodal, load.points, young, solution, exec));
    SHERD_CHECK(checkSolution(solution, sumOf(solution.tetEnergy)));
  }
  field.nodeEnergy = nodeEnergies(*field.tets, solution.tetEnergy, sharesOfBody(*statics.elements()));
  field.tetEnergy = std::move(solution.tetEnergy);
  field.displacement = std::move(solution.displacement);
  field.displacement.resize(field.tets->nodes.size());
  return effort;
}

double totalImpulse(const Impact& impact) {
  double sum = 0;
  for (const Contact& contact : impact.contacts) sum += contact.impulse.norm();
  return sum;
}

Result<SimulateOutput> run(std::shared_ptr<const TetMesh> mesh, const SimulateParams& params,
                           const Exec& exec) {
  SimulateOutput out;
  SHERD_ASSIGN(out.impact, dropUntilImpact(*mesh, params, exec));
  if (!out.impact.hit) return whyNoImpact(*mesh, params);
  out.energy = withoutEnergy(std::move(mesh), params.body);
  const double impulse = totalImpulse(out.impact);
  const std::string hit =
      formatted("hit after %.4g s at %zu contact%s, %.4g N·s in %.3g s", out.impact.time,
                out.impact.contacts.size(), out.impact.contacts.size() == 1 ? "" : "s", impulse,
                out.impact.contacts.empty() ? 0.0 : out.impact.contacts[0].duration);
  if (impulse < params.threshold) {
    exec.info(hit + formatted(": below the threshold of %.4g N·s, no strain energy", params.threshold));
    return out;
  }
  SHERD_ASSIGN(const Effort effort, deform(out.energy, out.impact, params, exec));
  exec.info(hit +
            formatted(": strain energy %.4g J; factorized in at most %.3g MB", totalEnergy(out.energy),
                      1e-6 * static_cast<double>(effort.bytes)) +
            (effort.pieces > 0 ? formatted("; refined into %zu pieces", effort.pieces) : ""));
  return out;
}

/// Results of each index, in parallel; the first error.
Result<void> forEach(const Exec& exec, std::size_t n, const std::function<Result<void>(std::size_t)>& body) {
  std::vector<Result<void>> results(n);
  parallelFor(exec, n, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) results[i] = body(i);
  });
  if (exec.cancelled()) return cancelledError();
  for (const Result<void>& result : results) SHERD_CHECK(result);
  return {};
}

Result<std::vector<Load>> loadsOfAll(const PatchLoader& loader, std::size_t nodes,
                                     std::span<const Impact> impacts, const Exec& exec) {
  std::vector<Load> loads(impacts.size());
  SHERD_CHECK(forEach(exec, impacts.size(), [&](std::size_t i) -> Result<void> {
    SHERD_ASSIGN(loads[i], loadOf(loader, nodes, impacts[i]));
    return {};
  }));
  return loads;
}

}  // namespace

double totalEnergy(const EnergyField& field) { return sumOf(field.tetEnergy); }

Result<std::vector<Vec3>> impactForces(std::shared_ptr<const Elements> elements, const Impact& impact) {
  SHERD_ASSIGN(Load load, loadOf(PatchLoader(elements), elements->nodeCount(), impact));
  return std::move(load.nodal);
}

Result<void> eachImpactEnergy(std::shared_ptr<const TetMesh> mesh, std::span<const Impact> impacts,
                              const Material& material, ElementOrder elements, bool refine, const Exec& exec,
                              const ImpactEnergySink& sink) {
  SHERD_ASSIGN(const Statics statics, Statics::factor(mesh, {material.poissonRatio, elements}, exec));
  const PatchLoader loader(statics.elements());
  const std::vector<double> shareOfBody = sharesOfBody(*statics.elements());
  std::optional<ImpactRefinement> refinement;
  if (refine && elements == ElementOrder::Quadratic) refinement.emplace(statics);
  const double young = material.youngModulus;
  for (std::size_t begin = 0; begin < impacts.size(); begin += kImpactsAtOnce) {
    const auto some = impacts.subspan(begin, std::min(kImpactsAtOnce, impacts.size() - begin));
    SHERD_ASSIGN(std::vector<Load> loads, loadsOfAll(loader, statics.elements()->nodeCount(), some, exec));
    std::vector<std::vector<Vec3>> forces;
    for (Load& load : loads) forces.push_back(std::move(load.nodal));
    SHERD_ASSIGN(std::vector<StaticSolution> solutions, statics.solveAll(forces, young, exec));
    for (const StaticSolution& s : solutions) SHERD_CHECK(checkSolution(s, sumOf(s.tetEnergy)));
    if (refinement)
      SHERD_CHECK(forEach(exec, some.size(), [&](std::size_t i) -> Result<void> {
        SHERD_CHECK(refinement->refine(some[i], forces[i], loads[i].points, young, solutions[i], exec));
        return checkSolution(solutions[i], sumOf(solutions[i].tetEnergy));
      }));
    std::vector<ImpactEnergy> energies;
    for (const StaticSolution& s : solutions)
      energies.push_back({sumOf(s.tetEnergy), nodeEnergies(*mesh, s.tetEnergy, shareOfBody)});
    SHERD_CHECK(sink(begin, std::move(energies)));
    exec.progress(static_cast<double>(begin + some.size()) / static_cast<double>(impacts.size()));
  }
  return {};
}

Result<std::vector<ImpactEnergy>> impactEnergies(std::shared_ptr<const TetMesh> mesh,
                                                 std::span<const Impact> impacts, const Material& material,
                                                 ElementOrder elements, bool refine, const Exec& exec) {
  std::vector<ImpactEnergy> all;
  SHERD_CHECK(eachImpactEnergy(std::move(mesh), impacts, material, elements, refine, exec,
                               [&](std::size_t, std::vector<ImpactEnergy> energies) -> Result<void> {
                                 std::move(energies.begin(), energies.end(), std::back_inserter(all));
                                 return {};
                               }));
  return all;
}

Result<SimulateOutput> simulate(std::shared_ptr<const TetMesh> mesh, const SimulateParams& params,
                                const Exec& exec) {
  if (!(params.threshold >= 0))
    return Error{"threshold is not 0 or above", "give an impulse in N·s", "threshold", Error::Kind::Input};
  try {
    return run(std::move(mesh), params, exec);
  } catch (const std::exception& error) {
    return failure(std::string("simulating the impact failed: ") + error.what());
  }
}

}  // namespace sherd
