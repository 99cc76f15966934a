// An impact apart from its strength.
//
// Statics are linear: forces s times as large give energies s² times as large. Drops from several heights
// with one orientation touch the floor with the same points, by the same directions and shares of the force,
// and differ in the strength alone, unless Hertz's patch grows with the height. So one solution serves all.
#pragma once

#include "base/hash.h"
#include "types/fields.h"

namespace sherd {

struct UnitLoad {
  /// Contacts alone: the largest peak force of simulate/simulate.h is 1 N. Points and forces are rounded to
  /// kGrain of the body's size, or of 1 N, so that those of several heights, which differ by rounding, are
  /// equal; contacts without force are left out.
  Impact impact;
  double strength = 0;  ///< N: the largest peak force
};

/// 4e-9: far above the rounding of the flight, and far below what a patch is integrated to.
inline constexpr int kGrainBits = 28;
inline constexpr double kGrain = 1.0 / (1 << kGrainBits);

/// `size`: of the body, m, > 0.
UnitLoad unitLoadOf(const Impact& impact, double size);

/// Of the contacts.
Digest digestOfLoad(const Impact& unit);

}  // namespace sherd
