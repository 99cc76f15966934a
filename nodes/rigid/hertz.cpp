#include "rigid/hertz.h"

#include <cmath>

namespace sherd {

double contactModulus(const Material& a, double youngB, double poissonB) {
  return 1 / ((1 - a.poissonRatio * a.poissonRatio) / a.youngModulus + (1 - poissonB * poissonB) / youngB);
}

HertzImpact hertzImpact(double mass, double speed, double radius, double modulus) {
  HertzImpact impact;
  impact.indentation = std::pow(15 * mass * speed * speed / (16 * std::sqrt(radius) * modulus), 0.4);
  impact.radius = std::sqrt(radius * impact.indentation);
  impact.duration = 2.94 * impact.indentation / speed;
  return impact;
}

}  // namespace sherd
