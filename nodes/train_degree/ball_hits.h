// Where balls hit a body, and from where they come.
#pragma once

#include <cstdint>
#include <vector>

#include "types/tri_mesh.h"
#include "types/vec.h"

namespace sherd {

struct BallHit {
  Vec3 target = Vec3::Constant(0.5);  ///< as RigidParams::ballTarget
  Vec3 direction = Vec3(1, 0, 0);     ///< as RigidParams::ballDirection
};

/// `count` of them, spread evenly over the surface by area, each from a direction within the half space
/// before its place (by the cosine of the angle: few graze); with `fromAbove` none comes from below. A
/// sequence of low discrepancy (the additive recurrence in five dimensions), shifted by `seed`. The first of
/// more are these. A ball may meet another part of the body on its way; it always meets one. O(triangles +
/// count log triangles).
std::vector<BallHit> spreadBallHits(const TriMesh& surface, int count, bool fromAbove, std::int64_t seed);

}  // namespace sherd
