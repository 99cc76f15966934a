#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#ifndef SHERD_PARALLEL_STD
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace sherd {
namespace {

std::atomic<int> gThreadLimit{0};

}  // namespace

void setThreadLimit(int threads) { gThreadLimit = std::max(0, threads); }

int threadLimit() {
  static const int kMachine =
      std::max(1, static_cast<int>(std::thread::hardware_concurrency()));  // reads a file
  const int limit = gThreadLimit;
  return limit > 0 ? limit : kMachine;
}

#ifndef SHERD_PARALLEL_STD

void detail::forBlocks(std::size_t n, std::size_t grain, const CancelToken* cancel, BlockRef body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t blocks = (n + grain - 1) / grain;
  auto runBlock = [&](std::size_t block) {
    if (cancel != nullptr && cancel->cancelled()) return;
    body.call(body.object, block * grain, std::min(n, (block + 1) * grain));
  };
  if (blocks <= 1 || threadLimit() == 1) {
    for (std::size_t block = 0; block < blocks; ++block) runBlock(block);
    return;
  }
  // A thread that waits here may pick up other tasks of the arena (isolated work would leave it idle), so
  // bodies hold no locks.
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 1), [&](const auto& range) {
    for (std::size_t block = range.begin(); block != range.end(); ++block) runBlock(block);
  });
}

struct TaskGroup::Impl {
  tbb::task_group group;
};

TaskGroup::TaskGroup() : impl_(std::make_unique<Impl>()) {}
TaskGroup::~TaskGroup() {
  try {
    impl_->group.wait();
  } catch (...) {  // NOLINT: wait() is where exceptions are reported; a destructor only waits
  }
}
void TaskGroup::run(std::function<void()> task) { impl_->group.run(std::move(task)); }
void TaskGroup::wait() { impl_->group.wait(); }

void inArena(const std::function<void()>& f) {
  tbb::task_arena arena(threadLimit());
  arena.execute(f);
}

#else

namespace {

/// First exception wins; the others are dropped, as TBB does.
class FirstException {
 public:
  void capture() {
    const std::lock_guard lock(mutex_);
    if (!first_) first_ = std::current_exception();
  }
  void rethrow() {
    if (auto e = std::exchange(first_, nullptr)) std::rethrow_exception(e);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr first_;
};

}  // namespace

void detail::forBlocks(std::size_t n, std::size_t grain, const CancelToken* cancel, BlockRef body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t blocks = (n + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  FirstException error;
  auto work = [&] {
    try {
      for (std::size_t block; !failed && (block = next++) < blocks;) {
        if (cancel != nullptr && cancel->cancelled()) return;
        body.call(body.object, block * grain, std::min(n, (block + 1) * grain));
      }
    } catch (...) {
      failed = true;
      error.capture();
    }
  };
  std::vector<std::thread> helpers;
  const std::size_t wanted = std::min<std::size_t>(blocks, static_cast<std::size_t>(threadLimit()));
  for (std::size_t i = 1; i < wanted; ++i) helpers.emplace_back(work);
  work();
  for (auto& helper : helpers) helper.join();
  error.rethrow();
}

struct TaskGroup::Impl {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::function<void()> > queue;
  std::size_t unfinished = 0;
  FirstException error;

  /// Runs queued tasks until all are finished.
  void work() {
    std::unique_lock lock(mutex);
    while (unfinished > 0) {
      if (queue.empty()) {
        changed.wait(lock);
        continue;
      }
      auto task = std::move(queue.front());
      queue.pop_front();
      lock.unlock();
      try {
        task();
      } catch (...) {
        error.capture();
      }
      lock.lock();
      if (--unfinished == 0) changed.notify_all();
    }
  }
};

TaskGroup::TaskGroup() : impl_(std::make_unique<Impl>()) {}
TaskGroup::~TaskGroup() {
  try {
    wait();
  } catch (...) {  // NOLINT: wait() is where exceptions are reported; a destructor only waits
  }
}
void TaskGroup::run(std::function<void()> task) {
  const std::lock_guard lock(impl_->mutex);
  impl_->queue.push_back(std::move(task));
  ++impl_->unfinished;
  impl_->changed.notify_all();
}
void TaskGroup::wait() {
  std::vector<std::thread> helpers;
  for (int i = 1; i < threadLimit(); ++i) helpers.emplace_back([this] { impl_->work(); });
  impl_->work();
  for (auto& helper : helpers) helper.join();
  impl_->error.rethrow();
}

void inArena(const std::function<void()>& f) { f(); }

#endif

}  // namespace sherd
