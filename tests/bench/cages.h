// Strain energies in cages that enclose a body against those in a fine mesh that ends at its surface.
#pragma once

#include <string>

#include "bench/parts.h"

namespace sherd::bench {

/// Horse and bunny in cages of 1,250 to 20,000 tetrahedra, linear, quadratic and quadratic with refinement,
/// at the default contact patch and one twice as wide: time, energies, and how they are spread; and how far
/// is refined. Writes cages.csv, refinements.csv and cages.svg.
void cages(const Options& options, std::string& report);

}  // namespace sherd::bench
