// The one façade for threads. Backed by oneTBB, or by std::thread when built with SHERD_PARALLEL=std (thread
// sanitizer builds); the choice is made in parallel.cpp, the only file that includes TBB.
//
// Determinism: work is cut into blocks whose borders depend on (n, grain) alone, never on the number of
// threads; sums add the blocks' results in the order of the blocks. A body must write only to what its
// indices own.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "base/exec.h"

namespace sherd {

/// Threads that parallel work may use, the calling one included. 0 means all of the machine's. Set before the
/// first parallel call; later calls take effect for work begun after them.
void setThreadLimit(int threads);
int threadLimit();

namespace detail {
/// A non-owning reference to a callable (begin, end).
struct BlockRef {
  void* object;
  void (*call)(void*, std::size_t, std::size_t);
};
void forBlocks(std::size_t n, std::size_t grain, const CancelToken* cancel, BlockRef body);
template <class F>
BlockRef blockRef(F& body) {
  return {const_cast<void*>(static_cast<const void*>(&body)),
          [](void* f, std::size_t begin, std::size_t end) { (*static_cast<F*>(f))(begin, end); }};
}
}  // namespace detail

/// Calls body(begin, end) for consecutive blocks of `grain` indices (the last may be shorter) covering [0,
/// n). When exec is cancelled the remaining blocks are left out: check exec.cancelled() afterwards. An
/// exception thrown by a body is rethrown here after the running blocks end.
template <class F>
void parallelFor(const Exec& exec, std::size_t n, std::size_t grain, F&& body) {
  detail::forBlocks(n, grain, exec.cancel, detail::blockRef(body));
}

/// Sum of body(begin, end) over the blocks, added in block order starting from `zero`.
template <class T, class F>
T parallelSum(const Exec& exec, std::size_t n, std::size_t grain, T zero, F&& body) {
  if (grain == 0) grain = 1;
  std::vector<T> parts((n + grain - 1) / grain, zero);
  auto block = [&](std::size_t begin, std::size_t end) { parts[begin / grain] = body(begin, end); };
  detail::forBlocks(n, grain, exec.cancel, detail::blockRef(block));
  for (const T& part : parts) zero += part;
  return zero;
}

/// Tasks that may start more tasks of the same group. wait() takes part in the work and rethrows the first
/// exception; destroying a group waits for its tasks.
class TaskGroup {
 public:
  TaskGroup();
  ~TaskGroup();
  TaskGroup(const TaskGroup&) = delete;
  TaskGroup& operator=(const TaskGroup&) = delete;
  void run(std::function<void()> task);
  void wait();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Runs f with parallel work inside it bound to the thread limit.
void inArena(const std::function<void()>& f);

}  // namespace sherd
