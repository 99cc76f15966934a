// What of a training is kept from run to run (base/memo.h): impacts, energies under unit loads, growth paths.
// Neither γ nor the list of heights is part of any key.
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "simulate/simulate.h"

namespace sherd {

/// ImpactEnergy as it is kept.
struct KeptEnergy : ImpactEnergy {
  static constexpr const char* typeName = "ImpactEnergy";
  static constexpr int archiveVersion = 1;
};
void saveValue(ArchiveWriter& to, const KeptEnergy& energy);
std::optional<KeptEnergy> loadValue(ArchiveReader& from, std::type_identity<KeptEnergy>);

/// Of what dropUntilImpact finds. `tets`: the body's digest.
Digest impactKey(const Digest& tets, const RigidParams& params);
/// Of the energy under a unit load; `params`: the body's material, and how its energy is found.
Digest energyKey(const Digest& tets, const SimulateParams& params, const Digest& load);
/// Of the growth path for these weights, J, and volumes, m³, per node.
Digest pathKey(const Digest& embedding, const std::vector<double>& weight, const std::vector<double>& volume,
               std::int64_t seed);

}  // namespace sherd
