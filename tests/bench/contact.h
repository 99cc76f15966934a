// Strain energy of one impact over the time step, the mesh, the elements, and the patch and its quadrature.
#pragma once

#include <string>

#include "bench/parts.h"

namespace sherd::bench {

void contact(const Options& options, std::string& report);

}  // namespace sherd::bench
