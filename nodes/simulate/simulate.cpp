#include "simulate/simulate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iterator>
#include <numeric>
#include <string>

#include "base/parallel.h"
#include "simulate/assembly.h"
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

/// Returns the bytes that factoring took at most.
Result<std::size_t> deform(EnergyField& field, const Impact& impact, ElementOrder order, const Exec& exec) {
  SHERD_ASSIGN(const Statics statics,
               Statics::factor(field.tets, {field.material.poissonRatio, order}, exec));
  SHERD_ASSIGN(const std::vector<Vec3> force, impactForces(statics.elements(), impact));
  if (exec.cancelled()) return cancelledError();
  StaticSolution solution = statics.solve(force, field.material.youngModulus);
  SHERD_CHECK(checkSolution(solution, sumOf(solution.tetEnergy)));
  field.nodeEnergy = nodeEnergies(*field.tets, solution.tetEnergy, sharesOfBody(*statics.elements()));
  field.tetEnergy = std::move(solution.tetEnergy);
  field.displacement = std::move(solution.displacement);
  field.displacement.resize(field.tets->nodes.size());
  return statics.peakBytes();
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
  SHERD_ASSIGN(const std::size_t bytes, deform(out.energy, out.impact, params.elements, exec));
  exec.info(hit + formatted(": strain energy %.4g J; factorized in at most %.3g MB", totalEnergy(out.energy),
                            1e-6 * static_cast<double>(bytes)));
  return out;
}

Result<std::vector<Vec3>> forcesOf(const PatchLoader& loader, std::size_t nodes, const Impact& impact) {
  std::vector<Vec3> force(nodes, Vec3::Zero());
  for (const Contact& contact : impact.contacts)
    SHERD_CHECK(
        loader.add(contact.point, kHertzPeak / contact.duration * contact.impulse, contact.radius, force));
  return force;
}

Result<std::vector<std::vector<Vec3>>> forcesOfAll(const PatchLoader& loader, std::size_t nodes,
                                                   std::span<const Impact> impacts, const Exec& exec) {
  std::vector<std::vector<Vec3>> forces(impacts.size());
  std::vector<Result<void>> results(impacts.size());
  parallelFor(exec, impacts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto force = forcesOf(loader, nodes, impacts[i]);
      if (force.ok())
        forces[i] = std::move(force).value();
      else
        results[i] = force.error();
    }
  });
  if (exec.cancelled()) return cancelledError();
  for (const Result<void>& result : results) SHERD_CHECK(result);
  return forces;
}

}  // namespace

double totalEnergy(const EnergyField& field) { return sumOf(field.tetEnergy); }

Result<std::vector<Vec3>> impactForces(std::shared_ptr<const Elements> elements, const Impact& impact) {
  return forcesOf(PatchLoader(elements), elements->nodeCount(), impact);
}

Result<void> eachImpactEnergy(std::shared_ptr<const TetMesh> mesh, std::span<const Impact> impacts,
                              const Material& material, ElementOrder elements, const Exec& exec,
                              const ImpactEnergySink& sink) {
  SHERD_ASSIGN(const Statics statics, Statics::factor(mesh, {material.poissonRatio, elements}, exec));
  const PatchLoader loader(statics.elements());
  const std::vector<double> shareOfBody = sharesOfBody(*statics.elements());
  for (std::size_t begin = 0; begin < impacts.size(); begin += kImpactsAtOnce) {
    const auto some = impacts.subspan(begin, std::min(kImpactsAtOnce, impacts.size() - begin));
    SHERD_ASSIGN(const auto forces, forcesOfAll(loader, statics.elements()->nodeCount(), some, exec));
    SHERD_ASSIGN(const std::vector<StaticSolution> solutions,
                 statics.solveAll(forces, material.youngModulus, exec));
    std::vector<ImpactEnergy> energies;
    for (const StaticSolution& s : solutions) {
      energies.push_back({sumOf(s.tetEnergy), nodeEnergies(*mesh, s.tetEnergy, shareOfBody)});
      SHERD_CHECK(checkSolution(s, energies.back().total));
    }
    SHERD_CHECK(sink(begin, std::move(energies)));
    exec.progress(static_cast<double>(begin + some.size()) / static_cast<double>(impacts.size()));
  }
  return {};
}

Result<std::vector<ImpactEnergy>> impactEnergies(std::shared_ptr<const TetMesh> mesh,
                                                 std::span<const Impact> impacts, const Material& material,
                                                 ElementOrder elements, const Exec& exec) {
  std::vector<ImpactEnergy> all;
  SHERD_CHECK(eachImpactEnergy(std::move(mesh), impacts, material, elements, exec,
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
