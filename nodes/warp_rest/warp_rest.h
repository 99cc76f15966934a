// A rest shape from which distances are taken: how an artist gives cracks a direction, waves and roughness.
// Schvartzman and Otaduy (2014), section 2.4, Figures 5 and 6.
//
// Cells have about the same extent in all directions of the space in which distances are taken, and flat
// sheets between them. In the body as it is they then have the pulled-back shape. A node at x goes to y in
// three steps:
//
//   waves      x' = x + a u sin(2π k·x / λ)          a: amplitude, λ: length, k: travel, u: shift (units)
//   roughness  x'' = x' + r (2 n(x / s) − 1)         n: three value noises in [0, 1), s: size
//   elongation y = e^(1/3) (x'' − (1 − 1/e) (x''·A) A),  A: the unit axis
//
// A sheet across u is a wave of amplitude a in the body; r is the most by which a sheet is displaced along an
// axis. The last step shortens lengths along A by e^(−2/3) and stretches those across by e^(1/3): pieces
// become e times as long along A as across. Volumes stay, so that the threshold γ keeps its meaning: at three
// γ a sphere of even energy breaks into 8, 43, 220 pieces as it is, 8, 44, 180 with e = 4 and 8, 41, 173 with
// e = ¼.
//
// Deviation from the paper: it says only "non-uniform scaling" and "a wavy transformation".
#pragma once

#include <cstdint>
#include <memory>

#include "base/exec.h"
#include "base/result.h"
#include "types/rest_shape.h"

namespace sherd {

struct WarpRestParams {
  double elongation = 1;      ///< in [0.01, 100]: pieces' length along `axis` over that across; 1: as is
  Vec3 axis = Vec3(0, 1, 0);  ///< of any length > 0
  double waveAmplitude = 0;   ///< m, ≥ 0; 0: no waves
  double waveLength = 0;      ///< m, ≥ 0; 0: a quarter of the diagonal of the body
  Vec3 waveTravel{1, 0, 0};   ///< the direction in which crests follow each other
  Vec3 waveShift{0, 1, 0};    ///< the direction in which sheets are displaced
  double roughness = 0;       ///< m, ≥ 0; 0: smooth
  double roughnessSize = 0;   ///< m, ≥ 0; 0: a sixteenth of the diagonal of the body
  std::int64_t seed = 1;      ///< of the roughness
};

/// `from`: the rest shape to go on from (to chain warps), or null for the body as it is. Parameters that warp
/// nothing give the positions of before, to the last bit. Warns of waves or roughness finer than four mean
/// edges of the tetrahedra, in which positions are linear. Tetrahedra may come out inside out; Embed says
/// what that means there. Errors: an empty mesh; a rest shape of another body; parameters out of range; a
/// direction without length. Cost O(nodes).
Result<RestShape> warpRest(const std::shared_ptr<const TetMesh>& tets, const RestShape* from,
                           const WarpRestParams& params, const Exec& exec);

}  // namespace sherd
