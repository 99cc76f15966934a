#include "train_degree/kept.h"

#include "types/value_bytes.h"

namespace sherd {

void saveValue(ArchiveWriter& to, const KeptEnergy& energy) {
  to.put(energy.total);
  to.array(energy.nodeEnergy);
}

std::optional<KeptEnergy> loadValue(ArchiveReader& from, std::type_identity<KeptEnergy>) {
  KeptEnergy energy;
  from.get(energy.total);
  from.array(energy.nodeEnergy);
  if (!from.ok()) return std::nullopt;
  return energy;
}

Digest impactKey(const Digest& tets, const RigidParams& p) {
  static_assert(sizeof(RigidParams) == 264, "every parameter belongs into the key");
  Hasher hasher;
  hasher.add(tets).add(static_cast<int>(p.scene));
  hashBits(hasher, p.body);
  for (const Vec3& v : {p.orientation, p.velocity, p.angularVelocity}) hashBits(hasher, v);
  for (const double v : {p.gravity, p.dropHeight}) hashBits(hasher, v);
  for (const double v : {p.ballRadius, p.ballDensity, p.ballSpeed}) hashBits(hasher, v);
  for (const Vec3& v : {p.ballDirection, p.ballTarget}) hashBits(hasher, v);
  hasher.add(p.standing);
  for (const double v : {p.restitution, p.friction, p.obstacleYoung, p.obstaclePoisson}) hashBits(hasher, v);
  for (const double v : {p.contactDuration, p.contactRadius, p.timeStep, p.maxTime}) hashBits(hasher, v);
  return hasher.digest();
}

Digest energyKey(const Digest& tets, const SimulateParams& params, const Digest& load) {
  Hasher hasher;
  hasher.add(tets).add(static_cast<int>(params.elements)).add(load);
  if (params.elements == ElementOrder::Quadratic) hasher.add(params.refine);
  hashBits(hasher, params.body.youngModulus);
  hashBits(hasher, params.body.poissonRatio);
  return hasher.digest();
}

Digest pathKey(const Digest& embedding, const std::vector<double>& weight, const std::vector<double>& volume,
               std::int64_t seed) {
  return Hasher().add(embedding).add(weight).add(volume).add(seed).digest();
}

}  // namespace sherd
