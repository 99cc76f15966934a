#include "weights/weights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/paint_place.h"

namespace sherd {
namespace {

std::string placeOf(const TetMesh& tets, std::size_t n) {
  const Vec3& p = tets.nodes[n];
  return fmt::format("at node {} ({:.6g}, {:.6g}, {:.6g}) m", n, p.x(), p.y(), p.z());
}

bool isAmount(double v) { return std::isfinite(v) && v >= 0; }

Result<void> checkEnergy(const EnergyField& energy) {
  if (!energy.tets) return failure("the energy comes without a tetrahedral mesh", {}, "energy");
  const std::size_t nodes = energy.tets->nodes.size();
  if (energy.nodeEnergy.size() != nodes)
    return failure(fmt::format("the energy has {} values for {} nodes", energy.nodeEnergy.size(), nodes),
                   "energy and tetrahedra have to come from the same Simulate", "energy");
  for (std::size_t n = 0; n < nodes; ++n)
    if (!isAmount(energy.nodeEnergy[n]))
      return failure(fmt::format("the energy is {} J {}", energy.nodeEnergy[n], placeOf(*energy.tets, n)),
                     "energies are finite and not negative", "energy");
  return {};
}

/// V_n ρ_n^α up to a common factor, and the factor that makes these sum to Σ e. Energies and volumes are
/// divided by their largest first, and densities by theirs, so that no power overflows whatever the units.
Result<std::vector<double>> unitWeights(const EnergyField& energy, const std::vector<double>& volume,
                                        double alpha) {
  const std::vector<double>& e = energy.nodeEnergy;
  std::vector<double> out(e.size(), 0.0);
  const double maxEnergy = *std::max_element(e.begin(), e.end());
  const double maxVolume = *std::max_element(volume.begin(), volume.end());
  if (maxEnergy == 0 || !(maxVolume > 0)) return out;

  double maxDensity = 0, sumEnergy = 0;
  for (std::size_t n = 0; n < e.size(); ++n) {
    if (!(volume[n] > 0)) continue;
    out[n] = (e[n] / maxEnergy) / (volume[n] / maxVolume);
    if (!std::isfinite(out[n]))
      return failure(fmt::format("the energy's density is beyond all measure {}", placeOf(*energy.tets, n)),
                     "a node with (nearly) no volume can't hold energy", "energy");
    maxDensity = std::max(maxDensity, out[n]);
    sumEnergy += e[n];
  }
  if (maxDensity == 0) return out;

  double sum = 0;
  for (std::size_t n = 0; n < e.size(); ++n) {
    if (!(volume[n] > 0)) continue;
    out[n] = volume[n] / maxVolume * std::pow(out[n] / maxDensity, alpha);  // pow(0, 0) = 1
    sum += out[n];
  }
  for (double& w : out) w *= sumEnergy / sum;
  return out;
}

/// Of β at the nodes that can weigh; zero where that is 1 everywhere.
Digest digestOfBeta(const ScalarGrid& beta, const std::vector<double>& samples,
                    const std::vector<double>& volume) {
  std::vector<double> used(volume.size(), 1.0);
  bool isOne = true;
  for (std::size_t n = 0; n < volume.size(); ++n) {
    if (volume[n] > 0) used[n] = samples[beta.isConstant() ? 0 : n];
    isOne = isOne && used[n] == 1;
  }
  return isOne ? Digest{} : Hasher().add(used).digest();
}

/// Paint that leaves the whole body at the background does nothing.
void warnOfMiss(const ScalarGrid& beta, const std::vector<double>& samples, const WeightField& field,
                const Exec& exec) {
  if (beta.isConstant()) return;
  for (std::size_t n = 0; n < samples.size(); ++n)
    if (field.volume[n] > 0 && samples[n] != beta.background()) return;
  exec.warn(fmt::format("the painted β misses the body, which has {:.4g} everywhere: {}", beta.background(),
                        placeOfPaint(beta, *field.tets)));
}

Result<void> applyBeta(const ScalarGrid& beta, WeightField& field, const Exec& exec) {
  const std::vector<Vec3>& nodes = field.tets->nodes;
  std::vector<double> samples(beta.isConstant() ? 1 : nodes.size());
  beta.sample(std::span<const Vec3>(nodes).first(samples.size()), samples);
  warnOfMiss(beta, samples, field, exec);
  field.beta = digestOfBeta(beta, samples, field.volume);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double value = samples[beta.isConstant() ? 0 : n];
    if (!(field.volume[n] > 0)) continue;
    if (!isAmount(value))
      return failure(fmt::format("β is {} {}", value, placeOf(*field.tets, n)),
                     "paint β with finite values that are not negative (1: as it is, more: more fragile)",
                     "beta");
    field.weight[n] *= value;
    if (!std::isfinite(field.weight[n]))
      return failure(fmt::format("β = {} makes the weight overflow {}", value, placeOf(*field.tets, n)),
                     "paint β with smaller values", "beta");
  }
  return {};
}

}  // namespace

Result<WeightField> weights(const EnergyField& energy, const ScalarGrid* beta, const WeightsParams& params,
                            const Exec& exec) {
  if (!(params.alpha >= 0 && params.alpha <= 4))
    return failure(fmt::format("α is {}", params.alpha), "it has to be between 0 and 4", "alpha");
  SHERD_CHECK(checkEnergy(energy));
  WeightField field{energy.tets, energy.material, {}, lumpedVolumes(*energy.tets), params.alpha};
  if (field.volume.empty()) return failure("the tetrahedral mesh is empty", {}, "energy");
  SHERD_ASSIGN(field.weight, unitWeights(energy, field.volume, params.alpha));
  if (exec.cancelled()) return cancelledError();
  if (beta != nullptr) SHERD_CHECK(applyBeta(*beta, field, exec));
  return field;
}

}  // namespace sherd
