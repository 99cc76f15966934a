// Progress over parts of a whole whose costs become known one after the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "base/exec.h"
#include "base/parallel.h"
#include "base/result.h"

namespace sherd {

class Phases {
 public:
  explicit Phases(const Exec& exec) : exec_(exec) {}

  /// What the next part is run with: cancelled with the whole, silent, and its progress is part of the
  /// whole's. It costs `cost`, and what comes after it about `rest`, in any unit.
  Exec next(double cost, double rest) {
    const double begin = done_;
    if (cost > 0) done_ += (1 - done_) * cost / (cost + rest);
    const double width = done_ - begin;
    Exec part{exec_.cancel, {}, {}};
    if (width > 0)
      part.onProgress = [this, begin, width](double share) { exec_.progress(begin + share * width); };
    return part;
  }

 private:
  const Exec& exec_;
  double done_ = 0;
};

/// Progress over things that cost differently, done in any order by any thread.
class CostProgress {
 public:
  explicit CostProgress(const Exec& exec) : exec_(exec) {}
  void add(double cost) { total_ += cost; }
  void done(double cost) {
    const double done = done_.fetch_add(cost) + cost;
    if (total_ > 0) exec_.progress(std::min(done / total_, 1.0));
  }

 private:
  const Exec& exec_;
  double total_ = 0;
  std::atomic<double> done_{0};
};

/// What may be done beside others: be cancelled, but not speak.
inline Exec quiet(const Exec& exec) { return {exec.cancel, {}, {}}; }

/// body(i), a Result<void>, for i in [0, n), in parallel; the first error, by i.
template <class Body>
Result<void> forEach(const Exec& exec, std::size_t n, const Body& body) {
  std::vector<Result<void>> results(n);
  std::atomic<std::size_t> done{0};
  parallelFor(exec, n, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      results[i] = body(i);
      exec.progress(static_cast<double>(++done) / static_cast<double>(n));
    }
  });
  if (exec.cancelled()) return cancelledError();
  for (const auto& result : results) SHERD_CHECK(result);
  return {};
}

}  // namespace sherd
