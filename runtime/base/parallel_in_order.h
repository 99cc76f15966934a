// Parallel making, beside which one thread takes what is made, in order.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "base/parallel.h"

namespace sherd {

namespace detail {
/// Differs between threads that run.
inline const void* thisThread() {
  static thread_local char mark;
  return &mark;
}
}  // namespace detail

/// Calls make(block) for all blocks in [0, blocks), in parallel and begun in about that order, and
/// take(block) for each of them, one after the other in exactly that order: what would be one thread's work
/// afterwards runs beside the making. Only the calling thread takes, so that what it takes to stays in its
/// cache, when it has made a block itself and at the end. Neither may call parallel functions. Cancelling and
/// exceptions: as of parallelFor().
template <class Make, class Take>
void parallelInOrder(const Exec& exec, std::size_t blocks, Make&& make, Take&& take) {
  std::atomic<std::size_t> begun{0};
  std::size_t taken = 0;
  const auto made = std::make_unique<std::atomic<bool>[]>(blocks);
  const auto takeMade = [&] {
    for (; taken < blocks && made[taken]; ++taken) take(taken);
  };
  const void* const caller = detail::thisThread();
  parallelFor(exec, blocks, 1, [&](std::size_t, std::size_t) {
    const std::size_t block = begun++;  // the order of these calls is another
    make(block);
    made[block] = true;
    if (detail::thisThread() == caller) takeMade();
  });
  takeMade();
}

}  // namespace sherd
