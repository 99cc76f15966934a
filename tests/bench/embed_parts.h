// The parts of bench_embed that have a file of their own.
#pragma once

#include <string>

#include "bench/parts.h"

namespace sherd::bench {

/// How far distances with some modes are from those with all of them, with time beside it.
void spectrum(const Options& options, std::string& report);
/// What each step of an embedding takes.
void steps(const Options& options, std::string& report);

}  // namespace sherd::bench
