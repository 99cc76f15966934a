// Strain energies in cages that enclose a body against those in a fine mesh that ends at its surface.
#pragma once

#include <string>

#include "bench/parts.h"

namespace sherd::bench {

/// Horse and bunny in cages of 1,250 to 20,000 tetrahedra, linear and quadratic, at the default contact patch
/// and one twice as wide: time, energies, and how they are spread. Writes cages.csv and cages.svg.
void cages(const Options& options, std::string& report);

}  // namespace sherd::bench
