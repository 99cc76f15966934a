// Is a body convex, as far as distances care?
#pragma once

#include <span>

#include "base/result.h"
#include "types/vec.h"

namespace sherd {

/// Volume of the convex hull, m³ (CGAL, exact predicates); 0 for points in one plane. Cost O(n log n).
Result<double> convexHullVolume(std::span<const Vec3> points);

}  // namespace sherd
