// The program as a process that can be signalled, with the node pack of these tests in place of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "support/program.h"

namespace sherd::faults {

namespace fs = std::filesystem;

struct Ended {
  int exitCode = -1;  ///< 128 + signal where one ended it, as a shell has it
  std::string out, err;
};

/// A running sherd. Destroying it kills it.
class Process {
 public:
  /// `prepare` runs in the child, before the program; it may only make calls of the system.
  Process(const std::vector<std::string>& arguments, const std::string& scratch,
          const std::string& packs = FAULT_PACK, const std::function<void()>& prepare = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const;
  /// Waits for the end; after `seconds` it is killed, and that is a failure of the test.
  Ended wait(double seconds = 120);

 private:
  pid_t pid_ = -1;
  std::string outFile_, errFile_;
};

/// Runs it to its end.
Ended runSherd(const std::vector<std::string>& arguments, const std::string& scratch,
               const std::string& packs = FAULT_PACK, const std::function<void()>& prepare = {});

/// Names of nodes by their state in what `run --json` or `plan --json` printed; lines that are cut off are
/// left out.
std::map<std::string, std::string> statesIn(const std::string& events);
std::set<std::string> namesIn(const std::map<std::string, std::string>& states, const std::string& state);

/// By name; whose content differs is named, not printed.
void expectSameFiles(const std::map<std::string, std::string>& files,
                     const std::map<std::string, std::string>& expected, const std::string& when = {});

std::vector<std::string> linesOf(const std::string& path);
void writeText(const std::string& path, const std::string& text);
void sleepSeconds(double seconds);
/// Waits until `done`, ten seconds at most.
bool waitUntil(const std::function<bool()>& done);
double secondsSince(std::chrono::steady_clock::time_point start);

/// The same numbers on every machine, unlike std::uniform_int_distribution's.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

/// A dozen nodes in a diamond-shaped weave that write two directories ("--target files"), in a scratch
/// directory.
class Weave {
 public:
  /// `more`: further nodes by name, with what stands between their braces; all wanted by default.
  explicit Weave(const ScratchDirectory& scratch, const std::map<std::string, std::string>& more = {},
                 double ms = 6);

  std::vector<std::string> run(const std::vector<std::string>& more = {},
                               const std::string& cache = "cache") const;
  Ended runToEnd(const std::vector<std::string>& more = {}, const std::string& cache = "cache") const;
  /// The files of an undisturbed run, without a cache.
  std::map<std::string, std::string> undisturbed(const std::vector<std::string>& more = {}) const;
  std::map<std::string, std::string> outputs() const;
  /// Removes outputs, cache and log.
  void startAnew() const;
  std::string file(const std::string& name) const { return root_ + '/' + name; }
  const std::string& root() const { return root_; }
  std::vector<std::string> log() const { return linesOf(file("log")); }
  void forgetLog() const { fs::remove(file("log")); }

 private:
  std::string root_;
};

}  // namespace sherd::faults
