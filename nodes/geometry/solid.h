// Volume, centre and inertia of solids given by closed triangle surfaces (divergence theorem; Mirtich 1996).
#pragma once

#include <span>
#include <vector>

#include "types/solid_sums.h"
#include "types/vec.h"

namespace sherd {

/// Integrals over the solid that a closed, outward-oriented surface encloses. Surfaces of several shells
/// count with their signs, so a void subtracts.
struct SolidIntegrals {
  double volume = 0;                 ///< m³; negative where the surface is inside out
  Vec3 centroid = Vec3::Zero();      ///< m; the vertices' mean where the volume is 0
  Mat3 secondMoment = Mat3::Zero();  ///< m⁵: ∫ (x − c)(x − c)ᵀ dx about the centroid

  /// Inertia tensor about the centroid for a homogeneous density (kg/m³), kg·m².
  Mat3 inertia(double density) const {
    return density * (secondMoment.trace() * Mat3::Identity() - secondMoment);
  }
};

/// Sums about the first vertex used, so that a body far from the origin keeps its digits. Cost O(triangles).
SolidIntegrals integrateSolid(std::span<const Vec3> positions, std::span<const Triangle> triangles);
/// The same over several triangle lists that together close (a piece's skin and its crack).
SolidIntegrals integrateSolid(std::span<const Vec3> positions,
                              std::span<const std::span<const Triangle>> lists);

/// From sums about `origin`; the centroid is the origin where the volume is 0.
SolidIntegrals integralsOf(const SolidSums& sums, const Vec3& origin);

/// Signed volume alone, m³.
double solidVolume(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace sherd
