#include <sys/ioctl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "base/memory.h"
#include "base/partial_file.h"
#include "cli/command_line.h"

namespace {

sherd::CancelToken gCancel;
std::atomic_flag gInterrupted;  ///< gCancel is set by failures, too
bool gEvents = false;

void say(int file, std::string_view text) {
  [[maybe_unused]] const auto written = write(file, text.data(), text.size());
}

/// Nodes have this long to end by themselves; some are inside a library's call that can't be stopped.
constexpr suseconds_t kPatience = 70000;  // µs

/// What has not ended by now is left where it stands. Only files that are half written matter.
extern "C" void onAlarm(int) {
  sherd::removePartialFiles();
  if (gEvents) say(STDOUT_FILENO, "{\"event\":\"done\",\"ok\":false,\"ms\":0,\"outputs\":[]}\n");
  say(STDERR_FILENO, "cancelled\n");
  _exit(sherd::kCancelled);
}

extern "C" void onSignal(int) {
  if (gInterrupted.test_and_set()) return;
  gCancel.cancel();
  itimerval timer{};
  timer.it_value.tv_usec = kPatience;
  setitimer(ITIMER_REAL, &timer, nullptr);
  say(STDERR_FILENO, "\nstopping\n");
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

int terminalWidth() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

int main(int argc, char** argv) {
  sherd::keepFreedMemory();
  // Results must not depend on the number of threads: BLAS and OpenMP run single-threaded. OpenBLAS reads
  // this when the node pack that links it is loaded.
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  setenv("OMP_NUM_THREADS", "1", 1);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  gEvents = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end() &&
            !arguments.empty() && arguments.front() == "run";
  handle(SIGALRM, onAlarm);
  handle(SIGINT, onSignal);
  handle(SIGTERM, onSignal);
  std::ios::sync_with_stdio(false);

  sherd::Console console{std::cout, std::cerr, gCancel, isatty(STDOUT_FILENO) == 1, terminalWidth()};
  return sherd::runCommandLine(arguments, console);
}
