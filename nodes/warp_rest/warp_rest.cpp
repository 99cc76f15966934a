#include "warp_rest/warp_rest.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "geometry/tet_edges.h"
#include "geometry/value_noise.h"

namespace sherd {
namespace {

constexpr double kEdgesPerFeature = 4;
constexpr std::size_t kBlock = 2048;  ///< nodes a task

Result<void> checkLength(double value, const char* what, const char* port) {
  if (value >= 0 && std::isfinite(value)) return {};
  return failure(fmt::format("the {} is {} m", what, value), "it has to be 0 m or more", port);
}

Result<void> checkDirection(const Vec3& direction, const char* port) {
  const double length = direction.norm();
  if (length > 0 && std::isfinite(length)) return {};
  return failure("the direction has no length", "such as 0 1 0 for upwards", port);
}

Result<void> check(const TetMesh* tets, const RestShape* from, const WarpRestParams& p) {
  if (tets == nullptr || tets->tets.empty()) return failure("the tetrahedral mesh is empty", {}, "tets");
  if (from != nullptr && !isOf(*from, *tets))
    return failure("the rest shape is that of another body", "wire it to a WarpRest of the same tets",
                   "rest");
  if (!(p.elongation >= 0.01 && p.elongation <= 100))
    return failure(fmt::format("the elongation is {}", p.elongation), "it has to be between 0.01 and 100",
                   "elongation");
  SHERD_CHECK(checkLength(p.waveAmplitude, "amplitude of the waves", "wave_amplitude"));
  SHERD_CHECK(checkLength(p.waveLength, "length of the waves", "wave_length"));
  SHERD_CHECK(checkLength(p.roughness, "roughness", "roughness"));
  SHERD_CHECK(checkLength(p.roughnessSize, "size of the roughness", "roughness_size"));
  if (p.elongation != 1) SHERD_CHECK(checkDirection(p.axis, "axis"));
  if (p.waveAmplitude > 0) {
    SHERD_CHECK(checkDirection(p.waveTravel, "wave_travel"));
    SHERD_CHECK(checkDirection(p.waveShift, "wave_shift"));
  }
  return {};
}

/// With the lengths that 0 stands for, and directions of length 1.
WarpRestParams completed(WarpRestParams p, double diagonal) {
  if (p.waveLength == 0) p.waveLength = diagonal / 4;
  if (p.roughnessSize == 0) p.roughnessSize = diagonal / 16;
  for (Vec3* direction : {&p.axis, &p.waveTravel, &p.waveShift})
    if (direction->norm() > 0) direction->normalize();
  return p;
}

double meanEdge(const TetMesh& tets) {
  const std::vector<Edge> edges = tetEdges(tets.tets);
  double sum = 0;
  for (const auto& [a, b] : edges) sum += (tets.nodes[at(a)] - tets.nodes[at(b)]).norm();
  return sum / static_cast<double>(edges.size());
}

void warnOfFineFeatures(const TetMesh& tets, const WarpRestParams& p, const Exec& exec) {
  if (p.waveAmplitude == 0 && p.roughness == 0) return;
  const double edge = meanEdge(tets);
  const auto warn = [&](const char* what, double length) {
    if (length < kEdgesPerFeature * edge)
      exec.warn(fmt::format(
          "{} of {:.4g} m {} finer than the tetrahedra can follow, whose edges are {:.4g} m long on "
          "average: ask Tetrahedralize for more of them, or for {:.4g} m here",
          what, length, what[0] == 'w' ? "are" : "is", edge, kEdgesPerFeature * edge));
  };
  if (p.waveAmplitude > 0) warn("waves", p.waveLength);
  if (p.roughness > 0) warn("roughness", p.roughnessSize);
}

class Warp {
 public:
  /// Completed parameters; `centre` stays where it is when pieces are elongated.
  Warp(const WarpRestParams& p, const Vec3& centre)
      : p_(p), centre_(centre), noise_{noise(0), noise(1), noise(2)} {}

  Vec3 operator()(Vec3 x) const {
    if (p_.waveAmplitude > 0) {
      const double turns = p_.waveTravel.dot(x) / p_.waveLength;
      x += p_.waveAmplitude * std::sin(2 * std::numbers::pi * turns) * p_.waveShift;
    }
    if (p_.roughness > 0) {
      const Vec3 values(noise_[0].at(x), noise_[1].at(x), noise_[2].at(x));
      x += p_.roughness * (2 * values.array() - 1).matrix();
    }
    if (p_.elongation != 1) {
      const Vec3 d = x - centre_;
      x = centre_ + std::cbrt(p_.elongation) * (d - (1 - 1 / p_.elongation) * d.dot(p_.axis) * p_.axis);
    }
    return x;
  }

 private:
  ValueNoise noise(std::uint64_t axis) const {
    return {static_cast<std::uint64_t>(p_.seed), p_.roughnessSize, axis};
  }

  WarpRestParams p_;
  Vec3 centre_;
  ValueNoise noise_[3];
};

}  // namespace

Result<RestShape> warpRest(const std::shared_ptr<const TetMesh>& tets, const RestShape* from,
                           const WarpRestParams& params, const Exec& exec) {
  SHERD_CHECK(check(tets.get(), from, params));
  const Box box = boxOf(tets->nodes);
  const WarpRestParams complete = completed(params, box.diagonal());
  warnOfFineFeatures(*tets, complete, exec);
  RestShape rest{tets, from != nullptr ? from->positions : tets->nodes};
  const Warp warp(complete, box.centre());
  parallelFor(exec, rest.positions.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) rest.positions[n] = warp(rest.positions[n]);
  });
  if (exec.cancelled()) return cancelledError();
  for (const Vec3& p : rest.positions)
    if (!p.allFinite())
      return failure("the warped body is beyond all measure", "take smaller lengths", "tets");
  return rest;
}

}  // namespace sherd
