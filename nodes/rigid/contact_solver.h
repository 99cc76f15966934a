// Impulses of simultaneous contacts, by Bullet's sequential-impulse solver.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "rigid/flight.h"
#include "rigid/time_of_impact.h"

namespace sherd {

struct ContactLaw {
  double restitution = 0;  ///< in [0, 1]
  double friction = 0;     ///< Coulomb's, ≥ 0
};

struct ContactImpulses {
  std::vector<Vec3> onBody;  ///< N·s per touch, world space
  double closingSpeed = 0;   ///< m/s, the fastest among the touches that close
  double normalImpulse = 0;  ///< N·s, sum of the normal parts over the touches that close
};

/// Solves all `touches` of `flight`'s body with the floor (which never moves) and `ball`, at the
/// flight's motion. Every contact obeys v_n' ≥ −e v_n and Coulomb's law (friction acts on the impact's
/// slip). More than one contact leaves the split among them undetermined where they outnumber the
/// degrees of freedom: a compliance of 1e-3 of the body's inverse mass then makes it unique, and each
/// contact's speed inexact by that order.
ContactImpulses solveContacts(const Flight& flight, const std::optional<Ball>& ball,
                              std::span<const Touch> touches, const ContactLaw& law);

}  // namespace sherd
