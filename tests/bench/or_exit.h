// For programs that cannot go on without a result.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "base/result.h"

namespace sherd::bench {

/// The value, or the error's text and the end of the program.
template <class T>
T orExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  fmt::print(stderr, "{}\n", result.error().text());
  std::exit(1);
}

}  // namespace sherd::bench
