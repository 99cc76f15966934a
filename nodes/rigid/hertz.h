// Hertz's elastic impact of two spheres (Johnson, "Contact Mechanics", 1985, sections 4.2 and 11.4.1).
#pragma once

#include "types/material.h"

namespace sherd {

struct HertzImpact {
  double indentation = 0;  ///< m: δ, the deepest approach
  double radius = 0;       ///< m: a, of the contact patch at δ
  double duration = 0;     ///< s: T, of the contact
};

/// E*, Pa: 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂.
double contactModulus(const Material& a, double youngB, double poissonB);

/// mass m* (kg), speed v (m/s) of approach, radius R (m): 1/R = 1/R₁ + 1/R₂, modulus E* (Pa); all > 0.
HertzImpact hertzImpact(double mass, double speed, double radius, double modulus);

}  // namespace sherd
