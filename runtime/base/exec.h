// What a step is run with: a way to be cancelled, to tell how far it is, and to say things to the user.
// Threads are the business of parallel.h; seeds are parameters of the steps that draw random numbers.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace sherd {

/// Set once by the user (Ctrl-C), read by all steps. Lock-free, so that a signal handler may set it.
class CancelToken {
 public:
  void cancel() noexcept { flag_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return flag_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> flag_{false};
};

enum class LogLevel { Info, Warning };

/// Handed to every step. A default-constructed Exec is never cancelled and says nothing, so that a step can
/// be called from a test as it is. Copies share the token and the callbacks; the callbacks are thread-safe.
struct Exec {
  const CancelToken* cancel = nullptr;
  std::function<void(double)> onProgress;                       ///< share done, in [0, 1]
  std::function<void(LogLevel, const std::string&)> onMessage;  ///< one line for the user

  bool cancelled() const { return cancel != nullptr && cancel->cancelled(); }
  void progress(double share) const {
    if (onProgress) onProgress(share);
  }
  void info(const std::string& line) const {
    if (onMessage) onMessage(LogLevel::Info, line);
  }
  void warn(const std::string& line) const {
    if (onMessage) onMessage(LogLevel::Warning, line);
  }
};

}  // namespace sherd
