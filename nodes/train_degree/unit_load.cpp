#include "train_degree/unit_load.h"

#include <algorithm>
#include <cmath>

#include "rigid/rigid.h"
#include "types/value_bytes.h"

namespace sherd {
namespace {

/// To a multiple of a power of two; −0 becomes 0.
double rounded(double value, double grain) { return std::round(value / grain) * grain + 0.0; }

Vec3 rounded(const Vec3& v, double grain) {
  return {rounded(v.x(), grain), rounded(v.y(), grain), rounded(v.z(), grain)};
}

}  // namespace

UnitLoad unitLoadOf(const Impact& impact, double size) {
  UnitLoad unit;
  unit.impact.hit = impact.hit;
  for (const Contact& c : impact.contacts)
    unit.strength = std::max(unit.strength, kHertzPeak / c.duration * c.impulse.norm());
  if (!(unit.strength > 0)) return unit;
  const double length = std::ldexp(kGrain, std::ilogb(size));
  for (const Contact& c : impact.contacts) {
    const Vec3 share = rounded(Vec3(kHertzPeak / c.duration / unit.strength * c.impulse), kGrain);
    if (share.isZero(0)) continue;
    unit.impact.contacts.push_back({rounded(c.point, length), share, kHertzPeak, c.radius});
  }
  return unit;
}

Digest digestOfLoad(const Impact& unit) { return Hasher().add(unit.hit).add(unit.contacts).digest(); }

}  // namespace sherd
