// The parts of bench_cvd that have files of their own.
#pragma once

#include <string>

#include "bench/parts.h"

namespace sherd::bench {

/// E_D beside time, for ways to label, to start and to end; with plots.
void choices(const Options& options, std::string& report);
/// The same for float in place of double, and how many labels differ.
void precision(const Options& options, std::string& report);

}  // namespace sherd::bench
