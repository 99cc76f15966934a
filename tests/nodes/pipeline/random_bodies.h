// Bodies of many kinds and sizes, made by number: closed surfaces without self-intersections, outward facing.
#pragma once

#include <memory>
#include <string>

#include "base/rng.h"
#include "types/tri_mesh.h"

namespace sherd::test {

struct RandomBody {
  std::string kind;  ///< "torus"
  std::shared_ptr<const TriMesh> surface;
  double size = 1;       ///< m, of the bounding box's diagonal
  double distance = 0;   ///< sizes from the origin
  double thickness = 1;  ///< m, about, where it is thinnest
};

double uniformIn(Rng& rng, double low, double high);
/// The logarithm is uniform.
double logUniformIn(Rng& rng, double low, double high);
Vec3 anyDirection(Rng& rng);

/// A box, bar, bumpy sphere, torus, L, U, tray, several parts, thin and bent wall, shell around a void,
/// single tetrahedron or sliver; turned, from a millimetre to a kilometre large, and up to a million sizes
/// away.
RandomBody randomBody(Rng& rng);

/// The same body 2^exponent times as large, and as far away: every number is the same but for its exponent.
RandomBody scaledByTwo(const RandomBody& body, int exponent);

}  // namespace sherd::test
