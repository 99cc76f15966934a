// Elastic constants that travel from Simulate with the energy, so that masses need not be told twice.
#pragma once

namespace sherd {

/// Isotropic, linear elastic. Defaults: stoneware.
struct Material {
  double density = 2400;       ///< kg/m³
  double youngModulus = 5e10;  ///< Pa
  double poissonRatio = 0.2;   ///< in (−1, 0.5)
};

}  // namespace sherd
