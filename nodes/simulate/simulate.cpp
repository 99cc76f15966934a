#include "simulate/simulate.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "simulate/patch_load.h"
#include "simulate/statics.h"

namespace sherd {
namespace {

template <class... Numbers>
std::string formatted(const char* format, Numbers... numbers) {
  char line[300];
  std::snprintf(line, sizeof line, format, numbers...);
  return line;
}

EnergyField withoutEnergy(std::shared_ptr<const TetMesh> mesh, const Material& material) {
  EnergyField field;
  field.tetEnergy.assign(mesh->tets.size(), 0.0);
  field.nodeEnergy.assign(mesh->nodes.size(), 0.0);
  field.displacement.assign(mesh->nodes.size(), Vec3::Zero());
  field.material = material;
  field.tets = std::move(mesh);
  return field;
}

Result<void> deform(EnergyField& field, const Impact& impact, const Exec& exec) {
  SHERD_ASSIGN(const std::vector<Vec3> force, impactForces(field.tets, impact));
  SHERD_ASSIGN(const Statics statics, Statics::factor(field.tets, field.material.poissonRatio, exec));
  if (exec.cancelled()) return cancelledError();
  StaticSolution solution = statics.solve(force, field.material.youngModulus);
  for (std::size_t t = 0; t < solution.tetEnergy.size(); ++t)
    for (const Index n : field.tets->tets[t]) field.nodeEnergy[at(n)] += solution.tetEnergy[t] / 4;
  field.tetEnergy = std::move(solution.tetEnergy);
  field.displacement = std::move(solution.displacement);
  if (!std::isfinite(totalEnergy(field)))
    return failure("the strain energy is not a finite number",
                   "check young, the body's tetrahedra and the impact's speed");
  return {};
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
  SHERD_CHECK(deform(out.energy, out.impact, exec));
  exec.info(hit + formatted(": strain energy %.4g J", totalEnergy(out.energy)));
  return out;
}

}  // namespace

double totalEnergy(const EnergyField& field) {
  double sum = 0;
  for (const double e : field.tetEnergy) sum += e;
  return sum;
}

Result<std::vector<Vec3>> impactForces(std::shared_ptr<const TetMesh> mesh, const Impact& impact) {
  std::vector<Vec3> force(mesh->nodes.size(), Vec3::Zero());
  const PatchLoader loader(std::move(mesh));
  for (const Contact& contact : impact.contacts)
    SHERD_CHECK(
        loader.add(contact.point, kHertzPeak / contact.duration * contact.impulse, contact.radius, force));
  return force;
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
