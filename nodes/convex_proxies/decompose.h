// One solid as a handful of convex hulls.
#pragma once

#include <span>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "convex_proxies/convex_proxies.h"

namespace sherd {

/// Hulls that together hold the solid within the closed surface, as convex_proxies.h says. `volume`: the
/// solid's, m³. When cancelled, what is returned has no meaning.
Result<std::vector<ConvexHull>> decompose(std::span<const Vec3> positions,
                                          std::span<const Triangle> triangles, double volume,
                                          const ConvexProxiesParams& params, const Exec& exec);

}  // namespace sherd
