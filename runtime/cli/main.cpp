#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "cli/command_line.h"

namespace {

sherd::CancelToken gCancel;

/// The first signal asks the nodes to stop; the second ends the program where it stands.
extern "C" void onSignal(int) {
  if (gCancel.cancelled()) _exit(sherd::kCancelled);
  gCancel.cancel();
  static constexpr char kText[] = "\nstopping; once more to end at once\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof kText - 1);
}

int terminalWidth() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

int main(int argc, char** argv) {
  // Results must not depend on the number of threads: BLAS and OpenMP run single-threaded. OpenBLAS reads
  // this when the node pack that links it is loaded.
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  setenv("OMP_NUM_THREADS", "1", 1);
  struct sigaction action {};
  action.sa_handler = onSignal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::ios::sync_with_stdio(false);

  sherd::Console console{std::cout, std::cerr, gCancel, isatty(STDOUT_FILENO) == 1, terminalWidth()};
  return sherd::runCommandLine(std::vector<std::string>(argv + 1, argv + argc), console);
}
