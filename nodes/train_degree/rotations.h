// Orientations spread evenly over all there are.
#pragma once

#include <cstdint>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// `count` rotations, uniform over SO(3) and more even than random ones: the points of a sequence of low
/// discrepancy (the additive recurrence of the cubic generalisation of the golden ratio), shifted by `seed`,
/// put through Shoemake's map ("Uniform random rotations", Graphics Gems III, 1992). Degrees about the
/// world's x, then y, then z axis, as RigidParams::orientation takes them. The first of more are these.
std::vector<Vec3> uniformOrientations(int count, std::int64_t seed);

}  // namespace sherd
